// sgm bake and sgm merge as programs: killed, resumed, refused, and run by GNU parallel.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

const std::string town =
    "terminal lawn color #86a35f\n"
    "start Town -> size (300, 4, 300) (lawn - sphere size (90, 20, 90) move (30, 8, -10), split x { { ~30m: Row }* })\n"
    "rule Row -> split z { { ~30m: Plot }* }\n"
    "rule Plot -> move (0, 6m, 0) size 8 turn (0deg..90deg) place House variety 5\n"
    "start House -> cube size (8, 4m..9m, 6) - cube size (1, 2, 9) at -y to centre\n";

class BakeProgram : public Cli {
protected:
    /// Starts sgm without waiting for it.
    static pid_t begin(const std::string& words) {
        const pid_t pid = fork();
        if (pid != 0) return pid;
        execl("/bin/sh", "sh", "-c", ("exec " SGM_PROGRAM " " + words + " >/dev/null 2>&1").c_str(), nullptr);
        _exit(127);
    }
    std::string options() const { return " --side 64 --cell 1 --object-cell .5 --threads 1 "; }
    std::string manifestOf(const std::string& folder) { return read(path(folder + "/manifest.json")); }
};

TEST_F(BakeProgram, KilledAtAnyMomentItGoesOnToTheSameBytes) {
    const std::string file = grammar(town);
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("whole") + options()).code, 0);
    ASSERT_EQ(sgm("merge -q --verify " + path("whole")).code, 0);
    std::mt19937 random(7);
    int kills = 0;
    for (int i = 0; i < 12; ++i) {
        const pid_t pid =
            begin("bake " + file + " -q -o " + path("killed") + options() + (i % 2 ? "--tile 2/3" : "--tile 1/3"));
        usleep(5'000 + random() % 70'000);
        kill(pid, SIGKILL);
        int status = 0;
        waitpid(pid, &status, 0);
        kills += WIFSIGNALED(status);
    }
    EXPECT_GT(kills, 0);
    const Outcome missing = sgm("bake " + file + " -o " + path("killed") + options() + "--missing 3");
    EXPECT_NE(missing.out.find('3'), std::string::npos) << missing.out;
    for (const char* task : {"1/3", "2/3", "3/3"})
        ASSERT_EQ(sgm("bake " + file + " -q -o " + path("killed") + options() + "--tile " + task).code, 0);
    EXPECT_EQ(sgm("bake " + file + " -o " + path("killed") + options() + "--missing 3").out, "\n");
    ASSERT_EQ(sgm("merge -q --verify " + path("killed")).code, 0);
    EXPECT_EQ(manifestOf("killed"), manifestOf("whole"));
    EXPECT_EQ(read(path("killed/tileset.json")), read(path("whole/tileset.json")));
    EXPECT_EQ(nlohmann::json::parse(manifestOf("whole"))["instances"], 100);
}

TEST_F(BakeProgram, SaysWhatIsWrong) {
    const std::string file = grammar(town);
    const auto refused = [&](const std::string& words, int code, const std::string& why) {
        const Outcome run = sgm(words);
        EXPECT_EQ(run.code, code) << words << run.out;
        EXPECT_NE(run.out.find(why), std::string::npos) << words << ": " << run.out;
    };
    refused("bake " + file + " -o " + path("a") + " --tile 4/3", 2, "write I/N, task I of N");
    refused("bake " + file + " -o " + path("a") + " --side 100", 2, "has to be a multiple of 32 cells");
    refused("merge " + path("nothing"), 1, "run `sgm bake` first");
    refused("merge " + path("nothing") + " --at 91,0", 2, "LATITUDE,LONGITUDE");
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("a") + options() + "--tile 1/3").code, 0);
    refused("merge " + path("a"), 1, "isn't there yet");
    refused("bake " + file + " -q -o " + path("a") + options() + "--seed 2 --tile 1/3", 1, "of another model");
}

TEST_F(BakeProgram, RunsByGnuParallel) {
    if (std::system("command -v parallel >/dev/null 2>&1") != 0) GTEST_SKIP() << "GNU parallel is not installed";
    const std::string file = grammar(town);
    const std::string run =
        "SGM=" SGM_PROGRAM " tools/bake-parallel " + file + " " + path("city") + " 5" + options() + " >/dev/null 2>&1";
    ASSERT_EQ(std::system(run.c_str()), 0);
    EXPECT_EQ(nlohmann::json::parse(manifestOf("city"))["instances"], 100);
}

}  // namespace
}  // namespace sgm::cli
