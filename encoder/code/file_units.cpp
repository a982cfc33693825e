#include "encoder/code/file_units.h"

namespace gim {

Units units_of_box(std::span<const std::span<const Vec3>> positions, uint32_t bits) {
    Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
    for (const auto& part : positions) {
        for (const Vec3& p : part) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    // A surface that is a single point still needs a positive step.
    const double extent = (high - low).maxCoeff();
    const double smallest = std::max(double{kMinStep}, low.cwiseAbs().maxCoeff() * 0x1p-60);
    Units units;
    units.bits = bits;
    units.step = static_cast<float>(std::max(extent / (std::exp2(bits) - 1), smallest));
    for (int k = 0; k < 3; ++k) units.origin[static_cast<size_t>(k)] = static_cast<float>(low[k]);
    return units;
}

void CellArea::add(std::span<const Vec3> positions, std::span<const uint8_t> defined, uint32_t columns, uint32_t rows) {
    for (size_t row = 0; row + 1 < rows; ++row) {
        for (size_t column = 0; column + 1 < columns; ++column) {
            const size_t a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
            if (!defined.empty() && !(defined[a] && defined[b] && defined[c] && defined[d])) continue;
            sum_ += 0.5 * (positions[d] - positions[a]).cross(positions[c] - positions[b]).norm();
            ++cells_;
        }
    }
}

void CellArea::set_details(Units* units) const {
    units->tangential = static_cast<uint8_t>(8 * kTangentialRatio);
    const double area = cells_ > 0 ? sum_ / static_cast<double>(cells_) / (double{units->step} * units->step) : 0;
    uint8_t code = 1;
    while (code < 255 && double{cell_area_of(static_cast<uint8_t>(code + 1))} <= area) ++code;
    units->cell_area = code;
}

float quantizer_in_range(double quantizer) {
    return std::clamp(static_cast<float>(quantizer), kMinQuantizer, kMaxQuantizer);
}

std::vector<Vec3> from_units(std::span<const float> samples, const Units& units) {
    std::vector<Vec3> positions(samples.size() / 3);
    for (size_t i = 0; i < samples.size(); ++i) {
        positions[i / 3][static_cast<int>(i % 3)] =
            double{samples[i]} * double{units.step} + double{units.origin[i % 3]};
    }
    return positions;
}

}  // namespace gim
