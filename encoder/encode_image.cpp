// An existing geometry image -> .gim: the driver for images that are sampled already.
#include <algorithm>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/image/gluing.h"
#include "encoder/squares/encode_squares.h"
#include "encoder/squares/import_image.h"

namespace gim {
namespace {

Result<Encoded> run_stages(const std::vector<float>& planes, uint32_t side, double weld_tolerance,
                           EncodeOptions options, const Progress& progress) {
    StageClock clock(progress);
    clock.begin(Stage::kInput);
    GIM_TRY(image, import_image(planes, side, weld_tolerance));

    // The image's own surface is the reference.
    GIM_TRY(gluing, glue_ring(image.sideband, image.side));
    Mesh surface;
    surface.positions = image.positions;
    surface.triangles = triangulate_grid(image.positions, gluing).triangles;

    Encoded encoded;
    encoded.report.input_vertices = image.positions.size();
    encoded.report.input_triangles = surface.triangles.size();

    // Levels coarser than the node grid cannot be closed, so they are not kept apart.
    options.side = image.side;
    options.node_side = std::clamp(std::max(options.node_side, image.sideband.node_side), 5u, std::max(image.side, 5u));
    SquareImages squares;
    squares.images.push_back(std::move(image));
    squares.surfaces.push_back(surface);
    const CodingJob job = code_squares(std::move(squares), options, clock, encoded.report);
    return finish_encoding(job, std::move(surface), {}, options, clock, std::move(encoded));
}

}  // namespace

Result<Encoded> encode_image(const std::vector<float>& planes, uint32_t side, double weld_tolerance,
                             const EncodeOptions& options, const Progress& progress) {
    EncodeOptions checked_options = options;
    checked_options.side = 257;  // the image has its own
    checked_options.node_side = 17;
    GIM_TRY(checked, check_options(checked_options));
    (void)checked;
    return guarded(options.threads, [&] { return run_stages(planes, side, weld_tolerance, options, progress); });
}

}  // namespace gim
