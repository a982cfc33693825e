// gim render: draws a mesh as a PNG, alone or beside its geometry image and reconstruction, on request with its defects.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/input.h"
#include "tools/output_files.h"
#include "tools/render.h"

namespace gim {
namespace {

UpAxis up_axis_named(const std::string& name) {
    if (name == "x") return UpAxis::kX;
    if (name == "y") return UpAxis::kY;
    return name == "z" ? UpAxis::kZ : UpAxis::kAuto;
}

// Returns the surface with a caption; with its defects if they are asked for.
Result<Panel> draw_surface(const TriangleMesh& surface, const std::string& caption, const TriangleMesh* reference,
                           const View& view) {
    if (reference == nullptr) return Panel{render_mesh(surface, view), caption};
    const Result<DefectMap> map = map_defects(*reference, surface);
    if (!map.ok()) return map.error();
    const DefectMap& defects = map.value();
    const auto folded = static_cast<uint64_t>(std::count(defects.folded.begin(), defects.folded.end(), 1));
    return Panel{render_defects(surface, defects, view), caption + ", " + with_thousands(folded) + " folded over, " +
                                                             with_thousands(defects.folded_back.size()) +
                                                             " edges folded back"};
}

Result<Picture> triptych(const TriangleMesh& original, const TriangleMesh* reference, const RenderCommand& command,
                         const View& view) {
    const Result<Bytes> file = read_named(command.gim);
    if (!file.ok()) return file.error();
    const Result<std::vector<DecodedImage>> decoded = decode_images(file.value(), command.level);
    if (!decoded.ok()) return decoded.error();
    const std::vector<DecodedImage>& images = decoded.value();
    const TriangleMesh surface = to_mesh(images);
    const std::string size = std::to_string(images[0].columns) + " x " + std::to_string(images[0].rows);
    const std::string image_caption =
        (images.size() == 1 ? size + " image, " : std::to_string(images.size()) + " images, ") +
        with_thousands(file.value().size()) + " bytes";
    const Result<Panel> last =
        draw_surface(surface, "decoded, " + with_thousands(surface.positions.size()) + " vertices", reference, view);
    if (!last.ok()) return last.error();
    const std::vector<Panel> panels = {
        {render_mesh(original, view), "original, " + with_thousands(original.positions.size()) + " vertices"},
        {render_images(images, view.size), image_caption},
        last.value()};
    return place_side_by_side(panels);
}

// A picture of the surface alone has a caption only if it says what the colours mean.
Result<Picture> single(const TriangleMesh& surface, const TriangleMesh* reference, const View& view) {
    if (reference == nullptr) return render_mesh(surface, view);
    const Result<Panel> panel =
        draw_surface(surface, with_thousands(surface.triangles.size()) + " triangles", reference, view);
    if (!panel.ok()) return panel.error();
    return place_side_by_side({&panel.value(), 1});
}

}  // namespace

int run_render(const RenderCommand& command) {
    const std::array<NamedFile, 4> files = {{{"IN", command.input},
                                             {"--gim", command.gim},
                                             {"--defects", command.defects},
                                             {"OUT", command.output, Direction::kWrite}}};
    if (const auto failure = check_files(files)) return report_error(*failure);
    if (extension_of(command.output) != "png" && !is_written_in_place(command.output))
        return report_error(command.output, {Stage::kWrite, "must end in .png"});
    const std::string input_name = shown_name(command.input, Direction::kRead);
    const std::string output_name = shown_name(command.output, Direction::kWrite);
    const ReadOptions how = {Want::kShape, command.max_memory, command.format, true};
    const Result<TriangleMesh> mesh = read_surface_aloud(command.input, command.gim.empty() ? command.level : 0, how);
    if (!mesh.ok()) return report_error(input_name, mesh.error());
    std::optional<TriangleMesh> reference;
    if (!command.defects.empty()) {
        Result<TriangleMesh> read = read_surface_aloud(command.defects, 0, how);
        if (!read.ok()) return report_error(shown_name(command.defects, Direction::kRead), read.error());
        reference = std::move(read.value());
    }
    const View view = {.up = up_axis_named(command.up),
                       .azimuth = command.azimuth,
                       .elevation = command.elevation,
                       .size = command.size,
                       .flat = command.flat,
                       .wire = command.wire};
    const TriangleMesh* const against = reference ? &*reference : nullptr;
    const Result<Picture> picture =
        command.gim.empty() ? single(mesh.value(), against, view) : triptych(mesh.value(), against, command, view);
    if (!picture.ok())
        return report_error(command.gim.empty() ? input_name : shown_name(command.gim, Direction::kRead),
                            picture.error());
    const Result<Bytes> png = write_png(picture.value());
    if (!png.ok()) return report_error(output_name, png.error());
    const Result<void> written = write_file(command.output, png.value());
    if (!written.ok()) return report_error(output_name, written.error());
    return 0;
}

}  // namespace gim
