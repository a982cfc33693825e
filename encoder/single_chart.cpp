#include "encoder/single_chart.h"

#include "encoder/augment_cut.h"
#include "encoder/boundary_map.h"
#include "encoder/parametrize.h"
#include "encoder/refine.h"
#include "encoder/result.h"
#include "encoder/sample.h"
#include "encoder/stretch.h"

namespace gim {

namespace {

// Faces larger than this part of the surface are split before cutting: about 8 samples of a 257 x 257 image.
constexpr double kLargestFace = 1.0 / 8000;

}  // namespace

Result<SingleChart> make_geometry_image(const Mesh& mesh, const EncodeOptions& options, StageClock& clock) {
    SingleChart chart;
    const BoundaryMapOptions square{options.side, options.node_side};

    clock.begin(Stage::kCut);
    const Mesh fine = refine_large_faces(mesh, kLargestFace * surface_area(mesh));
    const Topology topology = build_topology(fine);
    AugmentOptions search;
    search.boundary = square;
    GIM_TRY(found, find_cut(fine, topology, search, clock.progress()));
    chart.cut_length = cut_length(fine, topology, found.cut);
    GIM_TRY(opened, open_mesh(fine, topology, found.cut));

    clock.begin(Stage::kBoundaryMap);
    GIM_TRY(boundary, map_boundary(std::move(opened), square));

    clock.begin(Stage::kParametrize);
    const Mesh& disk = boundary.opened.mesh;
    GIM_TRY(uv, parametrize(disk, boundary.sides, boundary_uv(boundary, options.side), {}, clock.progress()));
    chart.stretch_efficiency = stretch_efficiency(disk, uv, 1.0);
    chart.flipped_triangles = count_flipped(disk, uv);

    clock.begin(Stage::kSample);
    chart.image = sample_surface(boundary, uv, options.side);
    return chart;
}

}  // namespace gim
