// gim decode: writes one level of a .gim file as a mesh or an EXR image, and its planes as pictures.
#include <array>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/encode_glb.h"
#include "tools/file.h"
#include "tools/output_files.h"
#include "tools/plane_write.h"
#include "tools/raster_file.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

using Images = std::vector<DecodedImage>;

struct OutputFile {
    std::string role;
    std::string path;
    Bytes bytes;
};

// Several images get a file each: name-0.png, name-1.png, ...
std::string path_of_image(const std::string& path, size_t image, size_t count) {
    if (count == 1) return path;
    const std::filesystem::path p(path);
    return (p.parent_path() / (p.stem().string() + "-" + std::to_string(image) + p.extension().string())).string();
}

enum class Kind { kNormals, kColors };

Result<Bytes> write_plane(Kind kind, const ImagePlane& plane, const std::string& path) {
    const bool exr = extension_of(path) == "exr";
    if (kind == Kind::kNormals) return exr ? write_normal_exr(plane) : write_normal_png(plane);
    return exr ? write_color_exr(plane) : write_color_png(plane);
}

Result<void> add_planes(Kind kind, const std::string& path, const Images& images, std::vector<OutputFile>& files) {
    for (size_t i = 0; i < images.size(); ++i) {
        const ImagePlane& plane = kind == Kind::kNormals ? images[i].normal_map : images[i].colors;
        if (!plane.is_there()) {
            return Error{Stage::kWrite, kind == Kind::kNormals
                                            ? "the .gim file has no normal map; encode it with --normals N"
                                            : "the .gim file has no colours; encode a mesh with colours"};
        }
        const std::string name = path_of_image(path, i, images.size());
        Result<Bytes> bytes = write_plane(kind, plane, name);
        if (!bytes.ok()) return bytes.error();
        files.push_back({kind == Kind::kNormals ? "--normal-map" : "--color-map", name, std::move(bytes.value())});
    }
    return {};
}

// Returns an .mtl file with materials image0, image1, ... Its texture paths are relative to its own folder.
Bytes material_text(const std::string& mtl_path, const std::string& color_path, size_t count) {
    std::string text = "# decoded by gim\n";
    for (size_t i = 0; i < count; ++i) {
        const std::string path = path_of_image(color_path, i, count);
        const std::string near = std::filesystem::absolute(path)
                                     .lexically_proximate(std::filesystem::absolute(mtl_path).parent_path())
                                     .generic_string();
        text += "newmtl image" + std::to_string(i) + "\nKd 1 1 1\nmap_Kd " + near + "\n";
    }
    return {text.begin(), text.end()};
}

// Where the .mtl of an .obj goes: beside it. Empty: the command makes none.
std::string material_path(const DecodeCommand& command, SurfaceFormat format) {
    const bool has_folder = !is_written_in_place(command.output);
    if (format != SurfaceFormat::kObj || command.color_map.empty() || !has_folder) return {};
    return std::filesystem::path(command.output).replace_extension(".mtl").string();
}

// Writes all files or none. The names of several images' pictures are known only here.
int write_all_files(const DecodeCommand& command, std::vector<OutputFile> files) {
    std::vector<NamedFile> names = {{"IN", command.input, Direction::kRead}};
    for (const OutputFile& file : files) names.push_back({file.role, file.path, Direction::kWrite});
    if (const auto failure = find_clash(names)) return report_error(*failure);
    OutputFiles outputs;
    for (OutputFile& file : files) {
        const Result<void> staged = outputs.stage(file.path, std::move(file.bytes));
        if (!staged.ok()) return report_error(shown_name(file.path, Direction::kWrite), staged.error());
    }
    if (const auto failure = outputs.commit()) return report_error(*failure);
    return 0;
}

// Whether the options are those that a whole glTF file takes.
std::optional<Error> check_options_of_glb(const DecodeCommand& command, SurfaceFormat format) {
    if (format != SurfaceFormat::kGlb)
        return Error{Stage::kInput, "this is glTF with a whole scene; decode it to a .glb file"};
    if (command.fused || command.split_sharp || !command.normal_map.empty() || !command.color_map.empty())
        return Error{Stage::kInput, "glTF has its arrays and pictures as it is; only --level tells how to decode it"};
    return {};
}

