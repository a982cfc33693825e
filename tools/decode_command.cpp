// gim decode: one level of a .gim file as a mesh or as an EXR image.
#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/surface_write.h"

namespace gim {

int run_decode(const DecodeCommand& command) {
    const std::optional<SurfaceFormat> format = surface_format_of(extension_of(command.output));
    if (!format) {
        return report_error(command.output, {Stage::kWrite, "unknown extension; use ply, obj, off, stl, glb or exr"});
    }
    const Result<bool> writable = check_writable(command.output);
    if (!writable.ok()) return report_error(command.output, writable.error());

    const Result<Bytes> file = read_file(command.input);
    if (!file.ok()) return report_error(command.input, file.error());
    const Result<std::vector<DecodedImage>> images = decode_images(file.value(), command.level);
    if (!images.ok()) return report_error(command.input, images.error());
    const Result<Bytes> bytes = write_surface(*format, images.value(), {command.fused});
    if (!bytes.ok()) return report_error(command.output, bytes.error());
    const Result<bool> written = write_file(command.output, bytes.value());
    if (!written.ok()) return report_error(command.output, written.error());
    return 0;
}

}  // namespace gim
