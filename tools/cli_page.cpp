// The command line of gim view. The help texts are the manual.
#include <memory>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {

Subcommand add_view(CLI::App& app) {
    const auto command = std::make_shared<ViewCommand>();
    ViewCommand& c = *command;
    CLI::App* sub = app.add_subcommand("view", "Show a .gim file in a browser");
    sub->footer(
        "Serves a page and the files on this machine only, at an address that it prints, until it is ended. The page\n"
        "has an orbit camera, levels, the geometry image beside the surface, and distances to the original.\n\n"
        "  gim view bunny.gim\n"
        "  gim view bunny.gim --original bunny.ply --port 8000");
    sub->add_option("FILE", c.input, ".gim file to show. Without one the page waits for a file to be dropped");
    sub->add_option("--original", c.original, "Mesh to measure distances to: .obj, .ply or .glb")->type_name("MESH");
    sub->add_option("--port", c.port, "Port of the address; 0: any that is free")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    sub->add_option("--page", c.page,
                    "Folder of the page. Default: share/gim/viewer beside the program's folder, or build/viewer where "
                    "tools/viewer/build.sh puts it")
        ->type_name("FOLDER");
    return {sub, [command] { return run_view(*command); }};
}

}  // namespace gim
