#pragma once

#include "encoder/code/file_writer.h"

namespace gim::test {

inline CodingParameters lossy(double quantizer) {
    CodingParameters parameters;
    parameters.lossless = false;
    parameters.quantizer = quantizer;
    return parameters;
}

}  // namespace gim::test
