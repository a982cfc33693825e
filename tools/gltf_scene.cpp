#include "tools/gltf_scene.h"

namespace gim::gltf {
namespace {

constexpr int kMaxDepth = 256;               // deeper trees are cycles or nonsense
constexpr uint64_t kMaxVisits = 1ULL << 20;  // nodes shared by shared nodes multiply quickly
constexpr uint64_t kNoParent = UINT64_MAX;

const std::string kCycle = "its nodes are nested too deeply (a cycle?)";

size_t count_of(const Json& root, const std::string& list) {
    const Json& values = member(root, list);
    return values.is_array() ? values.size() : 0;
}

Eigen::Affine3d transform_of(const Json& node) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    const std::vector<double> matrix = numbers(node, "matrix", 16);
    if (!matrix.empty()) {
        transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix.data());
        return transform;
    }
    const std::vector<double> translation = numbers(node, "translation", 3);
    const std::vector<double> q = numbers(node, "rotation", 4);
    const std::vector<double> scale = numbers(node, "scale", 3);
    if (!translation.empty()) transform.translate(Eigen::Map<const Eigen::Vector3d>(translation.data()));
    if (!q.empty()) transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
    if (!scale.empty()) transform.scale(Eigen::Map<const Eigen::Vector3d>(scale.data()));
    return transform;
}

bool is_visible(const Json& node) {
    const Json& visible = member(extension(node, "KHR_node_visibility"), "visible");
    return !visible.is_boolean() || visible.get<bool>();
}

class Walk {
  public:
    Walk(const Json& root, const std::function<void(const MeshInstance&)>& use) : root_(root), use_(use) {}

    void enter(uint64_t index, const Eigen::Affine3d& parent, int depth) {
        if (depth > kMaxDepth) throw Failure(kCycle);
        if (++visits_ > kMaxVisits) throw Failure("it has too many nodes");
        const Json& node = element(root_, "nodes", index);
        if (!is_visible(node)) return;
        const Eigen::Affine3d transform = parent * transform_of(node);
        const std::optional<uint64_t> mesh = whole_number(node, "mesh");
        if (mesh) use_({node, element(root_, "meshes", *mesh), transform});
        for (const uint64_t child : whole_numbers(node, "children")) enter(child, transform, depth + 1);
    }

  private:
    const Json& root_;
    const std::function<void(const MeshInstance&)>& use_;
    uint64_t visits_ = 0;
};

std::vector<uint64_t> parents_of(const Json& root) {
    std::vector<uint64_t> parents(count_of(root, "nodes"), kNoParent);
    for (uint64_t i = 0; i < parents.size(); ++i) {
        for (const uint64_t child : whole_numbers(element(root, "nodes", i), "children")) {
            if (child < parents.size() && parents[child] == kNoParent) parents[child] = i;
        }
    }
    return parents;
}

std::vector<uint64_t> top_nodes(const Json& root) {
    if (count_of(root, "scenes") != 0) {
        return whole_numbers(element(root, "scenes", whole_number(root, "scene").value_or(0)), "nodes");
    }
    const std::vector<uint64_t> parents = parents_of(root);
    std::vector<uint64_t> top;
    for (uint64_t i = 0; i < parents.size(); ++i) {
        if (parents[i] == kNoParent) top.push_back(i);
    }
    return top;
}

// Reads an attribute of the instances. Empty if there is none.
Column instance_column(File& file, const Json& attributes, const std::string& name, size_t width) {
    const std::optional<uint64_t> accessor = whole_number(attributes, name);
    if (!accessor) return {};
    Column column = read_column(file, *accessor);
    if (column.width != width) throw Failure("EXT_mesh_gpu_instancing: " + name + " has a wrong type");
    return column;
}

}  // namespace

void for_each_mesh(const Json& root, const std::function<void(const MeshInstance&)>& use) {
    if (count_of(root, "nodes") == 0) {
        const Json nothing;
        for (uint64_t i = 0; i < count_of(root, "meshes"); ++i) {
            use({nothing, element(root, "meshes", i), Eigen::Affine3d::Identity()});
        }
        return;
    }
    Walk walk(root, use);
    for (const uint64_t node : top_nodes(root)) walk.enter(node, Eigen::Affine3d::Identity(), 0);
}

std::vector<Eigen::Affine3d> instances_of(File& file, const Json& node) {
    const Json& attributes = member(extension(node, "EXT_mesh_gpu_instancing"), "attributes");
    std::vector<Eigen::Affine3d> transforms;
    if (!attributes.is_object() || attributes.empty()) return {Eigen::Affine3d::Identity()};
    const Column translation = instance_column(file, attributes, "TRANSLATION", 3);
    const Column rotation = instance_column(file, attributes, "ROTATION", 4);
    const Column scale = instance_column(file, attributes, "SCALE", 3);
    // Attributes of other names only count the instances.
    const std::string any = attributes.begin().key();
    const uint64_t accessor = whole_number(attributes, any).value_or(UINT64_MAX);
    const uint64_t count = whole_number(element(file.root(), "accessors", accessor), "count").value_or(0);
    for (const Column* column : {&translation, &rotation, &scale}) {
        if (column->width != 0 && column->count != count) {
            throw Failure("EXT_mesh_gpu_instancing: its attributes have different counts");
        }
    }
    take(file.memory(), count, sizeof(Eigen::Affine3d), "its instances");
    transforms.reserve(count);
    for (uint64_t i = 0; i < count; ++i) {
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        const auto vector = [&](const Column& from) {
            return Eigen::Vector3d(from.at(i, 0), from.at(i, 1), from.at(i, 2));
        };
        if (translation.width != 0) transform.translate(vector(translation));
        if (rotation.width != 0) {
            transform.rotate(
                Eigen::Quaterniond(rotation.at(i, 3), rotation.at(i, 0), rotation.at(i, 1), rotation.at(i, 2))
                    .normalized());
        }
        if (scale.width != 0) transform.scale(vector(scale));
        transforms.push_back(transform);
    }
    return transforms;
}

NodeTransforms::NodeTransforms(const Json& root) : root_(root), parents_(parents_of(root)) {}

Eigen::Affine3d NodeTransforms::to_world(uint64_t node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    for (int depth = 0; node != kNoParent; ++depth) {
        if (depth > kMaxDepth) throw Failure(kCycle);
        transform = transform_of(element(root_, "nodes", node)) * transform;
        node = parents_[node];
    }
    return transform;
}

}  // namespace gim::gltf
