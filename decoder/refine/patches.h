// The current mesh as squares of the image, for a GPU (gim/refine.h, "patches").
//
// A cell of a tile is divided into four if the mesh has the vertex in its centre. Because triangles that share an edge differ
// by one split at most, cells that share a side then differ by one division at most: a quadtree whose leaves have at most
// one vertex within a side. Four cells that are as fine become one patch (Maximo et al. 2013, section 4.4, figure 7, the other
// way round).
#pragma once

#include <cstdint>

#include "decoder/refine/refined_mesh.h"
#include "gim/refine.h"

namespace gim {

// Receives patches, and counts those that it has no room for too.
class PatchList {
  public:
    PatchList(gim_patch* patches, uint32_t capacity) : patches_(patches), capacity_(capacity) {}
    void add(const gim_patch& patch) {
        if (count_ < capacity_) patches_[count_] = patch;
        ++count_;
    }
    uint32_t count() const { return count_; }

  private:
    gim_patch* patches_;
    uint32_t capacity_, count_ = 0;
};

// Adds the patches of all tiles. Cost: O(triangles of the mesh). Rows and columns of the image fit 16 bits.
void list_patches(const RefinedMesh& mesh, PatchList* list);

}  // namespace gim
