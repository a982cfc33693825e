// Searches for the quantizer that keep the samples: only the file changes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/file_writer.h"
#include "gim/encoder.h"

namespace gim {

// Returns the PSNR, in dB, of a file's decoded surface. Must give the same value for the same bytes.
using JudgeFile = std::function<Result<double>(std::span<const uint8_t>)>;

// Returns the file for a target of PSNR, bytes or quality, or the lossless one. first: the quantizer to try first. A
// budget of bytes that no file keeps gives no bytes; a PSNR that none has is an Error that names the best one.
Result<std::vector<uint8_t>> code_to_target(const FileWriter& writer, double first, const RateTarget& target,
                                            const JudgeFile& judge);

}  // namespace gim
