// sgm bake and sgm merge as programs: killed, resumed, refused, and run by GNU parallel.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>
#include <thread>

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
    EXPECT_GT(kills, 3);
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

TEST_F(BakeProgram, NamesWhatTheCellsOfObjectsLack) {
    const std::string file = grammar(
        "start Town -> cube size (60m, 1m, 60m), for i in 1..3 { size 4 move (12m * i - 24m, 2.5m, 0) place Hut }\n"
        "start Hut -> cube size (4, 3, 4) + cube size (.05m, 2m, .05m) move (1.03m, 2.4m, .61m)\n");
    const auto names = [&](const std::string& words) {
        const Outcome run = sgm("bake " + file + options() + words);
        EXPECT_EQ(run.code, 0) << run.out;
        return run.out.find("a 'cube' of 0.05 m is too thin for the cells of 'Hut'") != std::string::npos;
    };
    EXPECT_TRUE(names("-o " + path("city")));
    EXPECT_FALSE(names("-o " + path("city"))) << "it is there already";
    EXPECT_FALSE(names("-q -o " + path("other")));
}

TEST_F(BakeProgram, NamesWhatTheCellsOfTheGroundLack) {
    const std::string file = grammar(
        "terminal lawn color #86a35f\nterminal rock color #808080\n"
        "start Town -> lawn size (100m, .5m, 100m) move (0, .7m, 0), rock size (60m, 8m, 20m) move (0, 4m, 0), "
        "rock size (90m, .2m, 90m) move (0, .6m, 0)\n");
    const auto told = [&](const std::string& cell) {
        std::filesystem::remove_all(path("city" + cell));
        return sgm("bake " + file + " --side 64 --cell " + cell + " -o " + path("city" + cell)).out;
    };
    EXPECT_NE(
        told("2").find("nothing of 'lawn' shows in the ground: it is 0.5 m thick, and the ground's cells are 2 m: "
                       "--cell 0.25 holds it"),
        std::string::npos)
        << told("2");
    EXPECT_EQ(told("1").find("'rock'"), std::string::npos) << "the thin one lies within the lawn";
    EXPECT_EQ(told("0.25").find("shows"), std::string::npos);
}

TEST_F(BakeProgram, SaysWhatIsWrong) {
    const std::string file = grammar(town);
    const auto refused = [&](const std::string& words, int code, const std::string& why) {
        const Outcome run = sgm(words);
        EXPECT_EQ(run.code, code) << words << run.out;
        EXPECT_NE(run.out.find(why), std::string::npos) << words << ": " << run.out;
    };
    refused("bake " + file + " -o " + path("a") + " --tile 4/3", 2, "I is 1 … N");
    refused("bake " + file + " -o " + path("a") + " --side 100", 2, "has to be a multiple of 32 cells");
    refused("merge " + path("nothing"), 1, "run `sgm bake` first");
    refused("merge " + path("nothing") + " --at 91,0", 2, "latitudes are -90 … 90");
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("a") + options() + "--tile 1/3").code, 0);
    refused("merge " + path("a"), 1, "isn't there yet");
    refused("bake " + file + " -q -o " + path("a") + options() + "--seed 2 --tile 1/3", 1, "of another model");
    refused("bake " + file + " -o " + path("a") + options() + "--seed 2 --missing 3", 1, "of another model");
    refused("serve " + path("a"), 1, "sgm merge");
    refused("serve " + path("a") + " --port 70000", 2, "70000");
    refused("merge --for blend " + path("a"), 2, "blend");
}

