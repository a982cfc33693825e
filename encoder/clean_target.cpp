#include "encoder/clean_target.h"

#include <string>
#include <utility>

#include "encoder/surface/clean.h"
#include "encoder/surface/local_frame.h"

namespace gim {
namespace {

Error of_mesh(const Error& error) { return {error.stage, "the mesh to fit to: " + error.message}; }

}  // namespace

Result<Mesh> clean_target(const TriangleMesh& mesh, const EncodeOptions& options, EncodeReport& report) {
    if (const auto extent = check_extent(mesh, options.bits); !extent.ok()) return of_mesh(extent.error());
    auto cleaned = clean(mesh, {.require_connected = false, .strict = options.strict, .weld_tolerance = {}});
    if (!cleaned.ok()) return of_mesh(cleaned.error());
    report.input_vertices = mesh.positions.size();
    report.input_triangles = mesh.triangles.size();
    report.repairs = cleaned.value().report.repairs;
    report.topology = cleaned.value().report.topology;
    for (const std::string& warning : cleaned.value().report.warnings)
        report.warnings.push_back("the mesh to fit to: " + warning);
    return std::move(cleaned.value().mesh);
}

}  // namespace gim
