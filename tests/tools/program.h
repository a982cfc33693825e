// Runs the gim program as its users do, on meshes of the corpus.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

#include "corpus/corpus.h"
#include "tests/tools/test_files.h"

namespace gim::test {

struct Outcome {
    int status = -1;
    std::string out, err;
};

// Starts the program without a shell.
inline Outcome gim(std::vector<std::string> arguments) {
    const TemporaryFolder folder;
    const std::string out = folder.file("out");
    const std::string err = folder.file("err");
    arguments.insert(arguments.begin(), GIM_PROGRAM);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);

    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::execv(GIM_PROGRAM, argv.data());
        ::_exit(127);
    }
    int state = 0;
    ::waitpid(child, &state, 0);
    return {WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state), load_text(out), load_text(err)};
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
