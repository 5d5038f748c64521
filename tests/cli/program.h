// The program as its user meets it: `sgm` as built, run from the repository root, and a folder for what it writes.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/scratch.h"

namespace sgm::cli {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Outcome {
    int code = -1;
    std::string out;  ///< stdout and stderr together
};

/// Runs a command of the shell.
inline Outcome outcomeOf(const std::string& command) {
    Outcome run;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    char buffer[4096];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) run.out.append(buffer, n);
    const int status = pclose(pipe);
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

/// Runs `sgm ARGUMENTS`; `before` is shell text that stands in front, as "printf 'R0\\n' | ".
inline Outcome sgm(const std::string& arguments, const std::string& before = "") {
    return outcomeOf(before + SGM_PROGRAM " " + arguments);
}

inline std::string read(const fs::path& path) { return contentOf(path); }

/// A folder of its own for each test, removed afterwards.
class Cli : public testing::Test {
protected:
    std::string path(const std::string& name) const { return (scratch_ / name).string(); }
    std::string grammar(const std::string& text) const {
        return scratch_.write("test.sgm", "grammar 1\n" + text).string();
    }
    /// What `sgm build ARGUMENTS` reports as JSON; null where it failed.
    Json built(const std::string& arguments) const {
        const std::string file = path("report.json");
        const Outcome run = sgm("build " + arguments + " -q --report " + file);
        EXPECT_EQ(run.code, 0) << run.out;
        return run.code == 0 ? Json::parse(read(file)) : Json();
    }
    Scratch scratch_;
};

}  // namespace sgm::cli
