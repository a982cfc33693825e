#include "encoder/squares/write_squares.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "encoder/code/assemble_file.h"
#include "encoder/code/code_bands.h"
#include "format/bytes.h"
#include "format/seam.h"
#include "format/sideband_code.h"

namespace gim {
namespace {

Error error(std::string message) { return {Stage::kWrite, std::move(message)}; }

std::string image_name(size_t i) { return "image " + std::to_string(i); }

// Empty when all is well.
std::string complaint(std::span<const GeometryImage> images, const CodingParameters& p) {
    if (images.empty()) return "no image to write";
    if (images.size() > kMaxImages) return std::to_string(images.size()) + " images: a file holds at most 65536";
    if (p.bits < kMinBits || p.bits > kMaxBits) return "bits " + std::to_string(p.bits) + ": choose 8 to 20";
    for (size_t i = 0; i < images.size(); ++i) {
        const GeometryImage& image = images[i];
        if (!is_grid_side(image.side) || image.side < 3)
            return image_name(i) + " has side " + std::to_string(image.side) + ": it must be 2^j+1, 3 to 16385";
        if (image.positions.size() != size_t{image.side} * image.side)
            return image_name(i) + " has " + std::to_string(image.positions.size()) + " positions, not side*side";
        for (size_t s = 0; s < image.positions.size(); ++s) {
            if (!image.positions[s].allFinite() || image.positions[s].cwiseAbs().maxCoeff() > double{kMaxOrigin})
                return image_name(i) + ", row " + std::to_string(s / image.side) + ", column " +
                       std::to_string(s % image.side) + ": position is not a finite number of reasonable size";
        }
        SeamTable seams;
        if (image.sideband.paths.size() > kMaxCutPaths)
            return image_name(i) + " has " + std::to_string(image.sideband.paths.size()) +
                   " cut-paths, the format takes " + std::to_string(kMaxCutPaths);
        if (build_seam_table(image.sideband, &seams) != Status::kOk)
            return image_name(i) +
                   ": the sideband is inconsistent (lengths must fill the ring, mates be mutual and equally long)";
        if (!level_is_closed(seams, image.side))
            return image_name(i) +
                   ": glued as its sideband says, its samples are not a manifold mesh; use a larger side";
    }
    return {};
}

}  // namespace

Header units_of(std::span<const GeometryImage> images, uint32_t bits) {
    Header header;
    std::vector<std::span<const Vec3>> positions;
    for (const GeometryImage& image : images) positions.push_back(image.positions);
    set_quantizer(positions, bits, &header);
    CellArea area;
    for (const GeometryImage& image : images) area.add(image.positions, {}, image.side, image.side);
    area.set_details(&header);
    return header;
}

Result<GimWriter> GimWriter::create(std::span<const GeometryImage> images, const CodingParameters& parameters) {
    if (std::string c = complaint(images, parameters); !c.empty()) return error(std::move(c));

    GimWriter writer;
    Header& header = writer.header_;
    uint32_t largest = 0;
    for (const GeometryImage& image : images) {
        const auto exponent = static_cast<uint32_t>(std::countr_zero(image.side - 1));
        writer.side_exponents_.push_back(static_cast<uint8_t>(exponent));
        const Sideband sideband = with_coarsest_node_grid(image.sideband);
        append_sideband(sideband, &writer.seams_);
        writer.seam_tables_.emplace_back();
        if (build_seam_table(sideband, &writer.seam_tables_.back()) != Status::kOk) return error("its seams are wrong");
        largest = std::max(largest, exponent);
    }
    const uint32_t base = is_grid_side(parameters.base_side) && parameters.base_side > 2
                              ? static_cast<uint32_t>(std::countr_zero(parameters.base_side - 1))
                              : 4;
    header.coding = parameters.lossless ? Coding::kLossless : Coding::kLossy;
    header.level_count = largest > base ? largest - base + 1 : 1;
    writer.drop_levels_of_no_use();
    writer.planes_ = parameters.planes;
    writer.text_ = parameters.text;
    if (parameters.level_psnr) writer.level_psnr_.assign(header.level_count, 0);

    const bool shared_units = header.coding == Coding::kLossy && parameters.units;
    const Header units = shared_units ? *parameters.units : units_of(images, parameters.bits);
    header.bits = units.bits;
    header.origin = units.origin;
    header.step = units.step;
    if (header.coding == Coding::kLossy) {
        header.tangential = units.tangential;
        header.cell_area = units.cell_area;
    }

    for (const GeometryImage& image : images) {
        if (parameters.lossless) {
            writer.lossless_.push_back(analyse<Reversible53>(to_units<int32_t>(image.positions, header), image.side));
            subtract_middle(&writer.lossless_.back(), header.bits);
        } else {
            writer.lossy_.push_back(analyse<Irreversible97>(to_units<float>(image.positions, header), image.side,
                                                            writer.shared_seams(writer.lossy_.size())));
            subtract_middle(&writer.lossy_.back(), header.bits);
        }
    }
    return writer;
}

// No image could close them.
void GimWriter::drop_levels_of_no_use() {
    Header header = header_;
    header.side_exponents = side_exponents_;
    const auto is_closed = [&](uint32_t level) {
        for (uint32_t i = 0; i < side_exponents_.size(); ++i) {
            if (level < header.level_count_of(i) &&
                level_is_closed(seam_tables_[i], (1u << (side_exponents_[i] - level)) + 1))
                return true;
        }
        return false;
    };
    while (header.level_count > 1 && !is_closed(header.level_count - 1)) --header.level_count;
    header_.level_count = header.level_count;
}

Header GimWriter::header(double quantizer) const {
    Header header = header_;
    header.side_exponents = side_exponents_;
    header.level_psnr = level_psnr_;
    if (header.coding == Coding::kLossy) header.quantizer = quantizer_in_range(quantizer);
    return header;
}

std::vector<uint8_t> GimWriter::write(double quantizer) const {
    const Header header = this->header(quantizer);
    // One stream per image and level it has; a level's payload is a table of sizes, left out for a single image, and
    // these.
    std::vector<std::vector<uint8_t>> sizes(header.level_count), streams(header.level_count);
    for (uint32_t i = 0; i < header.image_count(); ++i) {
        Pyramid<int32_t> bands = header.coding == Coding::kLossless
                                     ? lossless_[i]
                                     : quantize_bands(lossy_[i], detail_coding_of(header), shared_seams(i)).bands;
        const uint32_t levels = header.level_count_of(i);
        const auto coded = code_bands(bands, levels, coefficient_kind_of(header), shared_seams(i));
        for (uint32_t k = 0; k < levels; ++k) {
            const uint32_t level = levels - 1 - k;
            if (header.image_count() > 1) append_leb128(coded[k].size(), &sizes[level]);
            streams[level].insert(streams[level].end(), coded[k].begin(), coded[k].end());
        }
    }

    std::vector<std::vector<uint8_t>> levels;
    for (uint32_t level = header.level_count; level-- > 0;) {
        levels.push_back(std::move(sizes[level]));
        levels.back().insert(levels.back().end(), streams[level].begin(), streams[level].end());
    }
    return assemble_file(header, seams_, levels, planes_, text_);
}

std::vector<uint8_t> set_level_psnr(std::span<const uint8_t> file, std::span<const double> psnr) {
    std::vector<uint8_t> changed(file.begin(), file.end());
    const ContainerLimits no_limits{UINT64_MAX, UINT32_MAX, UINT32_MAX};
    Header header;
    if (parse_header(file, no_limits, &header) != Status::kOk || header.level_psnr.size() != psnr.size())
        return changed;
    std::vector<uint8_t> coded;
    for (size_t k = psnr.size(); k-- > 0;) {
        coded.push_back(static_cast<uint8_t>(psnr[k] > 0 ? std::min(std::floor(2 * psnr[k]), 255.0) : 0.0));
    }
    header.level_psnr = coded;
    std::vector<Chunk> chunks;
    ChunkWalk walk(header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) chunks.push_back(chunk);
    const std::vector<uint8_t> head = serialize_header(header, chunks);
    std::copy(head.begin(), head.end(), changed.begin());
    return changed;
}

Result<std::vector<uint8_t>> write_gim(std::span<const GeometryImage> images, const CodingParameters& parameters) {
    GIM_TRY(writer, GimWriter::create(images, parameters));
    return writer.write(parameters.quantizer);
}

}  // namespace gim
