#include "tools/gltf_primitive.h"

#include <algorithm>

namespace gim::gltf {
namespace {

enum Mode : uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

const char* const kDraco = "KHR_draco_mesh_compression";

// Calls emit(a, b, c) for the triangles of corners 0 .. count-1.
template <class Emit>
void for_each_triangle(uint64_t mode, size_t count, const Emit& emit) {
    if (mode == kStrip) {
        for (size_t i = 2; i < count; ++i) i % 2 == 0 ? emit(i - 2, i - 1, i) : emit(i - 1, i - 2, i);
    } else if (mode == kFan) {
        for (size_t i = 2; i < count; ++i) emit(0, i - 1, i);
    } else {
        for (size_t i = 2; i < count; i += 3) emit(i - 2, i - 1, i);
    }
}

// Appends the triangles of one run of indices, which no restart interrupts.
void add_run(uint64_t mode, std::span<const uint32_t> run, std::vector<uint32_t>& corners) {
    for_each_triangle(mode, run.size(), [&](size_t a, size_t b, size_t c) {
        for (const size_t i : {a, b, c}) corners.push_back(run[i]);
    });
}

}  // namespace

double MorphedColumn::at(uint64_t row, size_t k) const {
    double value = base.at(row, k);
    for (const auto& [weight, target] : targets) value += weight * target.at(row, k);
    return value;
}

Primitive::Primitive(File& file, DracoMeshes& draco, const Json& object, const std::vector<double>& weights)
    : file_(file), draco_meshes_(draco), object_(object), weights_(weights) {}

bool Primitive::has(const std::string& attribute) const {
    return !member(member(object_, "attributes"), attribute).is_null();
}

bool Primitive::is_surface() const {
    const uint64_t mode = whole_number(object_, "mode").value_or(kTriangles);
    return mode >= kTriangles && mode <= kFan && has("POSITION");
}

const DracoMesh* Primitive::draco() {
    const Json& packed = extension(object_, kDraco);
    if (!packed.is_object()) return nullptr;
    const std::optional<uint64_t> view = whole_number(packed, "bufferView");
    if (!view) throw Failure(std::string(kDraco) + " without a buffer view");
    std::unique_ptr<DracoMesh>& mesh = draco_meshes_[*view];
    if (!mesh) mesh = std::make_unique<DracoMesh>(file_.view(*view), file_.memory());
    return mesh.get();
}

Column Primitive::column(const std::string& name) {
    const std::optional<uint64_t> accessor = whole_number(member(object_, "attributes"), name);
    if (!accessor) throw Failure("a primitive has no " + name);
    const std::optional<uint64_t> packed = whole_number(member(extension(object_, kDraco), "attributes"), name);
    // Integer colours are fractions, also where a program forgot to say so.
    const bool is_color = name.starts_with("COLOR_");
    if (!packed) {
        Column plain = read_column(file_, *accessor);
        plain.normalized = plain.normalized || is_color;
        return plain;
    }
    const Json& normalized = member(element(file_.root(), "accessors", *accessor), "normalized");
    return draco()->column(*packed, is_color || (normalized.is_boolean() && normalized.get<bool>()));
}

uint64_t Primitive::vertices() {
    if (!vertices_) vertices_ = column("POSITION").count;
    return *vertices_;
}

MorphedColumn Primitive::attribute(const std::string& name, size_t width) {
    MorphedColumn morphed;
    morphed.base = column(name);
    if (name == "POSITION") {
        if (morphed.base.width != 3) throw Failure("POSITION is not a vector of three numbers");
        vertices_ = morphed.base.count;
    }
    const auto fits = [&](const Column& values) { return values.width >= width && values.count == vertices(); };
    if (!fits(morphed.base)) throw Failure(name + " does not match POSITION in count or type");
    const Json& targets = member(object_, "targets");
    for (size_t i = 0; i < weights_.size() && targets.is_array() && i < targets.size(); ++i) {
        const std::optional<uint64_t> accessor = whole_number(targets[i], name);
        if (!accessor || weights_[i] == 0) continue;
        morphed.targets.emplace_back(weights_[i], read_column(file_, *accessor));
        if (!fits(morphed.targets.back().second)) {
            throw Failure("a morph target of " + name + " does not match POSITION in count or type");
        }
    }
    return morphed;
}

std::vector<uint32_t> Primitive::corners() {
    const uint64_t count = vertices();
    const std::optional<uint64_t> accessor = whole_number(object_, "indices");
    // Draco's triangles are a list, whatever the mode was before.
    const uint64_t mode = draco() ? kTriangles : whole_number(object_, "mode").value_or(kTriangles);
    Indices indices;
    if (draco()) {
        indices.values = draco()->corners();
    } else if (accessor) {
        indices = read_indices(file_, *accessor);
    } else {
        if (count > UINT32_MAX) throw Failure("a primitive has more than 2^32 vertices");
        take(file_.memory(), count, sizeof(uint32_t), "its indices");
        for (uint64_t i = 0; i < count; ++i) indices.values.push_back(static_cast<uint32_t>(i));
    }
    const size_t most = mode == kTriangles ? indices.values.size() : 3 * indices.values.size();
    take(file_.memory(), most, sizeof(uint32_t), "its triangles");
    std::vector<uint32_t> corners;
    corners.reserve(most);
    size_t begin = 0;
    for (size_t i = 0; i < indices.values.size(); ++i) {
        const uint32_t vertex = indices.values[i];
        if (vertex < count) continue;
        if (vertex != indices.restart) {
            throw Failure("an index is " + std::to_string(vertex) + ", but its primitive has only " +
                          std::to_string(count) + " vertices");
        }
        add_run(mode, std::span(indices.values).subspan(begin, i - begin), corners);
        begin = i + 1;
    }
    add_run(mode, std::span(indices.values).subspan(begin), corners);
    return corners;
}

}  // namespace gim::gltf
