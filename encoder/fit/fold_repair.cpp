#include "encoder/fit/fold_repair.h"

#include <utility>

namespace gim {

FoldRepair::FoldRepair(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front,
                       std::vector<CodedPart> parts, CloseSeams close)
    : frame_(frame), parts_{gluing, std::move(parts), std::move(close)}, passes_(gluing, reference, frame, front) {
    make_responses();
}

FoldRepair::FoldRepair(const GeometryImage& image, const Mesh& mesh, std::vector<CodedPart> parts, CloseSeams close)
    : frame_(mesh),
      own_reference_(std::make_unique<FitReference>(Mesh{frame_.into(mesh.positions), mesh.triangles})),
      parts_{image.gluing, std::move(parts), std::move(close)},
      passes_(image.gluing, *own_reference_, frame_,
              front_side(frame_.into(image.positions), image.gluing, *own_reference_)) {
    make_responses();
}

void FoldRepair::make_responses() {
    for (const CodedPart& part : parts_.parts) responses_.emplace_back(part.columns, part.rows, part.seams != nullptr);
}

void FoldRepair::repair(std::span<Pyramid<int32_t>> bands, const Units& units, const RepairEffort& effort) {
    PartsImage image(parts_, responses_, bands, units);
    passes_.repair(image, effort);
}

std::vector<Vec3> FoldRepair::samples(const CodedImage::Levels& levels, const Units& units) const {
    return positions_of(parts_.samples(levels, units), units, frame_);
}

}  // namespace gim
