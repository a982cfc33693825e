#include "tools/batch/html_text.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace gim {
namespace {

constexpr const char* kUnknown = "\xEF\xBF\xBD";

// The JSON library tells what is UTF-8.
std::string valid_utf8(std::string_view text) {
    using nlohmann::json;
    return json::parse(json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

}  // namespace

std::string html_text(std::string_view text) {
    std::string html;
    for (const char letter : valid_utf8(text)) {
        const auto code = static_cast<unsigned char>(letter);
        if (letter == '<')
            html += "&lt;";
        else if (letter == '>')
            html += "&gt;";
        else if (letter == '&')
            html += "&amp;";
        else if (letter == '"')
            html += "&quot;";
        else if ((code < 0x20 && letter != '\n' && letter != '\t') || code == 0x7F)
            html += kUnknown;
        else
            html += letter;
    }
    return html;
}

std::string decimal(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

}  // namespace gim
