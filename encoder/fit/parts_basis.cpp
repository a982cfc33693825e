#include "encoder/fit/parts_basis.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "format/chart_table.h"

namespace gim {

namespace {

// Calls body(band) for all bands in the order of their coordinates.
template <class Pyramid, class Body>
void for_each_band(Pyramid& pyramid, const Body& body) {
    for (auto& level : pyramid.levels) {
        for (auto* band : {&level.horizontal, &level.vertical, &level.diagonal}) body(*band);
    }
}

Pyramid<float> empty_pyramid(const CodedPart& part) {
    return zero_pyramid(part.columns, part.rows, halvings(part.columns, part.rows));
}

}  // namespace

PartsBasis::PartsBasis(std::span<const CodedPart> parts, std::vector<std::vector<float>> boxes, uint32_t width,
                       size_t samples, const DetailCoding& coding)
    : parts_(parts), boxes_(std::move(boxes)), width_(width), samples_(samples) {
    for (const CodedPart& part : parts_) {
        const uint32_t steps = halvings(part.columns, part.rows);
        places_.push_back({base_size_ / 3, 0});
        const size_t triples = size_t{halved(part.columns, steps)} * halved(part.rows, steps);
        add_base(triples, low_band_step(coding.quantizer, steps), steps > 0 ? kBandNorms[steps - 1].low : 1);
    }
    for (size_t p = 0; p < parts_.size(); ++p) {
        places_[p].details = frames_.size();
        add_details(parts_[p], boxes_[p], coding);
    }
    is_copy_.resize(frames_.size());
    for (const auto& [copy, source] : copies_) {
        is_copy_[copy] = true;
        norms_[source] *= std::sqrt(2.0f);
    }
}

void PartsBasis::add_details(const CodedPart& part, std::vector<float> box, const DetailCoding& coding) {
    const Pyramid<float> shape = empty_pyramid(part);
    const uint32_t steps = shape.steps();
    std::vector<std::vector<float>> images(steps + 1);  // by exponent
    images[steps] = std::move(box);
    for (uint32_t e = steps; e > 0; --e) {
        images[e - 1] =
            gim::analyse<Irreversible97>(images[e], shape.columns_at(e), shape.rows_at(e), 1, part.seams).base;
    }
    for (uint32_t e = 1; e <= steps; ++e) {
        const uint32_t columns = shape.columns_at(e), rows = shape.rows_at(e), depth = steps - e + 1;
        const DetailSteps detail_steps = coding.steps_at(depth);
        const FrameField field(images[e - 1].data(), low_count(columns), low_count(rows), detail_steps.cell_area);
        const auto first = static_cast<uint32_t>(frames_.size());
        const auto add_band = [&](Orientation orientation, uint32_t band_rows, uint32_t band_columns) {
            const float norm =
                orientation == Orientation::kDiagonal ? kBandNorms[depth - 1].diagonal : kBandNorms[depth - 1].edge;
            for (uint32_t row = 0; row < band_rows; ++row) {
                for (uint32_t column = 0; column < band_columns; ++column)
                    add_detail(field.at(orientation, row, column), detail_steps, orientation, norm);
            }
        };
        add_band(Orientation::kHorizontal, low_count(rows), high_count(columns));
        add_band(Orientation::kVertical, high_count(rows), low_count(columns));
        add_band(Orientation::kDiagonal, high_count(rows), high_count(columns));

        const OwnSharedRim rim(part.seams, columns);
        const auto triple = [&](Orientation orientation, uint32_t row, uint32_t column) {
            const bool is_horizontal = orientation == Orientation::kHorizontal;
            return first + column +
                   (is_horizontal ? row * high_count(columns)
                                  : low_count(rows) * high_count(columns) + row * low_count(columns));
        };
        rim.view().for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
            const DetailPlace from = rim.view().source_of(orientation, row, column);
            copies_.push_back({triple(orientation, row, column), triple(from.orientation, from.row, from.column)});
        });
    }
}

template <class Body>
void PartsBasis::for_each_part(const Body& body) const {
    parallel_blocks(parts_.size(), 1, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) body(p);
    });
}

