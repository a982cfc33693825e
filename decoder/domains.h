// The layouts whose images can be refined, in one table.
#pragma once

#include "decoder/layout/level_reader.h"
#include "format/container.h"

namespace gim {

// Returns nullptr if images of that layout have no tiles.
const DomainReader* domain_reader_of(FileLayout layout);

}  // namespace gim