TEST_F(BakeProgram, RefusesAFolderWhereFilesOfTheGrammarHaveChanged) {
    const auto write = [&](double corner) {
        scratch_.write("lot.svg", "<svg><polygon points=\"0,0 20,0 20," + std::to_string(corner) + " 0,12\"/></svg>");
        scratch_.write("wedge.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 " + std::to_string(corner) +
                                        " 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
    };
    for (const std::string text : {"start A -> footprint file(\"lot.svg\", 1) extrude 9m block\n",
                                   "start A -> mesh(\"wedge.obj\") size (20, 9, 20)\n"}) {
        write(12);
        const std::string bake = "bake " + grammar(text) + " -q -o " + path("city") + options();
        ASSERT_EQ(sgm(bake).code, 0) << sgm(bake).out;
        EXPECT_EQ(sgm(bake).code, 0);
        write(11);
        const Outcome run = sgm(bake);
        EXPECT_EQ(run.code, 1) << text;
        EXPECT_NE(run.out.find("of another model"), std::string::npos) << run.out;
        std::filesystem::remove_all(path("city"));
    }
    const std::string ways = grammar(
        "start A -> A0\nrule One: A0 -> cube size 4m\nrule Two: A0 -> cube size 5m\n"
        "derive first: One\nderive second: Two\n");
    const std::string bake = "bake " + ways + " -q -o " + path("city") + options();
    ASSERT_EQ(sgm(bake + "--derive first").code, 0) << sgm(bake + "--derive first").out;
    EXPECT_EQ(sgm(bake + "--derive second").code, 1);
}

/// A file of /proc, as far as it can be read: its process may end meanwhile, which a stream throws.
std::string processText(const std::filesystem::path& path) {
    std::string text(4096, '\0');
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const ssize_t count = file < 0 ? 0 : ::read(file, text.data(), text.size());
    if (file >= 0) ::close(file);
    text.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
    return text;
}

/// Kills with -9: tasks that bake into a folder, and, where asked, what started them.
class Killer {
public:
    Killer(std::string folder, int programs, int parents)
        : folder_(std::move(folder)), programs_(programs), parents_(parents), thread_([this] { hunt(); }) {}
    ~Killer() {
        stop_ = true;
        thread_.join();
    }
    int killed() const { return killed_; }

private:
    void hunt() {
        namespace fs = std::filesystem;
        std::set<pid_t> seen;
        while (!stop_ && programs_ + parents_ > 0) {
            std::error_code ignored;
            for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
                const std::string name = entry.path().filename();
                const pid_t pid = std::atoi(name.c_str());
                if (pid <= 0 || seen.contains(pid)) continue;
                const std::string command = processText(entry.path() / "cmdline");
                const bool isTask = command.starts_with(SGM_PROGRAM) && command.find(folder_) != std::string::npos &&
                                    command.find("--tile") != std::string::npos;
                if (!isTask) continue;
                seen.insert(pid);
                const std::string stat = processText(entry.path() / "stat");
                if (stat.empty()) continue;
                const pid_t parent = std::atoi(stat.c_str() + stat.find(')') + 4);
                const bool byParent = parents_ > 0 && parent > 1;
                if (byParent && kill(parent, SIGKILL) == 0) --parents_, ++killed_;
                if (!byParent && programs_ > 0 && kill(pid, SIGKILL) == 0) --programs_, ++killed_;
                if (programs_ + parents_ == 0) return;
            }
            usleep(2000);
        }
    }

    const std::string folder_;
    int programs_, parents_;
    std::atomic<int> killed_{0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST_F(BakeProgram, RunsByGnuParallelThroughKills) {
    if (std::system("command -v parallel >/dev/null 2>&1") != 0) GTEST_SKIP() << "GNU parallel is not installed";
    const std::string file = grammar(town);
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("whole") + options()).code, 0);
    ASSERT_EQ(sgm("merge -q " + path("whole")).code, 0);
    const std::string run =
        "SGM=" SGM_PROGRAM " tools/bake-parallel " + file + " " + path("city") + " 5" + options() + " >/dev/null 2>&1";
    Killer killer(path("city"), 4, 0);
    ASSERT_EQ(std::system(run.c_str()), 0);
    EXPECT_EQ(killer.killed(), 4);
    EXPECT_EQ(manifestOf("city"), manifestOf("whole"));
}

TEST_F(BakeProgram, RunsBySlurmThroughKills) {
    if (std::system("command -v sbatch >/dev/null 2>&1 && command -v slurmd >/dev/null 2>&1") != 0 || geteuid() != 0)
        GTEST_SKIP() << "Slurm is not installed (slurmctld, slurmd, slurm-client), or this isn't root";
    const std::string file = grammar(town);
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("whole") + options()).code, 0);
    ASSERT_EQ(sgm("merge -q " + path("whole")).code, 0);
    const std::string run = "SGM=" SGM_PROGRAM " tools/slurm-local tools/bake-slurm " + file + " " + path("city") +
                            " 4" + options() + " >" + path("log") + " 2>&1";
    Killer killer(path("city"), 1, 1);
    ASSERT_EQ(std::system(run.c_str()), 0) << read(path("log"));
    EXPECT_EQ(killer.killed(), 2);
    EXPECT_EQ(manifestOf("city"), manifestOf("whole"));
}

TEST_F(BakeProgram, KeepsAJournalBesideTheResult) {
    const std::string file = grammar(town);
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("a") + options() + "--tile 2/3").code, 0);
    std::istringstream lines(read(path("a/journal/2-3.jsonl")));
    size_t cells = 0;
    nlohmann::json last;
    for (std::string line; std::getline(lines, line);) {
        last = nlohmann::json::parse(line);
        cells += last.contains("cell");
    }
    EXPECT_EQ(last["done"], true);
    EXPECT_EQ(last["made"], cells);
    EXPECT_GT(cells, 3u);
}

TEST_F(BakeProgram, EndsWithWordsWhereTheDiskIsFull) {
    const std::string file = grammar(town);
    const std::string run =
        "ulimit -f 3; " SGM_PROGRAM " bake " + file + " -q -o " + path("full") + options() + " 2>" + path("said");
    const int status = std::system(run.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_NE(read(path("said")).find("cannot write '"), std::string::npos) << read(path("said"));
    // What was begun is finished once there is room.
    ASSERT_EQ(sgm("bake " + file + " -q -o " + path("full") + options()).code, 0);
    const Outcome merged = sgm("merge --verify " + path("full"));
    EXPECT_EQ(merged.code, 0);
    EXPECT_NE(merged.out.find("verified: every cell is as its digest says\n"), std::string::npos) << merged.out;
}

TEST_F(BakeProgram, BakesACaveInCellsOfItsOwnGrid) {
    const std::string file = grammar(
        "terminal rock color #8a8074\n"
        "start Hill -> rock size (400, 60, 300) - sphere size (300, 40, 120) - cylinder size (30, 500, 30) turn (0deg, "
        "0deg, 90deg)\n");
    for (const char* task : {"2/2", "1/2"})
        ASSERT_EQ(sgm("bake " + file + " -q -o " + path("hill") + " --side 128 --cell 2 --tile " + task).code, 0);
    ASSERT_EQ(sgm("merge -q --verify " + path("hill")).code, 0);
    const auto manifest = nlohmann::json::parse(manifestOf("hill"));
    EXPECT_EQ(manifest["instances"], 0);
    EXPECT_GT(manifest["triangles"], 500);
    EXPECT_GE(manifest["cells"].size(), 12u + 4u + 1u);
}

}  // namespace
}  // namespace sgm::cli
