// Primitives: triangles and the attributes of their vertices, with morph targets applied.
#pragma once

#include <map>
#include <memory>

#include "tools/gltf_draco.h"

namespace gim::gltf {

// Decompressed meshes by buffer view, because instances share them.
using DracoMeshes = std::map<uint64_t, std::unique_ptr<DracoMesh>>;

// An attribute plus its weighted morph targets.
struct MorphedColumn {
    Column base;
    std::vector<std::pair<double, Column>> targets;  // weight and difference

    double at(uint64_t row, size_t k) const;
};

class Primitive {
  public:
    // weights: of the morph targets; may be shorter than their list. Everything must outlive the object.
    Primitive(File& file, DracoMeshes& draco, const Json& object, const std::vector<double>& weights);

    // True if it is made of triangles and has positions.
    bool is_surface() const;
    uint64_t vertices();
    // Three vertices for each triangle. Fails if one of them does not exist.
    std::vector<uint32_t> corners();

    bool has(const std::string& attribute) const;
    // Fails if the attribute is missing, has fewer than `width` numbers or another count than the positions.
    MorphedColumn attribute(const std::string& name, size_t width);

    const Json& object() const { return object_; }

  private:
    Column column(const std::string& name);
    const DracoMesh* draco();

    File& file_;
    DracoMeshes& draco_meshes_;
    const Json& object_;
    const std::vector<double>& weights_;
    std::optional<uint64_t> vertices_;
};

}  // namespace gim::gltf
