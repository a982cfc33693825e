// Decides which edges are sharp where the input's normals say how authors want it shaded.
//
// Normals are believed for each component by itself. Flat shading breaks them at every bent edge and tells nothing.
// Normals of noise break along short lines that fork everywhere: no author drew them. Where normals are believed, edges
// that they smooth are not sharp, whatever the shape. A line that hardly bends the surface is not sharp either: nobody
// sees it. If no component has a hard edge to believe in, the whole input tells nothing, because programs write normals
// that smooth everything without being asked.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

enum class EdgeWord : uint8_t { kNothing, kSmooth, kHard };

struct AuthoredEdges {
    std::vector<EdgeWord> words;  // per half-edge 3f+i, both of an edge the same; empty: nothing is known of any
    uint64_t named = 0;           // hard edges of components that are believed
    uint64_t kept = 0;            // edges whose word is kHard: those of them that form lines and bend the surface
};

// In: an oriented 2-manifold; its breaks as find_breaks() returns them, or none. Cost: O(F log F).
AuthoredEdges read_authored_edges(const Mesh& mesh, const std::vector<float>& breaks);

// Returns per half-edge whether its edge is sharp: by the words, and by sharp_edges() where there are none.
std::vector<bool> creases_of(const Mesh& mesh, const AuthoredEdges& authored);

}  // namespace gim
