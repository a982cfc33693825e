// In place of gl_painter.cpp in a build without OpenGL.
#include "tools/scene/scene_painter.h"
#include "tools/scene/scene_run.h"

namespace gim {

bool can_draw_scenes() { return false; }

Result<std::unique_ptr<ScenePainter>> make_painter(const Scene&, const std::vector<SceneSurface>&) {
    return Error{Stage::kWrite,
                 "this gim was built without OpenGL: install libepoxy-dev and build again, or take --no-draw"};
}

}  // namespace gim
