#include "encoder/tiles/code_tiles.h"

#include "encoder/code/range_encoder.h"
#include "format/tile_base.h"
#include "format/tile_code.h"

namespace gim {

std::vector<std::vector<uint8_t>> code_tiles(const QuadComplex& complex, TilePyramid<int32_t>& pyramid,
                                             uint32_t level_count, CoefficientKind kind) {
    const uint32_t steps = pyramid.steps(), columns = (1u << steps) + 1;
    BandModels models(kind);
    OwnBandWork work(columns);
    std::vector<TileFlags> flags(complex.tiles);
    std::vector<std::vector<uint8_t>> streams;
    uint32_t done = 0;
    for (uint32_t level = level_count; level-- > 0;) {
        RangeEncoder coder;
        if (done == 0) (void)BaseCoder<RangeEncoder>(&coder, &models).code(complex, pyramid.base.data());
        TileCoder<RangeEncoder> tile_coder(&coder, &models, work.view());
        for (; done < steps - level; ++done) {
            (void)tile_coder.code_step(complex, TilePlanes(1u << done), pyramid.details[done].data(),
                                       done > 0 ? pyramid.details[done - 1].data() : nullptr, flags.data());
        }
        streams.push_back(coder.finish());
    }
    return streams;
}

}  // namespace gim
