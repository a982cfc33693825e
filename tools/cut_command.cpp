// gim cut: the coarser levels of a .gim file become a file.
#include <array>

#include "tools/commands.h"
#include "tools/file.h"
#include "tools/output_files.h"

namespace gim {

int run_cut(const CutCommand& command) {
    const std::array<NamedFile, 2> names = {
        {{"IN", command.input, Direction::kRead}, {"OUT", command.output, Direction::kWrite}}};
    if (const auto failure = check_files(names)) return report_error(*failure);
    const Result<Bytes> file = read_named(command.input);
    if (!file.ok()) return report_error(shown_name(command.input, Direction::kRead), file.error());
    Result<CutFile> kept = cut(file.value(), command.options);
    if (!kept.ok()) return report_error(shown_name(command.input, Direction::kRead), kept.error());
    const size_t size = kept.value().bytes.size();
    OutputFiles outputs;
    const Result<void> staged = outputs.stage(command.output, std::move(kept.value().bytes));
    if (!staged.ok()) return report_error(shown_name(command.output, Direction::kWrite), staged.error());
    if (const auto failure = outputs.commit()) return report_error(*failure);
    if (!is_standard_output(command.output))
        print_line(command.output + ": " + with_thousands(size) + " bytes of " + with_thousands(file.value().size()) +
                   ", from level " + std::to_string(kept.value().level) + " on");
    return 0;
}

}  // namespace gim
