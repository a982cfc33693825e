#include "encoder/squares/square_codec.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "encoder/fit/parts_codec.h"
#include "format/fuse.h"
#include "format/ring.h"

namespace gim {

namespace {

// What decoders know of the seams of a square.
struct SquareSeams {
    uint32_t side;
    SeamTable table;
    std::vector<uint32_t> classes;  // of the ring

    SquareSeams(uint32_t of_side, const SeamTable& seams) : side(of_side), table(seams), classes(ring_length(side)) {
        ring_classes(table, side, classes);
    }
    void close(std::vector<float>& image) const {
        const size_t ring = classes.size();
        std::vector<float> sums(3 * ring), outer(3 * ring), inner(3 * ring);
        std::vector<uint32_t> first(ring), members(ring);
        fuse(side, classes.data(), 1 + *std::max_element(classes.begin(), classes.end()), image.data(),
             {{sums.data(), first.data(), members.data()}, outer.data(), inner.data()});
    }
};

}  // namespace

MakeFitCodec square_codec(uint32_t side, const SeamTable& seams) {
    const auto known = std::make_shared<const SquareSeams>(side, seams);
    return [known](const FitSetting& setting) -> std::unique_ptr<FitCodec> {
        std::vector<CodedPart> parts{{known->side, known->side, 0, 0, &known->table, {}}};
        const CloseSeams close = [known](std::vector<float>& image) { known->close(image); };
        return std::make_unique<PartsCodec>(setting, std::move(parts), close);
    };
}

}  // namespace gim
