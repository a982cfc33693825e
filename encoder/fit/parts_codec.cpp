#include "encoder/fit/parts_codec.h"

#include <algorithm>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/extend_chart.h"
#include "encoder/fit/parts_basis.h"
#include "format/chart_table.h"

namespace gim {

namespace {

// Samples move little from round to round, so few rounds keep an extension good.
constexpr int kRoundsAgain = 4;

}  // namespace

PartsCodec::PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, CloseSeams close)
    : gluing_(setting.gluing),
      parts_(std::move(parts)),
      repair_(setting.gluing, setting.reference, setting.frame, setting.front, parts_, std::move(close)) {}

const std::vector<std::vector<float>>& PartsCodec::extend(const std::vector<float>& image, float quantizer) {
    const bool is_first = boxes_.empty();
    boxes_.resize(parts_.size());
    parallel_blocks(parts_.size(), 1, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            const CodedPart& part = parts_[p];
            std::vector<float>& box = boxes_[p];
            box.resize(3 * part.sample_count());
            part.for_each_defined(gluing_.width, [&](size_t in_part, size_t in_image) {
                std::copy_n(&image[3 * in_image], 3, &box[3 * in_part]);
            });
            if (part.defined.empty()) continue;
            const uint32_t steps = halvings(part.columns, part.rows);
            box = is_first ? extend_chart<Irreversible97>(std::move(box), part.defined, part.columns, part.rows, steps,
                                                          quantizer)
                           : extend_again(std::move(box), part.defined, part.columns, part.rows, steps, quantizer,
                                          kRoundsAgain);
        }
    });
    return boxes_;
}

std::shared_ptr<const ImageBasis> PartsCodec::basis(const std::vector<float>& image, const DetailCoding& coding) {
    extend(image, coding.quantizer);
    basis_ = std::make_shared<PartsBasis>(parts_, boxes_, gluing_.width, gluing_.sample_count(), coding);
    return basis_;
}

void PartsCodec::follow(const ImageBasis::Coordinates& change) {
    const std::vector<std::vector<float>> changes = basis_->boxes_of(change);
    for (size_t p = 0; p < parts_.size(); ++p) {
        if (parts_[p].defined.empty()) continue;
        for (size_t i = 0; i < changes[p].size(); ++i) {
            if (!parts_[p].defined[i / 3]) boxes_[p][i] += changes[p][i];
        }
    }
}

std::vector<Vec3> PartsCodec::decoded(const std::vector<float>& image, const Units& units, bool mends_folds) {
    extend(image, units.quantizer);
    std::vector<Pyramid<int32_t>> bands(parts_.size());
    parallel_blocks(parts_.size(), 1, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p) {
            const CodedPart& part = parts_[p];
            Pyramid<float> pyramid = analyse<Irreversible97>(boxes_[p], part.columns, part.rows,
                                                             halvings(part.columns, part.rows), part.seams);
            subtract_middle(&pyramid, units.bits);
            bands[p] = quantize_bands(pyramid, detail_coding_of(units), part.seams).bands;
        }
    });
    if (mends_folds) repair_.repair(bands, units, kRepairBetween);
    return repair_.decode(bands, units);
}

void PartsCodec::repair(std::span<Pyramid<int32_t>> bands, const Units& units) {
    repair_.repair(bands, units, kLastRepair);
}

}  // namespace gim
