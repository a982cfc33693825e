// The URIs of a glTF file: bytes inside the text (data:) or the name of a file beside it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tools/file.h"

namespace gim::gltf {

// A short form for messages, in quotation marks.
std::string shown_uri(std::string_view uri);

// Replaces %20 and the like. Nothing if a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text);

// Reads a data: URI or a file of at most `most` bytes. A name is relative to `folder` and may lead out of it with "..",
// as other programs read it. Refuses absolute names and web addresses, since a file that somebody sent must not choose
// freely what is read here. Throws a Failure with the reason, without the name of the URI.
Bytes read_uri(std::string_view uri, const std::string& folder, uint64_t most);

}  // namespace gim::gltf
