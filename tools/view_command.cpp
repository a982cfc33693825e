// gim view: serves the viewer's page and a file for it.
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "gim/decoder.h"
#include "tools/commands.h"
#include "tools/file.h"
#include "tools/page_server.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

bool is_page(const fs::path& folder) {
    std::error_code none;
    return fs::is_regular_file(folder / "index.html", none) && fs::is_regular_file(folder / "viewer.js", none);
}

// Returns the folder of the page: where the program is installed, or in the build tree. Empty: there is none.
fs::path find_page() {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const char* way : {"../share/gim/viewer", "../../viewer"}) {
        const fs::path folder = fs::weakly_canonical(program / way, none);
        if (!folder.empty() && is_page(folder)) return folder;
    }
    return {};
}

// Says what is wrong with a .gim file before a browser does.
Result<void> check_gim(const std::string& path) {
    const Result<Bytes> bytes = read_file(path);
    if (!bytes.ok()) return bytes.error();
    gim_info info;
    const gim_status status = gim_read_info(bytes.value().data(), bytes.value().size(), nullptr, &info);
    if (status != GIM_OK) return Error{Stage::kInput, gim_status_text(status)};
    return {};
}

}  // namespace

int run_view(const ViewCommand& command) {
    const fs::path page = command.page.empty() ? find_page() : fs::path(command.page);
    if (page.empty() || !is_page(page)) {
        return report_error(
            page.empty() ? "the viewer" : page.string(),
            {Stage::kInput,
             "its page is not there; build it with: bash tools/viewer/build.sh (needs node and npm), or "
             "name its folder with --page"});
    }
    PageServer server(page.string());
    std::string query;
    if (!command.input.empty()) {
        if (const Result<void> sound = check_gim(command.input); !sound.ok())
            return report_error(command.input, sound.error());
        query = "?url=" + server.add_file(command.input);
    }
    if (!command.original.empty()) {
        if (const Result<Bytes> bytes = read_file(command.original); !bytes.ok())
            return report_error(command.original, bytes.error());
        query += (query.empty() ? "?original=" : "&original=") + server.add_file(command.original);
    }
    const std::string address = server.bind(command.port);
    if (address.empty())
        return report_error("port " + std::to_string(command.port), {Stage::kWrite, "is taken; choose another one"});
    print_line(address + "/" + query);
    if (const auto failure = results_failure()) return report_error(*failure);
    std::fputs("Open this address in a browser. Ctrl-C ends the server.\n", stderr);
    return server.run() ? 0 : report_error(address, {Stage::kWrite, "the server failed"});
}

}  // namespace gim
