#include "encoder/raster/write_raster.h"

#include <algorithm>
#include <string>

#include "encoder/code/assemble_file.h"
#include "encoder/code/file_units.h"
#include "encoder/code/range_encoder.h"
#include "encoder/raster/raster_surface.h"
#include "format/raster_code.h"

namespace gim {
namespace {

// A lossy file moves all samples of a point to one place.
void join_points(const RasterGluing& gluing, uint32_t channels, std::vector<int32_t>& values) {
    for (size_t i = 0; i < gluing.origin.size(); ++i) {
        const size_t from = gluing.origin[i];
        if (from != i) std::copy_n(&values[from * channels], kRasterGroup, &values[i * channels]);
    }
}

std::vector<float> units_of(const RasterImage& image, const std::vector<int32_t>& values, float unit) {
    std::vector<float> units(image.defined.size() * 3);
    for (size_t i = 0; i < image.defined.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) units[i * 3 + k] = unit * static_cast<float>(values[i * image.channels + k]);
    }
    return units;
}

std::vector<uint8_t> code_samples(const RasterImage& image, const RasterTable& table, uint32_t bits,
                                  const RasterGluing& gluing, std::vector<int32_t>& values) {
    const RasterShape shape = {image.width, image.height, image.channels};
    std::vector<uint8_t> depth = gluing.depth;
    std::vector<uint32_t> point(shape.samples()), link(shape.samples()), border(shape.samples());
    std::vector<uint32_t> errors(size_t{2} * shape.columns * kRasterPredictors),
        magnitudes(size_t{2} * shape.columns * kRasterGroup);
    RangeEncoder encoder;
    RasterCoder<RangeEncoder> coder(&encoder, shape,
                                    {depth.data(), values.data(), point.data(), link.data(), border.data(),
                                     errors.data(), magnitudes.data(), gluing.origin.data()});
    coder.code_mask();
    for (uint32_t first = 0; first < shape.channels; first += kRasterGroup)
        (void)coder.code_group(table.group(first, bits));
    return encoder.finish();
}

// Names of channels, for readers that want them.
std::string text_of(const RasterImage& image) {
    std::string text;
    for (const std::string& name : image.names) text += (text.empty() ? "channels: " : " ") + name;
    return text;
}

}  // namespace

std::vector<uint8_t> write_raster(const RasterImage& image, const RasterScale& scale, const RasterGluing& gluing,
                                  double quantizer) {
    Header header;
    static_cast<Units&>(header) = scale.units;
    header.layout = FileLayout::kRaster;
    header.coding = quantizer > 0 ? Coding::kLossy : Coding::kLossless;
    header.quantizer = quantizer > 0 ? quantizer_in_range(quantizer) : 0;
    header.wide_origin = scale.wide_origin;
    header.level_count = 1;
    header.width = image.width;
    header.height = image.height;
    const bool is_lossy = header.coding == Coding::kLossy;
    std::vector<int32_t> values = quantized(image, scale, is_lossy ? double{header.quantizer} : 1.0);
    if (is_lossy) join_points(gluing, image.channels, values);

    RasterTable table;
    table.vertices = gluing.points;
    table.triangles = static_cast<uint32_t>(
        raster_triangles(gluing, image.width, image.height, units_of(image, values, is_lossy ? header.quantizer : 1.0f))
            .size());
    table.sample_type = static_cast<uint32_t>(image.type);
    table.is_channels_first = image.is_channels_first;
    table.mask =
        static_cast<uint32_t>(image.mask) + (image.mask == RasterImage::Mask::kChannel ? image.mask_channel : 0);
    table.mask_value = image.mask_value;
    table.channels = image.channels;
    const std::vector<uint8_t> seams = serialize_raster_table(table, scale.others);
    Header parsed = header;
    parsed.sample_count = uint64_t{image.width} * image.height;
    (void)parse_raster_table(seams, parsed, kNoLimits, &table);
    const std::vector<uint8_t> level = code_samples(image, table, header.bits, gluing, values);
    return assemble_file(header, seams, {&level, 1}, {}, text_of(image));
}

}  // namespace gim
