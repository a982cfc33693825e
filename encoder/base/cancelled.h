// Thrown when a caller's Progress asks to stop; guarded() turns it into an Error.
#pragma once

#include "gim/encoder.h"

namespace gim {

struct Cancelled {
    Stage stage = Stage::kInput;
};

}  // namespace gim
