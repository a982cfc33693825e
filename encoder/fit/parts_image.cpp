#include "encoder/fit/parts_image.h"

#include "encoder/code/code_bands.h"

namespace gim {

namespace {

Band band_in(Pyramid<int32_t>& pyramid, const PlaceInPart& place) {
    return bands_of(pyramid, pyramid.steps() - place.depth).of(place.orientation);
}

}  // namespace

CodedImage::Levels ImageParts::decode(std::span<const Pyramid<int32_t>> bands, const Units& units) const {
    CodedImage::Levels levels;
    for (size_t p = 0; p < parts.size(); ++p)
        levels.push_back(decode_bands(bands[p], detail_coding_of(units), parts[p].seams));
    return levels;
}

std::vector<float> ImageParts::samples(const CodedImage::Levels& levels, const Units& units) const {
    std::vector<float> image(3 * gluing.sample_count());
    for (size_t p = 0; p < parts.size(); ++p) {
        const CodedPart& part = parts[p];
        const std::vector<float>& box = levels[p].back();
        part.for_each_defined(gluing.width, [&](size_t in_part, size_t in_image) {
            for (size_t k = 0; k < 3; ++k)
                image[3 * in_image + k] = box[3 * in_part + k] + static_cast<float>(1 << (units.bits - 1));
        });
    }
    close(image);
    return image;
}

PartsImage::PartsImage(const ImageParts& parts, std::vector<DetailResponses>& responses,
                       std::span<Pyramid<int32_t>> bands, const Units& units)
    : parts_(parts), responses_(responses), bands_(bands), units_(units) {
    for (size_t p = 0; p < parts_.parts.size(); ++p) {
        std::vector<Depth>& depths = depths_.emplace_back();
        const uint32_t steps = bands[p].steps();
        for (uint32_t depth = 1; depth <= steps; ++depth) {
            depths.push_back({OwnSharedRim(parts_.parts[p].seams, bands[p].columns_at(steps - depth + 1)), {}});
            const SharedRim rim = depths.back().rim.view();
            rim.for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
                depths.back().copies.push_back({rim.source_of(orientation, row, column), {orientation, row, column}});
            });
        }
    }
    find_owners();
}

void PartsImage::find_owners() {
    owner_.assign(parts_.gluing.sample_count(), 0);
    if (parts_.parts.size() == 1) return;
    for (uint32_t p = 0; p < parts_.parts.size(); ++p) {
        parts_.parts[p].for_each_defined(parts_.gluing.width, [&](size_t, size_t v) { owner_[v] = p; });
    }
}

DetailFrame PartsImage::frame(const Levels& levels, const PlaceInPart& place) const {
    const Pyramid<int32_t>& pyramid = bands_[place.part];
    const uint32_t e = pyramid.steps() - place.depth + 1;
    const FrameField field(levels[place.part][e - 1].data(), low_count(pyramid.columns_at(e)),
                           low_count(pyramid.rows_at(e)), steps_at(place.depth).cell_area);
    return field.at(place.orientation, place.row, place.column);
}

Band PartsImage::band(const PlaceInPart& place) { return band_in(bands_[place.part], place); }

CodedImage::Levels PartsImage::decode_changed(const PlaceInPart& place, uint32_t component, int32_t by) const {
    std::vector<Pyramid<int32_t>> changed(bands_.begin(), bands_.end());
    band_in(changed[place.part], place).row(place.row)[3 * place.column + component] += by;
    return parts_.decode(changed, units_);
}

std::vector<CellInPart> PartsImage::parts_at(uint32_t cell) const {
    const GridGluing& gluing = parts_.gluing;
    uint32_t part = 0;
    for (const uint32_t v : gluing.corners(cell)) {
        if (!gluing.is_defined(v)) continue;
        part = owner_[v];
        break;
    }
    return {{part, cell / (gluing.width - 1) + 0.5 - parts_.parts[part].row,
             cell % (gluing.width - 1) + 0.5 - parts_.parts[part].column}};
}

PlaceInPart PartsImage::source_of(const PlaceInPart& place) const {
    const SharedRim rim = depths_[place.part][place.depth - 1].rim.view();
    if (!rim.is_copy(place.orientation, place.row, place.column)) return place;
    const DetailPlace from = rim.source_of(place.orientation, place.row, place.column);
    return {place.part, place.depth, from.orientation, from.row, from.column};
}

WeightedSamples PartsImage::moved_by(const PlaceInPart& source) const {
    WeightedSamples moved;
    const CodedPart& part = parts_.parts[source.part];
    DetailResponses& responses = responses_[source.part];
    add_block(part, responses.at(source.depth, source.orientation, source.row, source.column), moved);
    for (const auto& [from, copy] : depths_[source.part][source.depth - 1].copies) {
        if (from.orientation == source.orientation && from.row == source.row && from.column == source.column)
            add_block(part, responses.at(source.depth, copy.orientation, copy.row, copy.column), moved);
    }
    return moved;
}

void PartsImage::add_block(const CodedPart& part, const ResponseBlock& block, WeightedSamples& moved) const {
    const float* weight = block.weights;
    for (uint32_t row = block.row; row < block.row + block.rows; ++row) {
        for (uint32_t column = block.column; column < block.column + block.columns; ++column, ++weight) {
            const uint32_t v = part.in_image(parts_.gluing.width, row, column);
            if (v != kNone) moved.push_back({v, *weight});
        }
    }
}

}  // namespace gim
