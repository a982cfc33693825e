// Google Benchmark: inverse wavelet, entropy decoding, whole decode of a 257 x 257 image, one thread.
// Run codec_bench. GIM_BENCH_IMAGE=file replaces the built-in image: 257 x 257 headerless floats.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "decoder/pyramid/range_decoder.h"
#include "decoder/pyramid/synthesis.h"
#include "encoder/code/code_bands.h"
#include "encoder/squares/import_image.h"
#include "encoder/squares/write_squares.h"
#include "gim/decoder.hpp"

namespace gim {
namespace {

constexpr uint32_t kSide = 257;

// A bumpy ellipsoid folded out of the square. It takes as many bytes a sample as scans do.
std::vector<float> image_planes() {
    std::vector<float> planes(size_t{kSide} * kSide * 3);
    if (const char* name = std::getenv("GIM_BENCH_IMAGE")) {
        std::ifstream file(name, std::ios::binary);
        if (file.read(reinterpret_cast<char*>(planes.data()), static_cast<std::streamsize>(planes.size() * 4)))
            return planes;
    }
    const size_t plane = size_t{kSide} * kSide;
    for (uint32_t r = 0; r < kSide; ++r)
        for (uint32_t c = 0; c < kSide; ++c) {
            const double u = 2 * 3.14159265358979 * (c % (kSide - 1)) / (kSide - 1),
                         v = 3.14159265358979 * (0.05 + 0.9 * r / (kSide - 1));
            const double bumps =
                1 + 0.03 * std::sin(17 * u) * std::sin(23 * v) + 0.01 * std::sin(61 * u + 3 * v) * std::cos(47 * v);
            const size_t i = size_t{r} * kSide + c;
            planes[i] = static_cast<float>(bumps * std::sin(v) * std::cos(u));
            planes[plane + i] = static_cast<float>(1.2 * bumps * std::sin(v) * std::sin(u));
            planes[2 * plane + i] = static_cast<float>(1.5 * bumps * std::cos(v));
        }
    return planes;
}

const SquareImage& image() {
    static const SquareImage made = import_image(image_planes(), kSide, 2e-6).value();
    return made;
}

std::vector<uint8_t> coded(bool lossless, double quantizer) {
    CodingParameters p;
    p.lossless = lossless;
    p.quantizer = quantizer;
    return write_squares({&image(), 1}, p).value();
}

void whole_decode(benchmark::State& state, const std::vector<uint8_t>& bytes, bool normals) {
    Decoder decoder;
    DecoderLevel level;
    if (decoder.open(bytes) != GIM_OK || decoder.read_level(0, 0, &level) != GIM_OK)
        return state.SkipWithError("cannot be read");
    std::vector<float> x(level.vertex_count * 3), n(normals ? x.size() : 0);
    std::vector<uint32_t> t(level.triangle_count * 3);
    for (auto _ : state) {
        benchmark::DoNotOptimize(decoder.mesh(level, {x, n, {}, t}));
    }
    state.counters["bytes"] = static_cast<double>(bytes.size());
    state.counters["Mtri/s"] =
        benchmark::Counter(level.triangle_count * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

void decode_lossless(benchmark::State& state) { whole_decode(state, coded(true, 0), false); }
void decode_lossy(benchmark::State& state) {
    whole_decode(state, coded(false, static_cast<double>(state.range(0))), false);
}
void decode_lossy_normals(benchmark::State& state) {
    whole_decode(state, coded(false, static_cast<double>(state.range(0))), true);
}

template <class Wavelet>
void inverse_wavelet(benchmark::State& state) {
    using Sample = typename Wavelet::Sample;
    const uint32_t h = kSide / 2;
    std::vector<int32_t> a((h + 1) * h * 3, 1), b(a.size(), 1), c(size_t{h} * h * 3, 1);
    const LevelBands bands = {{a.data(), h + 1, h}, {b.data(), h, h + 1}, {c.data(), h, h}};
    std::vector<Sample> low(size_t{h + 1} * (h + 1) * 3, Sample{5}), work(synthesis_work_size(kSide)),
        out(size_t{kSide} * kSide * 3);
    for (auto _ : state) {
        synthesize<Wavelet>(kSide, kSide, low.data(), bands, {1.0f, 1.0f}, work.data(), out.data());
        benchmark::ClobberMemory();
    }
}

void entropy_decoding(benchmark::State& state) {
    std::vector<int32_t> units;
    const Vec3 low = image().positions.front();
    for (const Vec3& p : image().positions)
        for (int k = 0; k < 3; ++k) units.push_back(static_cast<int32_t>(std::lround((p[k] - low[k]) * 1500)));
    Pyramid<int32_t> bands = analyse<Reversible53>(units, kSide);
    const auto streams = code_bands(bands, 1);
    OwnBandWork work(129);
    for (auto _ : state) {
        RangeDecoder decoder(streams[0]);
        BandModels models(CoefficientKind::kPlain);
        BandCoder coder(&decoder, &models, work.view());
        coder.code_base({bands.base.data(), 2, 2});
        for (uint32_t e = 0; e < 8; ++e) {
            const LevelBands parents = bands_of(bands, e ? e - 1 : 0);
            benchmark::DoNotOptimize(coder.code_level(bands_of(bands, e), e ? &parents : nullptr));
        }
    }
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) * static_cast<int64_t>(streams[0].size()));
}

BENCHMARK(inverse_wavelet<Reversible53>)->Unit(benchmark::kMicrosecond);
BENCHMARK(inverse_wavelet<Irreversible97>)->Unit(benchmark::kMicrosecond);
BENCHMARK(entropy_decoding)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossless)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossy)->Arg(2)->Arg(13)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossy_normals)->Arg(13)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gim

BENCHMARK_MAIN();
