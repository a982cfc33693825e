// How long a fit to the codec goes on (fit_coded.h).
#pragma once

namespace gim {

struct FitRounds {
    int cycles = 4;          // of a full fit, each of 4 free rounds and a held one
    int free = 6, held = 3;  // rounds after the cycles
    int steps = 40;          // of conjugate gradients in a round, at most
};

}  // namespace gim
