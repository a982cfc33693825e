// The parts of the command line: one function per subcommand, and the checks of option values that they share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace gim {

struct EncodeCommand;

// A subcommand and the work that it does once the command line is parsed. The work returns the exit status.
struct Subcommand {
    CLI::App* app = nullptr;
    std::function<int()> run;
};

Subcommand add_encode(CLI::App& app);
Subcommand add_batch(CLI::App& app);
Subcommand add_decode(CLI::App& app);
Subcommand add_cut(CLI::App& app);
Subcommand add_info(CLI::App& app);
Subcommand add_compare(CLI::App& app);
Subcommand add_emboss(CLI::App& app);
Subcommand add_bench_scene(CLI::App& app);
Subcommand add_render(CLI::App& app);
Subcommand add_view(CLI::App& app);

// Accepts 2^j + 1, from least to most.
CLI::Validator side_validator(uint32_t least, uint32_t most);
CLI::Validator finite_range(double low, double high, const std::string& name);

// Adds the options of gim encode that say how a mesh becomes a file. threads: the default of --threads. Once the
// command line is parsed, the function that is returned gives the command, without names of files. It throws
// CLI::ParseError if two options contradict each other.
std::function<EncodeCommand()> add_encoding(CLI::App* sub, uint32_t threads);

// Adds --format for the format of a mesh that is read.
void add_mesh_format(CLI::App* sub, std::string& format, const std::string& help);

// Adds --max-memory, which bounds what the meshes that a command reads may expand to.
void add_max_memory(CLI::App* sub, uint64_t& bytes);

}  // namespace gim
