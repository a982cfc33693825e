// The command line of gim batch. The help texts are the manual.
#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <thread>
#ifdef __linux__
#include <sched.h>
#endif

#include "tools/cli_parts.h"
#include "tools/commands.h"

namespace gim {
namespace {

constexpr uint32_t kMostShards = 100000;

// Cores that this process may use: a queue may give it fewer than the machine has.
uint32_t usable_cores() {
#ifdef __linux__
    cpu_set_t set;
    if (::sched_getaffinity(0, sizeof(set), &set) == 0) return static_cast<uint32_t>(CPU_COUNT(&set));
#endif
    return std::max(1U, std::thread::hardware_concurrency());
}

// Reads "3/16".
bool parse_shard(std::string_view text, uint32_t& shard, uint32_t& shards) {
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, shard);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != '/') return false;
    const auto second = std::from_chars(first.ptr + 1, end, shards);
    return second.ec == std::errc() && second.ptr == end && shard >= 1 && shard <= shards && shards <= kMostShards;
}

CLI::Validator shard_validator() {
    const auto check = [](const std::string& text) -> std::string {
        uint32_t shard = 0, shards = 0;
        if (parse_shard(text, shard, shards)) return {};
        return "must be I/N with I from 1 to N, as 3/16, not " + text;
    };
    return {check, "I/N"};
}

struct BatchArguments {
    BatchCommand command;
    std::function<EncodeCommand()> encoding;
    std::vector<const CLI::Option*> recipe;           // options that change the bytes
    std::map<const CLI::Option*, std::string> texts;  // as given: CLI11 turns words into numbers
    std::string shard;
    const CLI::Option *jobs = nullptr, *threads = nullptr, *memory = nullptr;
};

// The options that change the bytes, as they were given, in the order of the help.
std::string recipe_of(const BatchArguments& a) {
    std::string text;
    for (const CLI::Option* option : a.recipe) {
        if (option->count() == 0) continue;
        text += (text.empty() ? "" : " ") + option->get_name();
        if (const auto given = a.texts.find(option); given != a.texts.end()) text += " " + given->second;
    }
    return text;
}

// Shares cores and memory among the encodes that run at a time.
void share_machine(BatchArguments& a) {
    const uint32_t cores = usable_cores();
    uint32_t& threads = a.command.encode.options.threads;
    if (a.threads->count() > 0 && threads == 0) threads = cores;
    if (a.jobs->count() == 0)
        a.command.jobs = std::max(1U, cores / threads);
    else if (a.threads->count() == 0)
        threads = std::max(1U, cores / a.command.jobs);
    if (a.memory->count() == 0) a.command.encode.max_memory /= a.command.jobs;
}

void add_batch_options(CLI::App* sub, BatchArguments& a) {
    BatchCommand& c = a.command;
    sub->add_option("LIST|DIR", c.inputs,
                    "List of meshes, one path a line, # begins a comment (-: standard input), or a folder, with all "
                    "folders below it")
        ->required();
    sub->add_option("OUT_DIR", c.folder, "Folder for the .gim files, the manifest and report.html")->required();
    a.jobs =
        sub->add_option("--jobs", c.jobs, "Encodes at a time, each in a process of its own. Default: cores / --threads")
            ->check(CLI::Range(1, 1024));
    sub->add_option("--shard", a.shard, "Do part I of N parts, for a queue that starts all N")
        ->check(shard_validator())
        ->type_name("I/N");
    sub->add_option("--log", c.log, "Append the JSON lines to this file. Default: standard output");
    sub->add_option("--thumbnails", c.thumbnail, "Pixels per side of the report's pictures; 0: none")
        ->check(CLI::Range(0, 512))
        ->capture_default_str();
    sub->add_flag("--report", c.report_only, "Encode nothing, only write report.html, as after the last shard");
    sub->add_flag("--quiet", c.quiet, "Print no progress and no summary");
}

