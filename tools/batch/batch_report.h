// The page that shows a batch: one HTML file that needs no other.
#pragma once

#include <string>
#include <vector>

#include "tools/batch/batch_row.h"

namespace gim {

struct BatchPage {
    std::vector<std::string> options;  // with which the outputs were made; "": none
    std::vector<BatchRow> rows;        // one for each input, in order
    std::vector<std::string> notes;    // what the page does not show, a sentence each
};

// Figures, a scatter of bytes and PSNR, failures with their reasons, and a table that sorts by any column. Works
// without network and, but for sorting, without scripts. Follows the reader's choice of light and dark.
std::string batch_html(const BatchPage& page);

}  // namespace gim
