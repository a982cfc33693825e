// The command line of gim cut. The help texts are the manual.
#include <memory>
#include <string>
#include <vector>

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

void take_drops(const std::vector<std::string>& drops, CutOptions* options) {
    for (const std::string& drop : drops) {
        if (drop == "normals") options->drop_normals = true;
        if (drop == "colors") options->drop_colors = true;
        if (drop == "displacements") options->drop_displacements = true;
        if (drop == "labels") options->drop_labels = true;
        if (drop == "text") options->drop_text = true;
    }
}

}  // namespace

Subcommand add_cut(CLI::App& app) {
    const auto command = std::make_shared<CutCommand>();
    const auto drops = std::make_shared<std::vector<std::string>>();
    CutCommand& c = *command;
    CLI::App* sub = app.add_subcommand("cut", "Keep the coarser levels of a .gim file");
    sub->footer(
        "The file is not encoded again: what is kept has the same bits and decodes to the same surface. Its finest "
        "level\n"
        "becomes level 0. The beginning of a file is enough if it holds what is kept. gim info lists the levels and "
        "how\n"
        "near each of them is.\n\n"
        "  gim cut bunny.gim small.gim --level 2\n"
        "  gim cut bunny.gim small.gim --bytes 2000 --drop normals,text");
    sub->add_option("IN", c.input, ".gim file to read (-: standard input)")->required();
    sub->add_option("OUT", c.output, ".gim file to write (-: standard output)")->required();
    CLI::Option* level = sub->add_option("--level", c.options.level, "Finest level to keep; 0 keeps all")
                             ->check(CLI::Range(0, 13))
                             ->type_name("L");
    CLI::Option* bytes =
        sub->add_option("--bytes", c.options.most_bytes, "Keep the finest level that fits into so many bytes")
            ->check(CLI::Range(1.0, 1e15))
            ->type_name("N")
            ->excludes(level);
    CLI::Option* drop =
        sub->add_option("--drop", *drops, "Leave these out: normals, colors, displacements, labels, text")
            ->delimiter(',')
            ->check(CLI::IsMember({"normals", "colors", "displacements", "labels", "text"}))
            ->type_name("LIST");
    sub->final_callback([command, drops, level, bytes, drop] {
        if (level->count() + bytes->count() + drop->count() == 0)
            throw CLI::RequiredError("One of --level, --bytes and --drop");
        take_drops(*drops, &command->options);
    });
    return {sub, [command] { return run_cut(*command); }};
}

}  // namespace gim
