#include "decoder/pyramid/band_decoder.h"

namespace gim {

template class BandCoder<RangeDecoder>;

}  // namespace gim