Pyramid<float> PartsBasis::pyramid_of(size_t part, const Coordinates& coordinates) const {
    Pyramid<float> pyramid = empty_pyramid(parts_[part]);
    std::copy_n(&coordinates[3 * places_[part].base], pyramid.base.size(), pyramid.base.begin());
    auto at = coordinates.begin() + static_cast<ptrdiff_t>(3 * places_[part].details);
    for_each_band(pyramid, [&](std::vector<float>& band) {
        std::copy_n(at, band.size(), band.begin());
        at += static_cast<ptrdiff_t>(band.size());
    });
    return pyramid;
}

void PartsBasis::store(size_t part, const Pyramid<float>& pyramid, Coordinates& coordinates) const {
    std::copy(pyramid.base.begin(), pyramid.base.end(),
              coordinates.begin() + static_cast<ptrdiff_t>(3 * places_[part].base));
    auto at = coordinates.begin() + static_cast<ptrdiff_t>(3 * places_[part].details);
    for_each_band(pyramid, [&](const std::vector<float>& band) { at = std::copy(band.begin(), band.end(), at); });
}

void PartsBasis::gather_copies(Coordinates& coordinates, float weight) const {
    for (const auto& [copy, source] : copies_) {
        for (size_t k = 0; k < 3; ++k) {
            float &to = coordinates[3 * size_t{source} + k], &from = coordinates[3 * size_t{copy} + k];
            to = weight * (to + from);
            from = 0;
        }
    }
}

PartsBasis::Coordinates PartsBasis::coordinates_of(std::vector<std::vector<float>> boxes) const {
    Coordinates coordinates(size());
    for_each_part([&](size_t p) {
        const CodedPart& part = parts_[p];
        const uint32_t steps = halvings(part.columns, part.rows);
        store(p, gim::analyse<Irreversible97>(std::move(boxes[p]), part.columns, part.rows, steps, part.seams),
              coordinates);
    });
    gather_copies(coordinates, 0.5f);
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

PartsBasis::Coordinates PartsBasis::coordinates() const { return coordinates_of(boxes_); }

PartsBasis::Coordinates PartsBasis::analyse(const std::vector<float>& image) const {
    std::vector<std::vector<float>> boxes = boxes_;
    for_each_part([&](size_t p) {
        parts_[p].for_each_defined(width_, [&](size_t in_part, size_t in_image) {
            std::copy_n(&image[3 * in_image], 3, &boxes[p][3 * in_part]);
        });
    });
    return coordinates_of(std::move(boxes));
}

std::vector<std::vector<float>> PartsBasis::boxes_of(const Coordinates& coordinates) const {
    Coordinates turned = coordinates;
    turn(turned, Way::kOutOfFrames);
    for (const auto& [copy, source] : copies_) std::copy_n(&turned[3 * size_t{source}], 3, &turned[3 * size_t{copy}]);
    std::vector<std::vector<float>> boxes(parts_.size());
    for_each_part([&](size_t p) { boxes[p] = restore<Irreversible97>(pyramid_of(p, turned), parts_[p].seams); });
    return boxes;
}

std::vector<float> PartsBasis::synthesize(const Coordinates& coordinates) const {
    const std::vector<std::vector<float>> boxes = boxes_of(coordinates);
    std::vector<float> image(3 * samples_);
    for_each_part([&](size_t p) {
        parts_[p].for_each_defined(width_, [&](size_t in_part, size_t in_image) {
            std::copy_n(&boxes[p][3 * in_part], 3, &image[3 * in_image]);
        });
    });
    return image;
}

PartsBasis::Coordinates PartsBasis::transposed(std::vector<float> image) const {
    Coordinates coordinates(size());
    for_each_part([&](size_t p) {
        const CodedPart& part = parts_[p];
        std::vector<float> box(3 * part.sample_count());
        part.for_each_defined(
            width_, [&](size_t in_part, size_t in_image) { std::copy_n(&image[3 * in_image], 3, &box[3 * in_part]); });
        store(
            p,
            restore_transposed(std::move(box), part.columns, part.rows, halvings(part.columns, part.rows), part.seams),
            coordinates);
    });
    gather_copies(coordinates, 1);
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

}  // namespace gim
