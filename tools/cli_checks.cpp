// Checks of option values that several subcommands share.
#include <cstdio>

#include "tools/cli_parts.h"

namespace gim {

CLI::Validator side_validator(uint32_t least, uint32_t most) {
    const auto check = [least, most](const std::string& text) -> std::string {
        uint32_t side = 0;
        if (!CLI::detail::lexical_cast(text, side) || side < least || side > most || ((side - 1) & (side - 2)) != 0) {
            return "must be a power of two plus one, " + std::to_string(least) + " to " + std::to_string(most) +
                   ", not " + text;
        }
        return {};
    };
    return {check, "2^j+1"};
}

CLI::Validator finite_range(double low, double high, const std::string& name) {
    const auto check = [low, high](const std::string& text) -> std::string {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value) || !(value >= low && value <= high)) {
            char message[120];
            std::snprintf(message, sizeof(message), "must be between %g and %g, not ", low, high);
            return message + text;
        }
        return {};
    };
    return {check, name};
}

void add_mesh_format(CLI::App* sub, std::string& format, const std::string& help) {
    sub->add_option("--format", format, help)
        ->transform(CLI::IsMember({"ply", "obj", "off", "stl", "gltf", "glb", "gim", "npz", "exr"}, CLI::ignore_case)
                        .description(""))
        ->type_name("ply|obj|off|stl|gltf|glb|gim|npz|exr");
}

void add_max_memory(CLI::App* sub, uint64_t& bytes) {
    sub->add_option("--max-memory", bytes,
                    "Most memory that reading a mesh may take, as 500M or 2G. A file that needs more is refused before "
                    "it is taken. Default: half of the machine's memory")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("SIZE")
        ->default_str("");
}

}  // namespace gim
