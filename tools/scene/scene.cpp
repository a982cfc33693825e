#include "tools/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace gim {
namespace {

using nlohmann::json;

Error wrong(const std::string& what) { return {Stage::kInput, "scene: " + what}; }

// Fields of a scene, read with checks. The first fault is kept.
class Fields {
  public:
    explicit Fields(std::string* fault) : fault_(fault) {}

    double number(const json& of, const char* name, double otherwise, double low, double high) {
        if (!of.contains(name)) return otherwise;
        const json& value = of[name];
        if (!value.is_number() || !(value.get<double>() >= low) || !(value.get<double>() <= high)) {
            fail(std::string(name) + " must be a number from " + json(low).dump() + " to " + json(high).dump());
            return otherwise;
        }
        return value.get<double>();
    }
    uint32_t count(const json& of, const char* name, uint32_t otherwise, uint32_t low, uint32_t high) {
        return static_cast<uint32_t>(number(of, name, otherwise, low, high));
    }
    bool flag(const json& of, const char* name) {
        if (!of.contains(name)) return false;
        if (!of[name].is_boolean()) fail(std::string(name) + " must be true or false");
        return of[name].is_boolean() && of[name].get<bool>();
    }
    std::array<double, 3> point(const json& of, const char* name) {
        std::array<double, 3> p = {};
        if (!of.contains(name) || !of[name].is_array() || of[name].size() != 3 ||
            !std::all_of(of[name].begin(), of[name].end(), [](const json& x) { return x.is_number(); })) {
            fail(std::string(name) + " must be three numbers");
            return p;
        }
        for (size_t k = 0; k < 3; ++k) p[k] = of[name][k].get<double>();
        return p;
    }
    void fail(const std::string& what) {
        if (fault_->empty()) *fault_ = what;
    }

  private:
    std::string* fault_;
};

constexpr double kFar = 1e9;
constexpr uint32_t kMostInstances = 100000;

// Rows and columns of instances on the ground, each turned by the golden angle against the one before.
std::vector<SceneInstance> grid_of(const json& grid, uint32_t meshes, Fields& fields) {
    const uint32_t columns = fields.count(grid, "columns", 20, 1, 1000), rows = fields.count(grid, "rows", 20, 1, 1000);
    const double spacing = fields.number(grid, "spacing", 1.5, 0, kFar),
                 size = fields.number(grid, "size", 1, 1e-9, kFar);
    std::vector<SceneInstance> instances;
    if (uint64_t{columns} * rows > kMostInstances) {
        fields.fail("the grid has more than " + std::to_string(kMostInstances) + " instances");
        return instances;
    }
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t c = 0; c < columns; ++c) {
            const auto i = static_cast<uint32_t>(instances.size());
            instances.push_back({(c + r) % meshes,
                                 {(c - 0.5 * (columns - 1)) * spacing, (r - 0.5 * (rows - 1)) * spacing, size / 2},
                                 size,
                                 std::fmod(137.508 * i, 360.0)});
        }
    }
    return instances;
}

std::vector<SceneInstance> list_of(const json& list, uint32_t meshes, Fields& fields) {
    std::vector<SceneInstance> instances;
    for (const json& item : list) {
        SceneInstance instance;
        instance.mesh = fields.count(item, "mesh", 0, 0, meshes - 1);
        instance.position = fields.point(item, "position");
        instance.size = fields.number(item, "size", 1, 1e-9, kFar);
        instance.turn = fields.number(item, "turn", 0, -kFar, kFar);
        instances.push_back(instance);
    }
    if (instances.size() > kMostInstances) fields.fail("more than " + std::to_string(kMostInstances) + " instances");
    return instances;
}

}  // namespace

CameraKey Scene::camera(uint32_t frame) const {
    const double at = frames > 1 ? double(frame) / (frames - 1) * double(path.size() - 1) : 0;
    const auto from = std::min(static_cast<size_t>(at), path.size() - 1);
    const CameraKey &a = path[from], &b = path[std::min(from + 1, path.size() - 1)];
    const double t = at - double(from);
    CameraKey key;
    for (size_t k = 0; k < 3; ++k) {
        key.eye[k] = a.eye[k] + t * (b.eye[k] - a.eye[k]);
        key.target[k] = a.target[k] + t * (b.target[k] - a.target[k]);
    }
    return key;
}

Result<Scene> read_scene(const std::string& text, const std::string& folder) {
    const json root = json::parse(text, nullptr, false);
    if (root.is_discarded() || !root.is_object()) return wrong("not a JSON object");
    std::string fault;
    Fields fields(&fault);
    Scene scene;
    if (!root.contains("meshes") || !root["meshes"].is_array() || root["meshes"].empty())
        return wrong("meshes must be a list of .gim files");
    for (const json& mesh : root["meshes"]) {
        const json& name = mesh.is_object() && mesh.contains("file") ? mesh["file"] : mesh;
        if (!name.is_string()) return wrong("meshes must be a list of .gim files");
        const std::string up = mesh.is_object() ? mesh.value("up", "z") : "z";
        if (up != "y" && up != "z") fields.fail("up must be \"y\" or \"z\"");
        scene.meshes.push_back({(std::filesystem::path(folder) / name.get<std::string>()).string(), up == "y"});
    }
    const auto meshes = static_cast<uint32_t>(scene.meshes.size());
    if (root.contains("instances") && root["instances"].is_array())
        scene.instances = list_of(root["instances"], meshes, fields);
    else if (root.contains("grid") && root["grid"].is_object())
        scene.instances = grid_of(root["grid"], meshes, fields);
    else
        return wrong("it needs instances, a list, or a grid");
    if (!root.contains("camera") || !root["camera"].is_array() || root["camera"].empty())
        return wrong("camera must be a list of places, each with eye and target");
    for (const json& key : root["camera"])
        scene.path.push_back({fields.point(key, "eye"), fields.point(key, "target")});
    scene.frames = fields.count(root, "frames", scene.frames, 1, 100000);
    scene.width = fields.count(root, "width", scene.width, 16, 8192);
    scene.height = fields.count(root, "height", scene.height, 16, 8192);
    scene.field_of_view = fields.number(root, "field_of_view", scene.field_of_view, 1, 170);
    scene.pixel_error = fields.number(root, "pixel_error", scene.pixel_error, 0.01, 1000);
    scene.most_triangles = fields.count(root, "most_triangles", scene.most_triangles, 1, 1u << 30);
    scene.instance_triangles = fields.count(root, "instance_triangles", scene.instance_triangles, 2, 1u << 28);
    scene.gpu_refines = fields.flag(root, "gpu_refines");
    scene.tessellates = fields.flag(root, "tessellates");
    if (scene.instances.empty()) fields.fail("there are no instances");
    if (!fault.empty()) return wrong(fault);
    return scene;
}

}  // namespace gim
