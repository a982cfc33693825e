// The layouts that the decoder knows, in one table. Adding a layout adds a folder and a row of the table.
#pragma once

#include "decoder/layout/level_reader.h"
#include "format/container.h"

namespace gim {

const LevelReader& reader_of(FileLayout layout);

}  // namespace gim