// Notes the option and what is given for it.
void add_to_recipe(BatchArguments& a, CLI::Option* option) {
    a.recipe.push_back(option);
    if (option->get_expected_max() == 0) return;  // a flag
    option->transform([&a, option](const std::string& text) { return a.texts[option] = text; });
}

void add_encode_options(CLI::App* sub, BatchArguments& a) {
    const std::vector<CLI::Option*> before = sub->get_options();
    a.encoding = add_encoding(sub, 1);
    a.threads = sub->get_option("--threads");
    a.memory = sub->get_option("--max-memory");
    const auto add_all = [&](CLI::App* app) {
        for (CLI::Option* option : app->get_options()) {
            const bool is_of_batch = std::find(before.begin(), before.end(), option) != before.end();
            if (!is_of_batch && option != a.threads && option != a.memory) add_to_recipe(a, option);
        }
    };
    add_all(sub);
    for (CLI::App* group : sub->get_subcommands([](CLI::App*) { return true; })) add_all(group);
}

}  // namespace

Subcommand add_batch(CLI::App& app) {
    const auto arguments = std::make_shared<BatchArguments>();
    BatchArguments& a = *arguments;
    CLI::App* sub = app.add_subcommand("batch", "Encode many meshes, and go on where an earlier run ended");
    sub->footer(
        "Takes the options of gim encode, for all meshes alike. OUT_DIR/a/b.ply.gim comes from DIR/a/b.ply, or from "
        "the\n"
        "line a/b.ply. A leading / or .. of a line is left out; if two lines then have one name, the second is "
        "b~2.ply.gim.\n"
        "A folder gives what is named .ply .obj .off .stl .gltf .glb or .npz, and is not hidden; a list may also "
        "name\n"
        "other images (.exr, .gim without header). Paths of a list begin at the current folder.\n"
        "\n"
        "A run skips what is done: the same bytes of the input, options and version, and the output is still there. "
        "It\n"
        "encodes again what changed, failed, or was under way when a run was killed. Only the bytes of the mesh file\n"
        "itself count: if only its textures or buffers changed, remove the output. SIGINT, SIGTERM and SIGHUP end the "
        "run\n"
        "in order; a kill at any moment loses no finished file. Each .gim is whole or not there.\n"
        "An input that fails, crashes the encoder or takes all memory is listed with its reason, and the others go "
        "on.\n"
        "An earlier output of it stays; if the input comes back unchanged, it counts as done.\n"
        "Exit status: 0 all done, 1 some failed, 128 + N ended by signal N with work left, as 130 after Ctrl-C.\n"
        "\n"
        "One JSON object a line tells what became of each input. result: encoded, kept (done before) or failed.\n"
        "The manifest is OUT_DIR/gim-batch-I-of-N.sqlite, with the table files. Each shard has one of its own and "
        "locks it\n"
        "while it runs. So shards on several machines may share OUT_DIR on a network file system whose locks hold on "
        "all\n"
        "of them (NFS 4 does). A second run of one shard at a time is refused, and so are shards of another N. From "
        "run "
        "to\n"
        "run N may change: each shard takes over what others did. The last shard to end writes a report of all.\n"
        "\n"
        "--jobs encodes run at a time, with one thread each if neither --jobs nor --threads is given: this keeps all\n"
        "cores busy, but takes memory for each. --max-memory is then the machine's half, divided by the jobs.\n\n"
        "  gim batch meshes packed --psnr 70\n"
        "  gim batch list.txt packed --max-error 0.1% --log packed/log.jsonl\n"
        "  find scans -name '*.ply' -size +1M | gim batch - packed\n"
        "  gim batch list.txt /shared/packed --shard 3/16     on one of 16 machines");
    add_batch_options(sub, a);
    add_encode_options(sub, a);
    return {sub, [arguments] {
                BatchArguments& given = *arguments;
                given.command.encode = given.encoding();
                given.command.options = recipe_of(given);
                if (!given.shard.empty()) parse_shard(given.shard, given.command.shard, given.command.shards);
                share_machine(given);
                return run_batch(given.command);
            }};
}

}  // namespace gim
