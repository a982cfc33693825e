// Turns triangles as read from a file into the mesh that the stages work on. Repairs what is not a manifold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/topology_summary.h"
#include "gim/encoder.h"

namespace gim {

struct CleanOptions {
    bool require_connected = true;  // false: allows several components (one image each, or a layout that takes them)
    bool strict = false;            // true: an Error where a surface needs more than welding and turning
    std::optional<Length> weld_tolerance = {};  // as in EncodeOptions
};

struct CleanReport {
    Repairs repairs;
    std::vector<std::string> warnings;
    TopologySummary topology;  // of the result
};

struct CleanMesh {
    Mesh mesh;                            // oriented 2-manifold without unreferenced vertices
    std::vector<uint32_t> source_vertex;  // per vertex: its (first) index in the input; a new vertex has a neighbour's
    std::vector<float> breaks;  // per half-edge, as normal_breaks.h finds them; empty: the input has no normals
    CleanReport report;
};

// In:  finite positions, triangles that index them, and normals that fit. Otherwise returns an Error.
// Out: an oriented manifold, connected if the options require it. Each component keeps the side that most of its faces
//      show, so cavities stay cavities. A closed component whose faces disagree much faces outwards.
//
// The result depends on positions and faces, not on how a file shares or repeats vertices. There is one exception: where
// the indices of a file describe a manifold, faces that it joins stay joined. What is repaired, and how, stands in
// spec/bad-meshes.md. Faces and vertices of a sound mesh keep their order. Cost: O(F log F).
Result<CleanMesh> clean(const TriangleMesh& input, const CleanOptions& options = {});

}  // namespace gim
