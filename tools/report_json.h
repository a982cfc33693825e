// Figures as JSON. Numbers that are infinite or undefined (PSNR of equal surfaces, genus of a non-manifold) become
// null.
#pragma once

#include <nlohmann/json.hpp>

#include "gim/encoder.h"

namespace gim {

nlohmann::ordered_json to_json(const TopologySummary& topology);
nlohmann::ordered_json to_json(const Defects& defects);
nlohmann::ordered_json to_json(const Comparison& comparison);
nlohmann::ordered_json to_json(const Repairs& repairs);
nlohmann::ordered_json to_json(const EncodeReport& report);

}  // namespace gim
