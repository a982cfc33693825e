// gim emboss: a picture becomes displacements of the surface of a .gim file.
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/commands.h"
#include "tools/file.h"
#include "tools/output_files.h"
#include "tools/stb.h"

namespace gim {
namespace {

HeightPicture heights_of(const DecodedPicture& picture, bool invert) {
    HeightPicture heights{picture.width, picture.height, {}};
    for (size_t i = 0; i < picture.rgb.size(); i += 3) {
        const double luma = (0.2126 * picture.rgb[i] + 0.7152 * picture.rgb[i + 1] + 0.0722 * picture.rgb[i + 2]) / 255;
        heights.heights.push_back(static_cast<float>(std::clamp(invert ? 1 - luma : luma, 0.0, 1.0)));
    }
    return heights;
}

void print_summary(const EmbossCommand& command, const Embossed& embossed) {
    // If the file goes to standard output, the summary does not.
    if (is_standard_output(command.output)) return;
    if (command.json) {
        print_line(nlohmann::json{{"bytes", embossed.bytes.size()},
                                  {"displacement_bytes", embossed.plane_bytes},
                                  {"texels_per_sample", 1u << embossed.texel_exponent},
                                  {"displaced_texels", embossed.displaced_texels},
                                  {"texel_spacing", embossed.spacing}}
                       .dump(2));
        return;
    }
    char spacing[32];
    std::snprintf(spacing, sizeof spacing, "%.3g", embossed.spacing);
    print_line(command.output + ": " + with_thousands(embossed.bytes.size()) + " bytes, " +
               with_thousands(embossed.plane_bytes) + " of them displacements; " +
               with_thousands(embossed.displaced_texels) + " texels displaced, " + spacing + " apart");
}

}  // namespace

int run_emboss(const EmbossCommand& command) {
    const std::array<NamedFile, 3> names = {{{"IN", command.input, Direction::kRead},
                                             {"--image", command.picture, Direction::kRead},
                                             {"OUT", command.output, Direction::kWrite}}};
    if (const auto failure = check_files(names)) return report_error(*failure);
    const std::string picture_name = shown_name(command.picture, Direction::kRead);
    const Result<Bytes> file = read_named(command.input), picture_file = read_named(command.picture);
    if (!file.ok()) return report_error(shown_name(command.input, Direction::kRead), file.error());
    if (!picture_file.ok()) return report_error(picture_name, picture_file.error());
    const DecodedPicture picture = decode_picture(picture_file.value());
    if (picture.rgb.empty())
        return report_error(picture_name, {Stage::kInput, "not a picture that gim reads; use PNG, JPEG, TGA or BMP"});

    Result<Embossed> embossed = emboss(file.value(), heights_of(picture, command.invert), command.options);
    if (!embossed.ok()) return report_error(shown_name(command.input, Direction::kRead), embossed.error());
    OutputFiles outputs;
    const Result<void> staged = outputs.stage(command.output, embossed.value().bytes);
    if (!staged.ok()) return report_error(shown_name(command.output, Direction::kWrite), staged.error());
    if (const auto failure = outputs.commit()) return report_error(*failure);
    print_summary(command, embossed.value());
    return 0;
}

}  // namespace gim
