// A picture of bytes against PSNR, as SVG.
#pragma once

#include <string>
#include <vector>

#include "tools/batch/batch_row.h"

namespace gim {

// One dot for each done row with a PSNR, its colour by layout, bytes on a logarithmic axis. Empty if there is none.
std::string batch_scatter(const std::vector<BatchRow>& rows);

}  // namespace gim
