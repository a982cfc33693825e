// The command line of gim emboss. The help texts are the manual.
#include <memory>
#include <vector>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

void take_place(const std::vector<double>& at, EmbossOptions* options) {
    if (at.size() == 2) options->at = EmbossOptions::TextureCoordinates{at[0], at[1]};
    if (at.size() == 3) options->at = std::array<double, 3>{at[0], at[1], at[2]};
}

}  // namespace

Subcommand add_emboss(CLI::App& app) {
    const auto command = std::make_shared<EmbossCommand>();
    const auto at = std::make_shared<std::vector<double>>();
    const auto up = std::make_shared<std::vector<double>>(std::vector<double>{0, 0, 1});
    EmbossCommand& c = *command;
    CLI::App* sub = app.add_subcommand("emboss", "Press a picture into the surface of a .gim file, or raise it");
    sub->footer(
        "White is raised by --depth, black stays. The picture is laid on the surface around the place that --at "
        "names,\n"
        "upright as --up says. It takes texels finer than the file's samples, but no finer mesh elsewhere: decoded\n"
        "meshes are fine near the picture only, and without cracks. Readers that do not know displacements show the\n"
        "surface without them. What the file has embossed already stays. For files of --layout tiles or gim.\n\n"
        "  gim emboss torus.gim signed.gim --image word.png --at 0.8,0,0.2 --size 0.6 --depth 0.02\n"
        "  gim emboss torus.gim engraved.gim --image word.png --at 0.31,0.77 --size 0.6 --depth -0.02 --invert");
    sub->add_option("IN", c.input, ".gim file to read (-: standard input)")->required();
    sub->add_option("OUT", c.output, ".gim file to write (-: standard output)")->required();
    sub->add_option("--image", c.picture, "Picture to emboss: PNG, JPEG, TGA or BMP; its brightness counts")
        ->required();
    sub->add_option(
           "--at", *at,
           "Where the picture's middle lies. X,Y,Z: at the nearest point of the surface. U,V: at these texture "
           "coordinates of the image, as a decoded GLB has them")
        ->delimiter(',')
        ->expected(2, 3)
        ->required()
        ->type_name("X,Y,Z|U,V");
    sub->add_option("--size", c.options.size,
                    "Length of the picture's longer side on the surface, in units of the mesh")
        ->check(finite_range(1e-300, 1e300, "a length above 0"))
        ->required();
    sub->add_option("--depth", c.options.depth, "How far white is raised, in units of the mesh. Below 0: engraved")
        ->check(finite_range(-1e300, 1e300, "a length"))
        ->required();
    sub->add_option("--up", *up, "Direction of the picture's upper side")
        ->delimiter(',')
        ->expected(3)
        ->type_name("X,Y,Z")
        ->default_str("0,0,1");
    sub->add_option("--turn", c.options.turn, "Degrees to turn the picture counter-clockwise")
        ->check(finite_range(-1e6, 1e6, "an angle"))
        ->capture_default_str();
    sub->add_flag("--invert", c.invert, "Raise black, not white");
    sub->add_option("--part", c.options.image, "Image of the file, for files of several")->capture_default_str();
    sub->add_option("--texels", c.options.texel_exponent,
                    "2^N texels for each step between samples, 0 to 6. Default: about one for each pixel")
        ->check(CLI::Range(0, 6))
        ->type_name("N");
    sub->add_flag("--json", c.json, "Print JSON");
    sub->final_callback([command, at, up] {
        take_place(*at, &command->options);
        command->options.up = {(*up)[0], (*up)[1], (*up)[2]};
    });
    return {sub, [command] { return run_emboss(*command); }};
}

}  // namespace gim
