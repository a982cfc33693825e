// Figures as JSON. Numbers that are infinite or undefined (PSNR of equal surfaces, genus of a non-manifold) become
// null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gim/encoder.h"

namespace gim {

nlohmann::ordered_json to_json(const TopologySummary& topology);
nlohmann::ordered_json to_json(const Defects& defects);
nlohmann::ordered_json to_json(const Comparison& comparison);
nlohmann::ordered_json to_json(const Repairs& repairs);
nlohmann::ordered_json to_json(const EncodeReport& report);

// The name that the command line uses. layout: not kAuto.
const char* name_of(Layout layout);

// The document with a line end. Names of files may hold any bytes: what is not UTF-8 is replaced by U+FFFD.
std::string json_text(const nlohmann::ordered_json& document);

}  // namespace gim
