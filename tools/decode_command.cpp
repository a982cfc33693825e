// gim decode: writes one level of a .gim file as a mesh or an EXR image, and its planes as pictures.
#include <cstdio>
#include <filesystem>
#include <utility>

#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/plane_write.h"
#include "tools/surface_write.h"

namespace gim {
namespace {

using Images = std::vector<DecodedImage>;

struct OutputFile {
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
        files.push_back({name, std::move(bytes.value())});
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

}  // namespace

int run_decode(const DecodeCommand& command) {
    const std::optional<SurfaceFormat> format = surface_format_of(extension_of(command.output));
    if (!format) {
        return report_error(command.output, {Stage::kWrite, "unknown extension; use ply, obj, off, stl, glb or exr"});
    }
    for (const std::string& path : {command.output, command.normal_map, command.color_map}) {
        if (path.empty()) continue;
        const Result<void> writable = check_writable(path);
        if (!writable.ok()) return report_error(path, writable.error());
    }

    const Result<Bytes> file = read_file(command.input);
    if (!file.ok()) return report_error(command.input, file.error());
    const Result<Images> images = decode_images(file.value(), command.level, WithPlanes::kYes);
    if (!images.ok()) return report_error(command.input, images.error());

    // Makes all files before it writes the first one.
    std::vector<OutputFile> files;
    if (!command.normal_map.empty()) {
        const Result<void> added = add_planes(Kind::kNormals, command.normal_map, images.value(), files);
        if (!added.ok()) return report_error(command.input, added.error());
    }
    SurfaceOptions options{command.fused, {}};
    if (!command.color_map.empty()) {
        const Result<void> added = add_planes(Kind::kColors, command.color_map, images.value(), files);
        if (!added.ok()) return report_error(command.input, added.error());
        if (*format == SurfaceFormat::kObj) {
            const std::filesystem::path mtl = std::filesystem::path(command.output).replace_extension(".mtl");
            options.material_file = mtl.filename().string();
            files.push_back({mtl.string(), material_text(mtl.string(), command.color_map, images.value().size())});
        }
    }
    Result<Bytes> bytes = write_surface(*format, images.value(), options);
    if (!bytes.ok()) return report_error(command.output, bytes.error());
    const std::string warning = rounding_warning(*format, images.value());
    if (!warning.empty()) std::fprintf(stderr, "gim: %s: warning: %s\n", command.output.c_str(), warning.c_str());
    files.push_back({command.output, std::move(bytes.value())});
    for (const OutputFile& output : files) {
        const Result<void> written = write_file(output.path, output.bytes);
        if (!written.ok()) return report_error(output.path, written.error());
    }
    return 0;
}

}  // namespace gim
