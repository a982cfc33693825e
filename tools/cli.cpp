// The command line. CLI11 parses it into the structs that the commands take.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

constexpr int kWrongUsage = 2;

bool is_option(const std::string& argument) { return argument.size() > 1 && argument.starts_with('-'); }

// Says how to encode several meshes, instead of naming the last of them as the mistake.
void explain_several_inputs() {
    std::fputs(
        "gim: encode takes one mesh and makes one file; it does not join meshes to a scene. For several meshes:\n"
        "  gim batch LIST|DIR OUT_DIR\n",
        stderr);
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> left = app.remaining(true);
    if (app.got_subcommand("encode") && !left.empty() && std::none_of(left.begin(), left.end(), is_option)) {
        explain_several_inputs();
        return kWrongUsage;
    }
    // Help is a result. It goes where failures are noticed.
    std::ostringstream help, complaint;
    const bool is_help = app.exit(error, help, complaint) == 0;
    std::fputs(help.str().c_str(), stdout);
    std::fputs(complaint.str().c_str(), stderr);
    return is_help ? 0 : kWrongUsage;
}

}  // namespace

int run_gim(int argc, const char* const* argv) {
    CLI::App app(
        "gim stores triangle meshes as geometry images. It turns a mesh into a small .gim file, and the file into a\n"
        "crack-free surface, at full resolution or coarser.");
    app.name("gim");
    app.set_version_flag("--version", std::string("gim ") + GIM_VERSION);
    app.require_subcommand(1);
    app.footer(
        "gim COMMAND --help describes a command. The file name - is standard input or output.\n"
        "Exit status: 0 done, 1 the work failed, 2 wrong usage. Results go to stdout, messages and progress to "
        "stderr.\n"
        "A command that fails leaves no file behind and changes none.");
    const std::array<Subcommand, 10> subcommands = {
        add_encode(app),  add_batch(app),  add_decode(app), add_info(app),        add_cut(app),
        add_compare(app), add_render(app), add_emboss(app), add_bench_scene(app), add_view(app)};
    int exit_status = 0;
    try {
        app.parse(argc, argv);
        for (const Subcommand& subcommand : subcommands) {
            if (subcommand.app->parsed()) exit_status = subcommand.run();
        }
    } catch (const CLI::ParseError& error) {  // --help too
        exit_status = report_usage(app, error);
    }
    // A full disk behind a redirected stdout is a failure too.
    if (const auto failure = results_failure()) return report_error(*failure);
    return exit_status;
}

}  // namespace gim
