#include "encoder/fit/parts_codec.h"

#include <algorithm>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/extend_chart.h"
#include "format/chart_table.h"

namespace gim {

namespace {

// Samples move little from round to round, so few rounds keep an extension good.
constexpr int kRoundsAgain = 4;

template <class Body>
void for_all_parts(std::span<const CodedPart> parts, const Body& body) {
    parallel_blocks(parts.size(), 1, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) body(p, parts[p]);
    });
}

}  // namespace

PartsCodec::PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, CloseSeams close)
    : FitCodec(setting.gluing),
      parts_(std::move(parts)),
      repair_(setting.gluing, setting.reference, setting.frame, setting.front, parts_, std::move(close)) {}

PartsCodec::PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, OpenSeams seams)
    : FitCodec(setting.gluing),
      parts_(std::move(parts)),
      repair_(setting.gluing, setting.reference, setting.frame, setting.front, parts_, seams.close),
      open_(std::move(seams)) {}

void PartsCodec::close(std::vector<float>& image) const { open_.close ? open_.close(image) : average_glued(image); }

void PartsCodec::close_transposed(std::vector<float>& image) const {
    open_.transposed ? open_.transposed(image) : average_glued(image);
}

// Boxes with open seams change by as much as their closed image must. Changes are equal where samples are glued, so
// closing keeps them.
void PartsCodec::take(const std::vector<float>& image) {
    std::vector<float> change = image;
    const bool is_first = boxes_.empty();
    boxes_.resize(parts_.size());
    const uint32_t width = gluing().width;
    if (!is_first && open_.close) {
        std::vector<float> closed(image.size());
        for_all_parts(parts_, [&](size_t p, const CodedPart& part) {
            part.for_each_defined(width, [&](size_t in_part, size_t in_image) {
                std::copy_n(&boxes_[p][3 * in_part], 3, &closed[3 * in_image]);
            });
        });
        open_.close(closed);
        for (size_t i = 0; i < change.size(); ++i) change[i] -= closed[i];
    }
    for_all_parts(parts_, [&](size_t p, const CodedPart& part) {
        std::vector<float>& box = boxes_[p];
        box.resize(3 * part.sample_count());
        part.for_each_defined(width, [&](size_t in_part, size_t in_image) {
            for (size_t k = 0; k < 3; ++k) {
                const float base = is_first || !open_.close ? 0 : box[3 * in_part + k];
                box[3 * in_part + k] = base + change[3 * in_image + k];
            }
        });
    });
}

const std::vector<std::vector<float>>& PartsCodec::extend(const std::vector<float>& image, float quantizer) {
    const bool is_first = boxes_.empty();
    take(image);
    for_all_parts(parts_, [&](size_t p, const CodedPart& part) {
        if (part.defined.empty()) return;
        const uint32_t steps = halvings(part.columns, part.rows);
        std::vector<float>& box = boxes_[p];
        box =
            is_first
                ? extend_chart<Irreversible97>(std::move(box), part.defined, part.columns, part.rows, steps, quantizer)
                : extend_again(std::move(box), part.defined, part.columns, part.rows, steps, quantizer, kRoundsAgain);
    });
    return boxes_;
}

CodedCoordinates PartsCodec::coordinates(const std::vector<float>& image, const DetailCoding& coding) {
    extend(image, coding.quantizer);
    basis_ = std::make_shared<PartsBasis>(parts_, boxes_, gluing().width, gluing().sample_count(), coding);
    return {basis_, basis_->coordinates()};
}

void PartsCodec::follow(const ImageBasis::Coordinates& change) {
    if (!open_.close) return;
    const std::vector<std::vector<float>> changes = basis_->boxes_of(change);
    for (size_t p = 0; p < parts_.size(); ++p) {
        for (size_t i = 0; i < changes[p].size(); ++i) boxes_[p][i] += changes[p][i];
    }
}

std::vector<Vec3> PartsCodec::decoded(const std::vector<float>& image, const Units& units, bool mends_folds) {
    extend(image, units.quantizer);
    std::vector<Pyramid<int32_t>> bands(parts_.size());
    for_all_parts(parts_, [&](size_t p, const CodedPart& part) {
        Pyramid<float> pyramid =
            analyse<Irreversible97>(boxes_[p], part.columns, part.rows, halvings(part.columns, part.rows), part.seams);
        subtract_middle(&pyramid, units.bits);
        bands[p] = quantize_bands(pyramid, detail_coding_of(units), part.seams).bands;
    });
    if (mends_folds) repair_.repair(bands, units, kRepairBetween);
    const CodedImage::Levels levels = repair_.levels(bands, units);
    if (open_.close) {
        const auto middle = static_cast<float>(1 << (units.bits - 1));
        for_all_parts(parts_, [&](size_t p, const CodedPart&) {
            boxes_[p] = levels[p].back();
            for (float& v : boxes_[p]) v += middle;
        });
    }
    return repair_.samples(levels, units);
}

void PartsCodec::repair(std::span<Pyramid<int32_t>> bands, const Units& units) {
    repair_.repair(bands, units, kLastRepair);
}

}  // namespace gim
