// gim encode IN.glb OUT.glb: keeps the scene, and makes a .gim of each mesh.
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>

#include "tools/commands.h"
#include "tools/companions.h"
#include "tools/encode_glb.h"
#include "tools/output_files.h"
#include "tools/progress.h"
#include "tools/report_json.h"

namespace gim {
namespace {

std::string percent_encoded(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || std::string_view("-_.~").find(c) != std::string_view::npos) {
            out += c;
            continue;
        }
        std::array<char, 4> code{};
        std::snprintf(code.data(), code.size(), "%%%02X", byte);
        out += code.data();
    }
    return out;
}

std::string line(std::string label, const std::string& value) {
    label.resize(std::max<size_t>(26, label.size() + 2), ' ');
    return label + value + "\n";
}

std::string summary(const EncodeCommand& command, uint64_t input_bytes, const EncodedGlb& encoded) {
    std::string text = line("file", shown_name(command.output, Direction::kWrite));
    for (const GlbMeshReport& mesh : encoded.meshes) {
        std::string value = "as it was";
        if (mesh.is_carried) {
            std::array<char, 32> psnr{};
            std::snprintf(psnr.data(), psnr.size(), "%.2f dB", mesh.psnr);
            value =
                with_thousands(mesh.plain_bytes) + " -> " + with_thousands(mesh.gim_bytes) + " bytes, " + psnr.data();
        }
        text += line(mesh.name, value);
    }
    text += line("bytes of the input", with_thousands(input_bytes));
    text += line("bytes of the output", with_thousands(encoded.glb.size()));
    if (!encoded.fallback.empty()) text += line("bytes of the fallback", with_thousands(encoded.fallback.size()));
    return text;
}

std::string report(const EncodeCommand& command, uint64_t input_bytes, const EncodedGlb& encoded) {
    nlohmann::ordered_json document = {{"input", command.input},
                                       {"output", command.output},
                                       {"input_bytes", input_bytes},
                                       {"file_bytes", encoded.glb.size()},
                                       {"fallback_bytes", encoded.fallback.size()},
                                       {"meshes", nlohmann::ordered_json::array()}};
    for (const GlbMeshReport& mesh : encoded.meshes) {
        nlohmann::ordered_json one = {{"name", mesh.name}, {"carried", mesh.is_carried}};
        if (mesh.is_carried) {
            one["plain_bytes"] = mesh.plain_bytes;
            one.update(to_json(mesh.report));
        }
        document["meshes"].push_back(std::move(one));
    }
    return json_text(document);
}

// The second buffer lies beside the GLB.
std::string fallback_name(const std::string& output) {
    return std::filesystem::path(output).replace_extension("fallback.bin").string();
}

std::optional<Error> check_options_of_glb(const EncodeCommand& command) {
    const auto refused = [](const std::string& what) { return Error{Stage::kWrite, what}; };
    if (command.options.layout == Layout::kMcgim)
        return refused("the layout mcgim has no labels for materials; for a GLB take gim, tiles or auto");
    if (command.options.normal_side > 0 || command.options.color_side.value_or(0) > 0)
        return refused("a GLB has its textures in pictures of its own; leave out --normals and --colors");
    if (!command.debug_folder.empty()) return refused("--debug-dir shows one mesh only; encode it to a .gim file");
    if (command.fallback && is_written_in_place(command.output))
        return refused("--fallback writes a second file beside OUT, so OUT must be a file");
    return {};
}

Result<EncodedGlb> encode_file(const EncodeCommand& command, const Bytes& file, std::vector<std::string>& warnings) {
    const std::string folder = std::filesystem::path(command.input).parent_path().string();
    ReadContext context{folder, nullptr, MemoryBudget(command.max_memory), true};
    GlbEncodeOptions options;
    options.mesh = command.options;
    options.mesh.color_side = 0;
    if (command.fallback)
        options.fallback_uri =
            percent_encoded(std::filesystem::path(fallback_name(command.output)).filename().string());
    ProgressPrinter printer(command.quiet);
    options.begin_mesh = [&](size_t mesh, size_t count, const std::string& name) {
        printer.begin_part("mesh " + std::to_string(mesh + 1) + " of " + std::to_string(count) + ": " + name);
        return printer.callback();
    };
    Result<EncodedGlb> encoded =
        encode_glb({reinterpret_cast<const char*>(file.data()), file.size()}, context, options);
    warnings = std::move(context.warnings);
    return encoded;
}

int write_all(const EncodeCommand& command, uint64_t input_bytes, EncodedGlb encoded) {
    OutputFiles files;
    const auto stage = [&](const std::string& name, Bytes bytes) {
        const Result<void> staged = files.stage(name, std::move(bytes));
        return staged.ok() ? 0 : report_error(shown_name(name, Direction::kWrite), staged.error());
    };
    const std::string text = summary(command, input_bytes, encoded);
    if (!command.json.empty()) {
        const std::string json = report(command, input_bytes, encoded);
        if (stage(command.json, {json.begin(), json.end()}) != 0) return 1;
    }
    if (!encoded.fallback.empty() && stage(fallback_name(command.output), std::move(encoded.fallback)) != 0) return 1;
    if (stage(command.output, std::move(encoded.glb)) != 0) return 1;
    const bool is_stdout_free =
        !is_standard_output(command.output) && (command.json.empty() || !is_standard_output(command.json));
    if (!command.quiet) std::fputs(text.c_str(), is_stdout_free ? stdout : stderr);
    if (const auto failure = results_failure()) return report_error(*failure);
    if (const auto failure = files.commit()) return report_error(*failure);
    return 0;
}

}  // namespace

int run_encode_glb(const EncodeCommand& command) {
    const std::string fallback = command.fallback ? fallback_name(command.output) : "";
    const std::array<NamedFile, 4> files = {{{"MESH", command.input, Direction::kRead},
                                             {"OUT", command.output, Direction::kWrite},
                                             {"the fallback beside OUT", fallback, Direction::kWrite},
                                             {"--json", command.json, Direction::kWrite}}};
    if (const auto failure = check_files(files)) return report_error(*failure);
    if (const auto error = check_options_of_glb(command))
        return report_error(shown_name(command.output, Direction::kWrite), *error);

    const std::string input_name = shown_name(command.input, Direction::kRead);
    const Result<Bytes> file = read_named(command.input);
    if (!file.ok()) return report_error(input_name, file.error());
    const std::string extension = command.format.empty() ? extension_of(command.input) : command.format;
    if (detect_format(file.value(), extension) != MeshFormat::kGltf) {
        return report_error(input_name, {Stage::kInput,
                                         "a GLB is made of glTF or GLB only; encode other meshes to a .gim file, and "
                                         "decode that: gim decode IN.gim OUT.glb"});
    }
    std::vector<std::string> warnings;
    Result<EncodedGlb> encoded = encode_file(command, file.value(), warnings);
    print_warnings(input_name, warnings);
    if (!encoded.ok()) return report_error(input_name, encoded.error());
    return write_all(command, file.value().size(), std::move(encoded.value()));
}

}  // namespace gim
