// Google Benchmark: inverse wavelet, entropy decoding, whole decode and refinement of a 257 x 257 image, one thread.
// Run codec_bench. GIM_BENCH_IMAGE=file replaces the built-in image: 257 x 257 headerless floats.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "decoder/pyramid/range_decoder.h"
#include "decoder/pyramid/synthesis.h"
#include "encoder/code/code_bands.h"
#include "encoder/squares/import_image.h"
#include "encoder/squares/write_squares.h"
#include "gim/decoder.hpp"
#include "gim/refine.h"

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

// A domain over the image, with a mesh.
struct Refined {
    std::vector<uint8_t> bytes = coded(false, 2);
    gim_info info{};
    gim_domain_info shape{};
    std::vector<float> positions;
    Scratch memory, of_mesh;
    const gim_domain* domain = nullptr;
    gim_refined* mesh = nullptr;

    Refined() {
        gim_level_info level;
        bool ok = gim_read_info(bytes.data(), bytes.size(), nullptr, &info) == GIM_OK &&
                  gim_read_level_info(&info, bytes.data(), bytes.size(), 0, 0, &level) == GIM_OK &&
                  gim_read_domain_info(&info, bytes.data(), bytes.size(), 0, 0, &shape) == GIM_OK;
        if (!ok) return;
        positions.resize(3 * size_t{level.vertex_count});
        Scratch scratch(std::max(level.scratch_size, shape.scratch_size));
        memory = Scratch(shape.domain_size);
        ok = gim_decode_mesh(&info, bytes.data(), bytes.size(), 0, 0, positions.data(), nullptr, nullptr, nullptr,
                             scratch.data(), scratch.size()) == GIM_OK &&
             gim_open_domain(&info, bytes.data(), bytes.size(), 0, 0, positions.data(), memory.data(), memory.size(),
                             scratch.data(), scratch.size(), &domain) == GIM_OK;
        if (!ok) return;
        const auto most = static_cast<uint32_t>(shape.most_triangles);
        of_mesh = Scratch(gim_refined_size(domain, most));
        (void)gim_begin_refined(domain, most, of_mesh.data(), of_mesh.size(), &mesh);
    }
    uint32_t triangles() const {
        uint32_t count = 0;
        (void)gim_refined_triangles(mesh, &count);
        return count;
    }
};

// Splits until all samples with this error are there, and welds them again.
void split_and_weld(benchmark::State& state) {
    Refined r;
    if (!r.mesh) return state.SkipWithError("cannot be refined");
    gim_rule fine{}, coarse{};
    fine.object_error = 1.0f / static_cast<float>(state.range(0));
    coarse.object_error = 1e6f;
    const uint32_t base = r.triangles();
    uint64_t operations = 0;
    for (auto _ : state) {
        (void)gim_refine(r.mesh, &fine, 0, nullptr);
        operations += r.triangles() - base;  // each split adds two triangles, and is undone
        (void)gim_refine(r.mesh, &coarse, 0, nullptr);
    }
    state.counters["operations/s"] = benchmark::Counter(static_cast<double>(operations), benchmark::Counter::kIsRate);
    state.counters["triangles"] = static_cast<double>(operations) / static_cast<double>(state.iterations());
}

// 400 meshes of one image around an eye that moves by two thousandths of their distance in each frame.
void moving_eye(benchmark::State& state) {
    Refined r;
    if (!r.mesh) return state.SkipWithError("cannot be refined");
    constexpr uint32_t kMeshes = 400, kMost = 20000;
    const uint64_t size = gim_refined_size(r.domain, kMost);
    std::vector<Scratch> memory(kMeshes);
    std::vector<gim_refined*> meshes(kMeshes);
    for (uint32_t i = 0; i < kMeshes; ++i) {
        memory[i] = Scratch(size);
        (void)gim_begin_refined(r.domain, kMost, memory[i].data(), memory[i].size(), &meshes[i]);
    }
    gim_rule rule{};
    rule.pixel_error = 1;
    rule.pixels_per_unit = static_cast<float>(state.range(0));
    const auto frame = [&](int number) {
        for (uint32_t i = 0; i < kMeshes; ++i) {
            const float distance = 8 + 0.1f * static_cast<float>(i);
            const float angle = 0.002f * static_cast<float>(number) + static_cast<float>(i);
            rule.eye[0] = distance * std::cos(angle);
            rule.eye[1] = distance * std::sin(angle);
            (void)gim_refine(meshes[i], &rule, 0, nullptr);
        }
    };
    int number = 0;
    frame(number);
    for (auto _ : state) frame(++number);
    uint64_t triangles = 0;
    for (const gim_refined* mesh : meshes) {
        uint32_t count = 0;
        (void)gim_refined_triangles(mesh, &count);
        triangles += count;
    }
    state.counters["triangles/mesh"] = static_cast<double>(triangles) / kMeshes;
}

BENCHMARK(split_and_weld)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);
BENCHMARK(moving_eye)->Arg(100)->Arg(400)->Unit(benchmark::kMillisecond);
BENCHMARK(inverse_wavelet<Reversible53>)->Unit(benchmark::kMicrosecond);
BENCHMARK(inverse_wavelet<Irreversible97>)->Unit(benchmark::kMicrosecond);
BENCHMARK(entropy_decoding)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossless)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossy)->Arg(2)->Arg(13)->Unit(benchmark::kMillisecond);
BENCHMARK(decode_lossy_normals)->Arg(13)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gim

BENCHMARK_MAIN();