int decode_glb_file(const DecodeCommand& command, const Bytes& file, SurfaceFormat format) {
    const std::string input_name = shown_name(command.input, Direction::kRead);
    if (const auto error = check_options_of_glb(command, format)) return report_error(input_name, *error);
    const std::string folder = std::filesystem::path(command.input).parent_path().string();
    ReadContext context{folder, nullptr, MemoryBudget(default_max_memory())};
    Result<Bytes> glb = decode_glb({reinterpret_cast<const char*>(file.data()), file.size()}, context, command.level);
    print_warnings(input_name, context.warnings);
    if (!glb.ok()) return report_error(input_name, glb.error());
    return write_all_files(command, {{"OUT", command.output, std::move(glb.value())}});
}

// The imported image itself.
int decode_raster_file(const DecodeCommand& command, const Bytes& file, RasterFormat format) {
    const std::string input_name = shown_name(command.input, Direction::kRead);
    if (command.level != 0) return report_error(input_name, {Stage::kInput, describe_status(GIM_NO_SUCH_LEVEL)});
    const Result<RasterImage> image = decode_raster_image(file);
    if (!image.ok()) return report_error(input_name, image.error());
    Result<Bytes> bytes = write_raster_file(image.value(), format);
    if (!bytes.ok()) return report_error(shown_name(command.output, Direction::kWrite), bytes.error());
    return write_all_files(command, {{"OUT", command.output, std::move(bytes.value())}});
}

}  // namespace

int run_decode(const DecodeCommand& command) {
    const std::string input_name = shown_name(command.input, Direction::kRead);
    const std::string output_name = shown_name(command.output, Direction::kWrite);
    const std::string extension = command.format.empty() ? extension_of(command.output) : command.format;
    const std::optional<SurfaceFormat> format = surface_format_of(extension);
    const std::optional<RasterFormat> image_format = raster_format_of({}, extension);
    if (!format && !image_format)
        return report_error(output_name, {Stage::kWrite, "unknown format; use ply, obj, off, stl, glb, exr or npz"});
    const std::string mtl = format ? material_path(command, *format) : std::string();
    const std::array<NamedFile, 5> names = {{{"IN", command.input, Direction::kRead},
                                             {"OUT", command.output, Direction::kWrite},
                                             {"--normal-map", command.normal_map, Direction::kWrite},
                                             {"--color-map", command.color_map, Direction::kWrite},
                                             {"the .mtl beside OUT", mtl, Direction::kWrite}}};
    if (const auto failure = check_files(names)) return report_error(*failure);

    const Result<Bytes> file = read_named(command.input);
    if (!file.ok()) return report_error(input_name, file.error());
    if (image_format && is_gim(file.value()) && holds_raster(file.value()))
        return decode_raster_file(command, file.value(), *image_format);
    if (!format)
        return report_error(input_name,
                            {Stage::kInput, "this is no imported image, and .npz holds only those; decode to .exr"});
    if (detect_format(file.value(), "") == MeshFormat::kGltf) return decode_glb_file(command, file.value(), *format);
    const bool has_details = !command.plain && *format != SurfaceFormat::kExr;
    const Result<Images> images = decode_images(file.value(), command.level, WithPlanes::kYes,
                                                has_details ? WithDetails::kYes : WithDetails::kNo);
    if (!images.ok()) return report_error(input_name, images.error());

    std::vector<OutputFile> files;
    if (!command.normal_map.empty()) {
        const Result<void> added = add_planes(Kind::kNormals, command.normal_map, images.value(), files);
        if (!added.ok()) return report_error(input_name, added.error());
    }
    SurfaceOptions options{command.fused, command.split_sharp, {}};
    if (!command.color_map.empty()) {
        const Result<void> added = add_planes(Kind::kColors, command.color_map, images.value(), files);
        if (!added.ok()) return report_error(input_name, added.error());
    }
    if (!mtl.empty()) {
        options.material_file = std::filesystem::path(mtl).filename().string();
        files.push_back({"the .mtl beside OUT", mtl, material_text(mtl, command.color_map, images.value().size())});
    }
    Result<Bytes> bytes = write_surface(*format, images.value(), options);
    if (!bytes.ok()) return report_error(output_name, bytes.error());
    if (const std::string warning = rounding_warning(*format, images.value()); !warning.empty())
        print_warnings(output_name, {warning});
    files.push_back({"OUT", command.output, std::move(bytes.value())});
    return write_all_files(command, std::move(files));
}

}  // namespace gim
