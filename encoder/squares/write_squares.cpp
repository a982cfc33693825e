#include "encoder/squares/write_squares.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include "encoder/code/code_bands.h"
#include "encoder/code/file_units.h"
#include "format/bytes.h"
#include "format/seam.h"
#include "format/sideband_code.h"

namespace gim {
namespace {

Error error(std::string message) { return {Stage::kWrite, std::move(message)}; }

std::string image_name(size_t i) { return "image " + std::to_string(i); }

// Whether the format can hold the images.
Result<void> check(std::span<const SquareImage> images, const CodingParameters& p) {
    if (images.empty()) return error("no image to write");
    if (images.size() > kMaxImages) return error(std::to_string(images.size()) + " images: a file holds at most 65536");
    GIM_CHECK(check_bits(p.bits));
    for (size_t i = 0; i < images.size(); ++i) {
        const SquareImage& image = images[i];
        if (!is_grid_side(image.side()) || image.side() < 3)
            return error(image_name(i) + " has side " + std::to_string(image.side()) +
                         ": it must be 2^j+1, 3 to 16385");
        if (image.positions.size() != size_t{image.side()} * image.side())
            return error(image_name(i) + " has " + std::to_string(image.positions.size()) +
                         " positions, not side*side");
        for (size_t s = 0; s < image.positions.size(); ++s) {
            if (!is_codable(image.positions[s]))
                return error(image_name(i) + ", row " + std::to_string(s / image.side()) + ", column " +
                             std::to_string(s % image.side()) + ": position is not a finite number of reasonable size");
        }
        SeamTable seams;
        if (image.sideband.paths.size() > kMaxCutPaths)
            return error(image_name(i) + " has " + std::to_string(image.sideband.paths.size()) +
                         " cut-paths, the format takes " + std::to_string(kMaxCutPaths));
        if (build_seam_table(image.sideband, &seams) != Status::kOk)
            return error(
                image_name(i) +
                ": the sideband is inconsistent (lengths must fill the ring, mates be mutual and equally long)");
        if (!level_is_closed(seams, image.side()))
            return error(image_name(i) +
                         ": glued as its sideband says, its samples are not a manifold mesh; use a larger side");
    }
    return {};
}

// Codes the squares' part of a file.
class SquareCoder final : public LevelCoder {
  public:
    SquareCoder(std::span<const SquareImage> images, const CodingParameters& parameters);

    Header header() const override {
        Header header = header_;
        header.side_exponents = side_exponents_;
        return header;
    }
    std::vector<uint8_t> seam_payload() const override { return seams_; }
    std::vector<std::vector<uint8_t>> code_levels(const Header& header) const override;

  private:
    void add_seams(const SquareImage& image);
    void set_levels(uint32_t base_side);
    // Returns the seams of an image if its mates share their details, otherwise null.
    const SeamTable* shared_seams(size_t image) const {
        return header_.tangential > 0 ? &seam_tables_[image] : nullptr;
    }

    Header header_;
    std::vector<uint8_t> side_exponents_, seams_;
    std::vector<SeamTable> seam_tables_;
    ImageBands bands_;
    RepairBands repair_;
};

SquareCoder::SquareCoder(std::span<const SquareImage> images, const CodingParameters& parameters) {
    for (const SquareImage& image : images) add_seams(image);
    header_.coding = parameters.lossless ? Coding::kLossless : Coding::kLossy;
    set_levels(parameters.base_side);
    const bool has_units = !parameters.lossless && parameters.units;
    static_cast<Units&>(header_) = has_units ? *parameters.units : units_of(images, parameters.bits);
    header_.quantizer = 0;
    if (parameters.lossless) header_.tangential = header_.cell_area = 0;
    if (!parameters.lossless) repair_ = parameters.repair;

    for (const SquareImage& image : images) {
        if (parameters.lossless) {
            bands_.lossless.push_back(analyse<Reversible53>(to_units<int32_t>(image.positions, header_), image.side()));
            subtract_middle(&bands_.lossless.back(), header_.bits);
        } else {
            bands_.lossy.push_back(analyse<Irreversible97>(to_units<float>(image.positions, header_), image.side(),
                                                           shared_seams(bands_.lossy.size())));
            subtract_middle(&bands_.lossy.back(), header_.bits);
        }
    }
}

void SquareCoder::add_seams(const SquareImage& image) {
    side_exponents_.push_back(static_cast<uint8_t>(std::countr_zero(image.side() - 1)));
    append_sideband(with_coarsest_node_grid(image.sideband), &seams_);
    seam_tables_.push_back(file_seams(image));
}

// Sets the levels, from the base side up. Leaves out levels that no image can close.
void SquareCoder::set_levels(uint32_t base_side) {
    const uint32_t largest = *std::max_element(side_exponents_.begin(), side_exponents_.end());
    const uint32_t base =
        is_grid_side(base_side) && base_side > 2 ? static_cast<uint32_t>(std::countr_zero(base_side - 1)) : 4;
    header_.level_count = largest > base ? largest - base + 1 : 1;
    const Header header = this->header();
    const auto is_closed = [&](uint32_t level) {
        for (uint32_t i = 0; i < side_exponents_.size(); ++i) {
            if (level < header.level_count_of(i) &&
                level_is_closed(seam_tables_[i], (1u << (side_exponents_[i] - level)) + 1))
                return true;
        }
        return false;
    };
    while (header_.level_count > 1 && !is_closed(header_.level_count - 1)) --header_.level_count;
}

std::vector<std::vector<uint8_t>> SquareCoder::code_levels(const Header& header) const {
    // Each image has one stream per level. A level's payload is a table of sizes, then its streams. The table is left
    // out for a single image.
    std::vector<std::vector<uint8_t>> sizes(header.level_count), streams(header.level_count);
    for (uint32_t i = 0; i < header.image_count(); ++i) {
        Pyramid<int32_t> bands = bands_.quantized(i, header, shared_seams(i));
        if (repair_) repair_(i, {&bands, 1}, header);
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
    return levels;
}

}  // namespace

SeamTable file_seams(const SquareImage& image) {
    SeamTable seams;
    (void)build_seam_table(with_coarsest_node_grid(image.sideband), &seams);
    return seams;
}

Units units_of(std::span<const SquareImage> images, uint32_t bits) {
    std::vector<std::span<const Vec3>> positions;
    for (const SquareImage& image : images) positions.push_back(image.positions);
    Units units = units_of_box(positions, bits);
    CellArea area;
    for (const SquareImage& image : images) area.add(image.positions, {}, image.side(), image.side());
    area.set_details(&units);
    return units;
}

Result<FileWriter> squares_writer(std::span<const SquareImage> images, const CodingParameters& parameters) {
    GIM_CHECK(check(images, parameters));
    return FileWriter(std::make_unique<SquareCoder>(images, parameters), parameters);
}

Result<std::vector<uint8_t>> write_squares(std::span<const SquareImage> images, const CodingParameters& parameters) {
    GIM_TRY(writer, squares_writer(images, parameters));
    return writer.write(parameters.quantizer);
}

}  // namespace gim
