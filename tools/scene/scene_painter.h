// Draws the patches of a frame on a GPU.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/scene/scene.h"
#include "tools/scene/scene_lod.h"

namespace gim {

class ScenePainter {
  public:
    virtual ~ScenePainter() = default;
    virtual std::string renderer() const = 0;
    // Sends what the frame needs to the GPU, and waits for it.
    virtual void upload(const SceneLod& lod, LodWay way, const CameraKey& camera, const FramePatches& patches) = 0;
    // Draws what was sent, and waits for it. Returns the number of triangles; 0 where the tessellator makes them.
    virtual Result<uint64_t> draw() = 0;
    // The rgb of the last frame, top row first.
    virtual std::vector<uint8_t> picture() const = 0;
};

// Keeps references. An Error says what is missing: a build with OpenGL, or a driver.
Result<std::unique_ptr<ScenePainter>> make_painter(const Scene& scene, const std::vector<SceneSurface>& surfaces);

}  // namespace gim
