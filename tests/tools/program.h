// Runs the gim program as its users do, on meshes of the corpus.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "corpus/corpus.h"
#include "tests/tools/test_files.h"

namespace gim::test {

struct Outcome {
    int status = -1;
    std::string out, err;
};

// How the program is started. Empty names: files that Outcome returns.
struct Start {
    std::string in;               // becomes stdin
    std::string out;              // becomes stdout
    std::function<void()> ready;  // runs in the child before the program, as to set limits; calls only system functions
};

// Starts the program without a shell. Returns its process.
inline pid_t start_gim(std::vector<std::string> arguments, const Start& start, const std::string& err) {
    arguments.insert(arguments.begin(), GIM_PROGRAM);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    const pid_t child = ::fork();
    if (child == 0) {
        if (!start.in.empty()) ::dup2(::open(start.in.c_str(), O_RDONLY), STDIN_FILENO);
        ::dup2(::open(start.out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        if (start.ready) start.ready();
        ::execv(GIM_PROGRAM, argv.data());
        ::_exit(127);
    }
    return child;
}

// Exit status, or minus the signal.
inline int wait_for(pid_t child) {
    int state = 0;
    ::waitpid(child, &state, 0);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
}

inline Outcome gim(std::vector<std::string> arguments, Start start = {}) {
    const TemporaryFolder folder;
    const std::string err = folder.file("err");
    const bool keeps_out = start.out.empty();
    if (keeps_out) start.out = folder.file("out");
    const int status = wait_for(start_gim(std::move(arguments), start, err));
    return {status, keeps_out ? load_text(start.out) : "", load_text(err)};
}

inline std::string obj_text(const TriangleMesh& mesh) {
    std::string text;
    char line[120];
    for (const auto& p : mesh.positions) {
        std::snprintf(line, sizeof(line), "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
        text += line;
    }
    for (const auto& t : mesh.triangles) {
        std::snprintf(line, sizeof(line), "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
        text += line;
    }
    return text;
}

inline void save_corpus_mesh(const std::string& name, const std::string& path) {
    const corpus::CorpusEntry entry = corpus::corpus().named(name);
    ASSERT_EQ(entry.name, name);
    save(path, obj_text(entry.mesh()));
}

}  // namespace gim::test
