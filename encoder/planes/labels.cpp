#include "encoder/planes/labels.h"

#include <algorithm>

#include "encoder/code/assemble_file.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/range_encoder.h"
#include "encoder/planes/input_triangles.h"
#include "encoder/surface/closest_point.h"
#include "format/label_code.h"
#include "format/stream_table.h"

namespace gim {
namespace {

// The middle of a cell's diagonal, which its second triangle begins or ends with (spec, "Triangles").
std::vector<Vec3> cell_middles(const Mesh& surface) {
    std::vector<Vec3> middles;
    middles.reserve(surface.triangles.size() / 2);
    for (size_t t = 0; t + 1 < surface.triangles.size(); t += 2) {
        const uint32_t to = surface.triangles[t][2], from = surface.triangles[t + 1][0];
        middles.push_back((surface.positions[from] + surface.positions[to]) / 2);
    }
    return middles;
}

// Codes the labels of one image.
std::vector<uint8_t> code_image(std::span<const uint8_t> labels, const LabelSquares& squares) {
    RangeEncoder encoder;
    const size_t side = squares.side;
    std::vector<uint8_t> row(side);
    const auto values = [&](uint32_t square, uint32_t r) { return labels.data() + (square * side + r) * side; };
    code_labels(encoder, squares, row.data(), values, [](uint32_t, uint32_t) {});
    return encoder.finish();
}

}  // namespace

bool has_labels(const TriangleMesh& mesh) {
    const auto differs = [&](uint8_t label) { return label != mesh.labels.front(); };
    return std::any_of(mesh.labels.begin(), mesh.labels.end(), differs);
}

Result<void> check_labels(const TriangleMesh& mesh, Layout layout) {
    if (!mesh.labels.empty() && mesh.labels.size() != mesh.triangles.size())
        return Error{Stage::kInput, "the mesh's labels must have one entry per triangle, or none at all"};
    if (layout == Layout::kMcgim && has_labels(mesh))
        return Error{Stage::kCut, "the layout mcgim cannot hold labels of triangles; take gim, tiles or auto"};
    return {};
}

Result<std::vector<uint8_t>> cell_labels(std::span<const uint8_t> file, const TriangleMesh& input, uint32_t threads) {
    GIM_TRY(surface, decode_surface(file, 0));
    std::vector<uint32_t> source;
    const ClosestPointTree tree(triangles_with_area(input, &source), threads);
    std::vector<uint8_t> labels;
    for (const ClosestPoint& found : tree.find_all(cell_middles(surface), threads))
        labels.push_back(found.triangle == kNone ? uint8_t{0} : input.labels[source[found.triangle]]);
    return labels;
}

Result<std::vector<uint8_t>> with_labels(std::span<const uint8_t> file, std::span<const uint8_t> labels) {
    Header header;
    if (parse_header(file, kNoLimits, &header) != Status::kOk) return decoding_error(Stage::kCode, GIM_MALFORMED);
    if (header.layout == FileLayout::kCharts) return Error{Stage::kCode, "labels do not fit the image"};
    std::vector<std::vector<uint8_t>> streams;
    size_t at = 0;
    for (uint32_t image = 0; image < header.image_count(); ++image) {
        const LabelSquares squares = label_squares(header, image);
        if (squares.cells() > labels.size() - at) return Error{Stage::kCode, "labels do not fit the image"};
        streams.push_back(code_image(labels.subspan(at, squares.cells()), squares));
        at += squares.cells();
    }
    CodedPlane chunk = {ChunkType::kLabels, {}};
    append_streams(streams, &chunk.payload);
    return replace_planes(file, {&chunk, 1});
}

}  // namespace gim
