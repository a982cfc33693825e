// Primitives compressed by KHR_draco_mesh_compression.
#pragma once

#include <memory>
#include <span>

#include "tools/gltf_accessor.h"

namespace gim::gltf {

class DracoMesh {
  public:
    // Decompresses the bytes. Safe on untrusted bytes: checks what they claim against `memory` before it decompresses.
    // The mesh itself counts as taken from it.
    DracoMesh(std::span<const uint8_t> bytes, MemoryBudget& memory);
    DracoMesh(const DracoMesh&) = delete;
    DracoMesh& operator=(const DracoMesh&) = delete;
    ~DracoMesh();

    // Three for each triangle.
    std::vector<uint32_t> corners() const;
    // The values of an attribute for every vertex. Fails if there is none of this id.
    Column column(uint64_t unique_id, bool normalized) const;

  private:
    struct Decoded;
    std::unique_ptr<Decoded> decoded_;
};

}  // namespace gim::gltf
