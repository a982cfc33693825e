// Draws a scene frame by frame and takes the time of each part.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/scene/scene.h"
#include "tools/scene/scene_lod.h"

namespace gim {

// Milliseconds of a frame, and what was drawn.
struct FrameFigures {
    double refine = 0, list = 0, upload = 0, draw = 0;
    uint64_t triangles = 0;  // that the CPU decided on
    uint64_t drawn = 0;      // that the GPU drew; 0 if nothing was drawn
    uint64_t patches = 0;
    double pixel_error = 0;
    double total() const { return refine + list + upload + draw; }
};

struct SceneFigures {
    std::string renderer;  // what drew; empty if nothing was drawn
    uint64_t bytes_of_files = 0, bytes_of_meshes = 0;
    std::vector<FrameFigures> adaptive, discrete, full;
};

struct SceneFrame {
    uint32_t number = 0, width = 0, height = 0;
    std::vector<uint8_t> rgb;  // top row first
};

struct SceneRun {
    bool draws = true;                                          // false: only what the CPU does
    bool compares = true;                                       // also with four discrete levels and at full resolution
    std::function<Result<void>(const SceneFrame&)> take_frame;  // of the adaptive run; may be empty
};

Result<SceneFigures> run_scene(const Scene& scene, const SceneRun& run);

// Whether this program was built with OpenGL.
bool can_draw_scenes();

}  // namespace gim
