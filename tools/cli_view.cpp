// The command lines of gim info, compare and render. The help texts are the manual.
#include <memory>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

constexpr const char* kUnknownNames =
    "Format of a mesh whose name has no known extension, as that of standard input. Default: its content tells";

}  // namespace

Subcommand add_info(CLI::App& app) {
    const auto command = std::make_shared<InfoCommand>();
    InfoCommand& c = *command;
    CLI::App* sub = app.add_subcommand("info", "Describe a .gim file and check its bytes");
    sub->footer("The exit status is 1 if a chunk is damaged or missing, or if the file does not decode.");
    sub->add_option("IN", c.input, ".gim file to read (-: standard input)")->required();
    sub->add_flag("--json", c.json, "Print JSON");
    sub->add_flag(
        "--clusters", c.clusters,
        "Also make clusters of 8 x 8 cells, as a renderer may cull them, and tell for each depth: how many, how "
        "well they suit a vertex cache, how many triangles are culled by their normal cones, and how far they "
        "are from the finest samples. Charts have none");
    return {sub, [command] { return run_info(*command); }};
}

Subcommand add_compare(CLI::App& app) {
    const auto command = std::make_shared<CompareCommand>();
    CompareCommand& c = *command;
    CLI::App* sub = app.add_subcommand("compare", "Measure the distance between two surfaces");
    sub->footer(
        "Either file may be a mesh or a .gim file. One of them may be -, standard input.\n"
        "PSNR = 20 log10(diagonal / d). The diagonal is that of the reference's bounding box. d is the RMS distance\n"
        "from points of one surface to the other surface, weighted by area: both ways, the larger counts.\n"
        "Normals: the mean angle between shading normals. Samples are uniform by area, on both surfaces; each is\n"
        "compared with the nearest point of the other surface. Shading normals are interpolated between vertex\n"
        "normals. A vertex normal is the area-weighted mean of the triangles around all vertices at its position.\n"
        "Normals in the files do not count.\n"
        "Folded over: triangles of TEST that look away from the triangle of REFERENCE nearest to their centroid, and "
        "the\n"
        "share of TEST's area that does. Edges folded back: two triangles meet there at more than 150 degrees between\n"
        "their normals. Off by > 20, > 45: the share of TEST's area whose shading normal is off by more degrees. This\n"
        "angle and its percentiles take the angle-weighted mean for a vertex normal, as most renderers do. gim render\n"
        "--defects shows where the defects are.\n"
        "Vertices at equal positions are joined only if the format cannot share them (STL, glTF).\n"
        "In JSON, a PSNR of null means that the surfaces are equal.");
    sub->add_option("REFERENCE", c.reference, "Surface to compare with: mesh or .gim file")->required();
    sub->add_option("TEST", c.test, "Surface to judge: mesh or .gim file")->required();
    add_mesh_format(sub, c.format, kUnknownNames);
    sub->add_option("--level", c.level, "Level to decode if TEST is a .gim file")->capture_default_str();
    sub->add_option("--samples", c.options.samples,
                    "Samples on each surface. Default: 4 for each face of both, 100000 to 500000")
        ->check(CLI::Range(1000, 100000000));
    sub->add_option("--seed", c.options.seed, "Same seed, same figures")->capture_default_str();
    sub->add_option("--threads", c.options.threads, "Number of threads, 0: all cores. The figures do not depend on it")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    add_max_memory(sub, c.max_memory);
    sub->add_flag("--json", c.json, "Print JSON");
    return {sub, [command] { return run_compare(*command); }};
}

Subcommand add_render(CLI::App& app) {
    const auto command = std::make_shared<RenderCommand>();
    RenderCommand& c = *command;
    CLI::App* sub = app.add_subcommand("render", "Draw a mesh or a .gim file as a PNG");
    sub->footer(
        "Faces seen from behind are reddish.\n\n"
        "  gim render bunny.ply bunny.png\n"
        "  gim render bunny.ply all.png --gim bunny.gim     original, geometry image, reconstruction\n"
        "  gim render bunny.gim defects.png --defects bunny.ply --size 1024\n"
        "  gim render broken.ply look.png --flat --wire --azimuth 200");
    sub->add_option("IN", c.input, "Mesh or .gim file (-: standard input)")->required();
    sub->add_option("OUT", c.output, "PNG to write (-: standard output)")->required();
    add_mesh_format(sub, c.format, kUnknownNames);
    sub->add_option("--gim", c.gim,
                    "Draw three panels: IN, this file's image (x y z as red green blue) and its surface");
    sub->add_option(
           "--defects", c.defects,
           "Compare the surface with this mesh or .gim file and paint it. Red: triangles folded over. Dark red: "
           "edges folded back. Orange: the shading normal is off by more than 45 degrees; pale yellow: by more "
           "than 20. Bluish: seen from behind. With --gim: paints that file's surface")
        ->type_name("REFERENCE");
    sub->add_option("--level", c.level, "Level of the .gim file to draw")->capture_default_str();
    sub->add_option("--size", c.size, "Pixels per side of a panel")->check(CLI::Range(16, 4096))->capture_default_str();
    sub->add_option("--up", c.up, "Axis that points up")
        ->check(CLI::IsMember({"auto", "x", "y", "z"}))
        ->capture_default_str();
    sub->add_option("--azimuth", c.azimuth, "Turn the model about the up axis, in degrees")
        ->check(finite_range(-360, 360, "DEG"))
        ->capture_default_str();
    sub->add_option("--elevation", c.elevation, "Look down from above, in degrees")
        ->check(finite_range(-90, 90, "DEG"))
        ->capture_default_str();
    sub->add_flag("--flat", c.flat, "Shade each triangle with one normal");
    add_max_memory(sub, c.max_memory);
    sub->add_flag("--wire", c.wire, "Draw the edges");
    return {sub, [command] { return run_render(*command); }};
}

}  // namespace gim
