// A scene of many instances of a few .gim files, and a camera that moves through it. As gim bench-scene reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gim/encoder.h"

namespace gim {

struct SceneInstance {
    uint32_t mesh = 0;                    // index of Scene.meshes
    std::array<double, 3> position = {};  // of the middle of the mesh's box
    double size = 1;                      // of the longest side of that box
    double turn = 0;                      // degrees about the z axis
};

struct CameraKey {
    std::array<double, 3> eye = {}, target = {};
};

struct SceneMesh {
    std::string path;
    bool is_y_up = false;  // it is stood up: its y axis becomes the scene's z axis
};

struct Scene {
    std::vector<SceneMesh> meshes;
    std::vector<SceneInstance> instances;
    std::vector<CameraKey> path;  // the camera goes from key to key in equal times; +z is up
    uint32_t frames = 60, width = 1280, height = 720;
    double field_of_view = 50;  // degrees, from the lower to the upper edge
    double pixel_error = 1;
    uint32_t most_triangles = 1000000;    // of all instances together, in a frame
    uint32_t instance_triangles = 20000;  // room for each instance
    bool tessellates = false;             // patches are drawn by tessellation shaders, not by a compute shader
    bool gpu_refines = false;  // the CPU leaves four times the error, and the GPU halves cells where a screen shows it

    // The camera in a frame, 0 .. frames - 1.
    CameraKey camera(uint32_t frame) const;
};

// text: JSON. folder: what paths are relative to. Errors name the field.
Result<Scene> read_scene(const std::string& text, const std::string& folder);

}  // namespace gim
