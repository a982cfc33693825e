#include "gim/encoder.h"

namespace gim {

std::string_view stage_name(Stage stage) {
    switch (stage) {
        case Stage::kInput:
            return "input";
        case Stage::kClean:
            return "clean";
        case Stage::kCut:
            return "cut";
        case Stage::kBoundaryMap:
            return "boundary map";
        case Stage::kParametrize:
            return "parametrize";
        case Stage::kSample:
            return "sample";
        case Stage::kFit:
            return "fit";
        case Stage::kPlanes:
            return "planes";
        case Stage::kCode:
            return "code";
        case Stage::kWrite:
            return "write";
        case Stage::kCompare:
            return "compare";
    }
    return "unknown";
}

}  // namespace gim
