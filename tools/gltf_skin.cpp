#include "tools/gltf_skin.h"

namespace gim::gltf {
namespace {

// From the mesh to the world, for each joint.
std::vector<Eigen::Affine3d> joint_transforms(File& file, const NodeTransforms& nodes, uint64_t index) {
    const Json& skin = element(file.root(), "skins", index);
    const std::vector<uint64_t> joints = whole_numbers(skin, "joints");
    const std::optional<uint64_t> accessor = whole_number(skin, "inverseBindMatrices");
    Column inverse;
    if (accessor) {
        inverse = read_column(file, *accessor);
        if (inverse.width != 16 || inverse.count < joints.size()) {
            throw Failure("its inverse bind matrices do not match its joints");
        }
    }
    std::vector<Eigen::Affine3d> transforms;
    for (size_t j = 0; j < joints.size(); ++j) {
        Eigen::Affine3d bind = Eigen::Affine3d::Identity();
        for (int k = 0; accessor && k < 16; ++k) bind.matrix()(k % 4, k / 4) = inverse.at(j, static_cast<size_t>(k));
        transforms.push_back(nodes.to_world(joints[j]) * bind);
    }
    return transforms;
}

// Which joints move a vertex, and how much: JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ...
struct Influences {
    std::vector<MorphedColumn> joints;
    std::vector<MorphedColumn> weights;
};

Influences influences_of(Primitive& primitive) {
    Influences influences;
    for (size_t set = 0; primitive.has("JOINTS_" + std::to_string(set)); ++set) {
        influences.joints.push_back(primitive.attribute("JOINTS_" + std::to_string(set), 4));
        influences.weights.push_back(primitive.attribute("WEIGHTS_" + std::to_string(set), 4));
    }
    if (influences.joints.empty()) throw Failure("its mesh has no JOINTS_0");
    return influences;
}

using Matrix34 = Eigen::Matrix<double, 3, 4>;

// The weighted mean of the transforms of a vertex's joints. A vertex without weights follows its first joint.
Matrix34 blend(const Influences& influences, const std::vector<Eigen::Affine3d>& joints, uint32_t row) {
    Matrix34 sum = Matrix34::Zero();
    double weights = 0;
    const auto joint_at = [&](size_t set, size_t k) {
        const double joint = influences.joints[set].at(row, k);
        if (!(joint >= 0 && joint < static_cast<double>(joints.size()))) {
            throw Failure("vertex " + std::to_string(row) + " follows a joint that it lacks");
        }
        return Matrix34(joints[static_cast<size_t>(joint)].matrix().topRows<3>());
    };
    for (size_t set = 0; set < influences.joints.size(); ++set) {
        for (size_t k = 0; k < 4; ++k) {
            const double weight = influences.weights[set].at(row, k);
            if (weight == 0) continue;
            sum += weight * joint_at(set, k);
            weights += weight;
        }
    }
    return weights > 0 ? Matrix34(sum / weights) : joint_at(0, 0);
}

}  // namespace

SkinnedVertices apply_skin(File& file, const NodeTransforms& nodes, uint64_t skin, Primitive& primitive,
                           const MorphedColumn& positions, std::span<const uint32_t> rows) {
    const std::vector<Eigen::Affine3d> joints = joint_transforms(file, nodes, skin);
    const Influences influences = influences_of(primitive);
    SkinnedVertices skinned;
    skinned.positions.reserve(rows.size());
    size_t mirrored = 0;
    for (const uint32_t row : rows) {
        const Matrix34 transform = blend(influences, joints, row);
        const Eigen::Vector4d point(positions.at(row, 0), positions.at(row, 1), positions.at(row, 2), 1);
        skinned.positions.push_back(transform * point);
        if (transform.leftCols<3>().determinant() < 0) ++mirrored;
    }
    skinned.mirrored = 2 * mirrored > rows.size();
    return skinned;
}

}  // namespace gim::gltf
