// The band coder as the decoder uses it, compiled once (band_decoder.cpp).
#pragma once

#include "decoder/pyramid/range_decoder.h"
#include "format/band_code.h"

namespace gim {

using BandDecoder = BandCoder<RangeDecoder>;
extern template class BandCoder<RangeDecoder>;

}  // namespace gim
