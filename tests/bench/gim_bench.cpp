// Google Benchmarks of the decoder and of the encoder's inner loops. Compare ratios within one run of gim_bench only.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "corpus/generators.h"
#include "encoder/squares/boundary_map.h"
#include "encoder/squares/cut.h"
#include "encoder/squares/parametrize.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/clean.h"
#include "gim/decoder.hpp"
#include "gim/encoder.h"

namespace gim {
namespace {

// A bumpy open square, which gives every stage of the decoder work.
SquareImage bumpy_image(uint32_t side) {
    SquareGrid image{side, {}};
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            const double u = double(column) / (side - 1), v = double(row) / (side - 1);
            image.positions.emplace_back(
                u, v, 0.1 * std::sin(9 * u) * std::cos(7 * v) + 0.004 * std::sin(61 * u + 83 * v * v));
        }
    }
    return glue_square(std::move(image), {}).value();
}

std::vector<uint8_t> coded(bool lossless) {
    const SquareImage image = bumpy_image(257);
    CodingParameters parameters;
    parameters.lossless = lossless;
    return write_squares({&image, 1}, parameters).value();
}

void decode_mesh(benchmark::State& state, bool lossless, uint32_t level) {
    const std::vector<uint8_t> bytes = coded(lossless);
    Decoder decoder;
    DecoderLevel shape;
    if (decoder.open(bytes) != GIM_OK) return state.SkipWithError("info");
    if (decoder.read_level(0, level, &shape) != GIM_OK) return state.SkipWithError("level");
    std::vector<float> positions(size_t{shape.vertex_count} * 3);
    std::vector<uint32_t> triangles(size_t{shape.triangle_count} * 3);
    for (auto _ : state) {
        if (decoder.mesh(shape, {positions, {}, {}, triangles}) != GIM_OK) return state.SkipWithError("decode");
        benchmark::DoNotOptimize(positions.data());
    }
    state.counters["triangles/s"] =
        benchmark::Counter(double(shape.triangle_count), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["bytes"] = double(bytes.size());
}

void minimise_stretch(benchmark::State& state) {
    const Mesh mesh = clean(corpus::torus(64, 32, 1, 0.4)).value().mesh;
    const Topology topology = build_topology(mesh);
    const CutEdges cut = straighten_cut(mesh, topology, initial_cut(mesh, topology, 0));
    const SquareBoundary boundary = map_boundary(open_mesh(mesh, topology, cut).value(), {257, 17}).value();
    const std::vector<Vec2> border = boundary_uv(boundary, 257);
    for (auto _ : state) benchmark::DoNotOptimize(parametrize(boundary.opened.mesh, boundary.sides, border, {}));
    state.counters["vertices"] = double(mesh.positions.size());
}

void code_image(benchmark::State& state, bool lossless) {
    const SquareImage image = bumpy_image(257);
    CodingParameters parameters;
    parameters.lossless = lossless;
    for (auto _ : state) benchmark::DoNotOptimize(write_squares({&image, 1}, parameters));
}

BENCHMARK_CAPTURE(decode_mesh, lossy_257, false, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_mesh, lossy_65, false, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_mesh, lossless_257, true, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(code_image, lossy_257, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(code_image, lossless_257, true)->Unit(benchmark::kMillisecond);
BENCHMARK(minimise_stretch)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gim

BENCHMARK_MAIN();
