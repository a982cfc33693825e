#include "encoder/code/file_writer.h"

#include <algorithm>
#include <utility>

#include "encoder/code/code_bands.h"
#include "encoder/code/file_units.h"

namespace gim {

FileWriter::FileWriter(std::unique_ptr<LevelCoder> coder, const CodingParameters& parameters)
    : coder_(std::move(coder)),
      has_wide_origin_(parameters.wide_origin),
      planes_(parameters.planes),
      text_(parameters.text) {
    seams_ = coder_->seam_payload();
    if (!parameters.bounds) return;
    const Header header = coder_->header();
    level_errors_.assign(kErrorsOfLevel * header.level_count, 0);
    boxes_.assign(kBoxSize * header.image_count(), 0);
}

Header FileWriter::header(double quantizer) const {
    Header header = coder_->header();
    header.level_errors = level_errors_;
    header.boxes = boxes_;
    if (header.coding == Coding::kLossy) header.quantizer = quantizer_in_range(quantizer);
    return header;
}

std::vector<uint8_t> FileWriter::write(double quantizer) const {
    const Header header = this->header(quantizer);
    Header in_file = header;
    if (has_wide_origin_) std::copy(header.origin.begin(), header.origin.end(), in_file.wide_origin.emplace().begin());
    return assemble_file(in_file, seams_, coder_->code_levels(header), planes_, text_);
}

Pyramid<int32_t> ImageBands::quantized(size_t image, const Header& header, const SeamTable* seams) const {
    if (header.coding == Coding::kLossless) return lossless[image];
    return quantize_bands(lossy[image], detail_coding_of(header), seams).bands;
}

Result<void> check_bits(uint32_t bits) {
    if (bits >= kMinBits && bits <= kMaxBits) return {};
    return Error{Stage::kWrite, "bits " + std::to_string(bits) + ": choose 8 to 20"};
}

bool is_codable(const Vec3& position) {
    return position.allFinite() && position.cwiseAbs().maxCoeff() <= double{kMaxOrigin};
}

}  // namespace gim
