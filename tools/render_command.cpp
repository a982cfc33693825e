// gim render: draws a mesh as a PNG, alone or beside its geometry image and reconstruction.
#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/input.h"
#include "tools/render.h"

namespace gim {
namespace {

UpAxis up_axis_named(const std::string& name) {
    if (name == "x") return UpAxis::kX;
    if (name == "y") return UpAxis::kY;
    return name == "z" ? UpAxis::kZ : UpAxis::kAuto;
}

Result<Picture> triptych(const TriangleMesh& original, const RenderCommand& command, const View& view) {
    const Result<Bytes> file = read_file(command.gim);
    if (!file.ok()) return file.error();
    const Result<std::vector<DecodedImage>> decoded = decode_images(file.value(), command.level);
    if (!decoded.ok()) return decoded.error();
    const std::vector<DecodedImage>& images = decoded.value();
    const TriangleMesh surface = to_mesh(images);
    const std::string size = std::to_string(images[0].columns) + " x " + std::to_string(images[0].rows);
    const std::string image_caption =
        (images.size() == 1 ? size + " image, " : std::to_string(images.size()) + " images, ") +
        with_thousands(file.value().size()) + " bytes";
    const std::vector<Panel> panels = {
        {render_mesh(original, view), "original, " + with_thousands(original.positions.size()) + " vertices"},
        {render_images(images, view.size), image_caption},
        {render_mesh(surface, view), "decoded, " + with_thousands(surface.positions.size()) + " vertices"}};
    return place_side_by_side(panels);
}

}  // namespace

int run_render(const RenderCommand& command) {
    if (extension_of(command.output) != "png") return report_error(command.output, {Stage::kWrite, "must end in .png"});
    const Result<void> writable = check_writable(command.output);
    if (!writable.ok()) return report_error(command.output, writable.error());
    const Result<TriangleMesh> mesh = read_surface(command.input, command.gim.empty() ? command.level : 0);
    if (!mesh.ok()) return report_error(command.input, mesh.error());

    const View view = {.up = up_axis_named(command.up),
                       .azimuth = command.azimuth,
                       .elevation = command.elevation,
                       .size = command.size,
                       .flat = command.flat,
                       .wire = command.wire};
    const Result<Picture> picture =
        command.gim.empty() ? Result<Picture>(render_mesh(mesh.value(), view)) : triptych(mesh.value(), command, view);
    if (!picture.ok()) return report_error(command.gim, picture.error());
    const Result<Bytes> png = write_png(picture.value());
    if (!png.ok()) return report_error(command.output, png.error());
    const Result<void> written = write_file(command.output, png.value());
    if (!written.ok()) return report_error(command.output, written.error());
    return 0;
}

}  // namespace gim
