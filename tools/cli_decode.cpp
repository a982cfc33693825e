// The command line of gim decode. The help texts are the manual.
#include <memory>

#include "tools/cli_parts.h"
#include "tools/commands.h"
#include "tools/file.h"
#include "tools/raster_file.h"
#include "tools/surface_write.h"

namespace gim {

namespace {

constexpr const char* kExtensions = ".ply, .obj, .off, .stl, .glb, .exr or .npz";

CLI::Validator picture_name() {
    return {[](const std::string& path) -> std::string {
                const std::string extension = extension_of(path);
                return extension == "png" || extension == "exr" ? "" : "'" + path + "' must end in .png or .exr";
            },
            "FILE"};
}

// The name of the output tells its format, unless --format does.
void check_format(const DecodeCommand& c) {
    const std::string extension = extension_of(c.output);
    if (!c.format.empty() || surface_format_of(extension) || raster_format_of({}, extension)) return;
    throw CLI::ValidationError("OUT", "'" + c.output + "' must end in " + kExtensions + ", or take --format");
}

}  // namespace

Subcommand add_decode(CLI::App& app) {
    const auto command = std::make_shared<DecodeCommand>();
    DecodeCommand& c = *command;
    CLI::App* sub = app.add_subcommand("decode", "Turn a .gim file into a mesh or an EXR image");
    sub->footer(
        "The extension of OUT chooses the format, or --format. ply, obj and off share the vertices on the cut. glb "
        "repeats them, with\n"
        "equal positions, because texture coordinates jump there. exr holds the samples: float32 channels X, Y, Z\n"
        "and mask. Far from 0, where float32 does not do, ply, obj and off hold float64, glb a node translation, exr\n"
        "the attribute gimOrigin; stl is rounded, with a warning.\n"
        "An image that gim encode imported comes back as .npz or .exr, with its shape, its type and its mask: the "
        "array\n"
        "'image', and 'mask' if the mask was an array of its own.\n"
        "IN may be a .glb of gim encode: then its meshes become plain glTF arrays, and all else stays.\n"
        "Colours become vertex colours (ply, obj) or the base-colour texture (glb). A normal map becomes the normal\n"
        "texture (glb).\n\n"
        "  gim decode bunny.gim bunny.ply\n"
        "  gim decode bunny.gim bunny-129.glb --level 1\n"
        "  gim decode scene-with-gim.glb plain.glb\n"
        "  gim decode bunny.gim bunny.obj --normal-map normals.png --color-map colors.png\n"
        "  gim decode atlas.gim atlas.npz\n"
        "  gim decode bunny.gim - --format stl | other-program");
    sub->add_option("IN", c.input, ".gim file, or glTF with such meshes, to read (-: standard input)")->required();
    sub->add_option("OUT", c.output, std::string("File to write: ") + kExtensions + " (-: standard output)")
        ->required();
    sub->add_option("--format", c.format, "Format of OUT. Default: its extension")
        ->transform(CLI::IsMember({"ply", "obj", "off", "stl", "glb", "exr", "npz"}, CLI::ignore_case).description(""))
        ->type_name("ply|obj|off|stl|glb|exr|npz");
    sub->final_callback([command] { check_format(*command); });
    sub->add_option("--level", c.level, "Level to decode. 0: full resolution; each next level halves the sides")
        ->capture_default_str();
    sub->add_option(
           "--normal-map", c.normal_map,
           "Write the file's normal map here, in object space: .png (16 bits, 0 to 65535 means -1 to 1) or .exr. "
           "Several images become FILE-0, FILE-1, ...")
        ->check(picture_name());
    sub->add_option(
           "--color-map", c.color_map,
           "Write the file's colours here: .png (sRGB) or .exr (linear). If OUT is an .obj file, also write an .mtl "
           "beside it that names them")
        ->check(picture_name());
    sub->add_flag("--plain", c.plain,
                  "Leave out displacements, which gim emboss has added. They are in meshes at level 0");
    sub->add_flag("--fused", c.fused, "GLB: share the vertices on the cut and leave out texture coordinates");
    sub->add_flag("--split-sharp", c.split_sharp,
                  "PLY: repeat the vertices on sharp edges, so that their normals show the edges. The mesh is then no "
                  "longer watertight by its indices");
    return {sub, [command] { return run_decode(*command); }};
}

}  // namespace gim
