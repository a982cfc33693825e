// The command line of gim bench-scene. The help texts are the manual.
#include <memory>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {

Subcommand add_bench_scene(CLI::App& app) {
    const auto command = std::make_shared<BenchSceneCommand>();
    BenchSceneCommand& c = *command;
    CLI::App* sub = app.add_subcommand("bench-scene", "Draw many instances with cascading levels, and time the parts");
    sub->footer(
        "A camera moves through instances of a few .gim files. In each frame the CPU refines every instance for its\n"
        "distance and the budget, and a GPU draws its patches, without a window. The same frames are then drawn with\n"
        "four discrete levels, and at full resolution.\n\n"
        "SCENE is JSON:\n"
        "  {\"meshes\": [\"horse.gim\", \"dragon.gim\"],\n"
        "   \"grid\": {\"columns\": 20, \"rows\": 20, \"spacing\": 1.5, \"size\": 1},\n"
        "   \"camera\": [{\"eye\": [0, -20, 4], \"target\": [0, 0, 0]}, {\"eye\": [0, -2, 1], \"target\": [0, 5, "
        "0]}],\n"
        "   \"frames\": 60, \"width\": 1280, \"height\": 720, \"field_of_view\": 50, \"pixel_error\": 1,\n"
        "   \"most_triangles\": 1000000, \"instance_triangles\": 20000, \"gpu_refines\": false}\n"
        "A mesh whose y axis points up: {\"file\": \"bunny.gim\", \"up\": \"y\"}.\n"
        "In place of a grid: \"instances\": [{\"mesh\": 0, \"position\": [0, 0, 0], \"size\": 1, \"turn\": 90}, ...].\n"
        "Paths are relative to SCENE, +z is up, sizes are those of the longest side. With gpu_refines the CPU leaves\n"
        "four times the error, and the GPU halves the cells of instances where it would show. With \"tessellates\": "
        "true\n"
        "tessellation shaders draw the patches, else a compute shader. Displacements of gim emboss are drawn too.");
    sub->add_option("SCENE", c.scene, "Scene to draw (-: standard input)")->required();
    sub->add_option("--frames", c.frames, "Folder for pictures of the frames: frame-00000.png, ...");
    sub->add_option("--json", c.json, "Write the figures here (-: standard output)");
    sub->add_flag("!--no-draw", c.draws, "Only what the CPU does; needs no OpenGL");
    sub->add_flag("!--no-compare", c.compares, "Leave out discrete levels and full resolution");
    return {sub, [command] { return run_bench_scene(*command); }};
}

}  // namespace gim
