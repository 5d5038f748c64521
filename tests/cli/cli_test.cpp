// What every command promises: exit codes, files all or nothing, the same bytes.
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "tests/cli/program.h"
#include "tests/cpu_time.h"

namespace sgm::cli {
namespace {

/// CPU seconds of the programs run so far.
double secondsOfChildren() {
    rusage use{};
    getrusage(RUSAGE_CHILDREN, &use);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

TEST_F(Cli, HelpOfACommandEndsWithItsOwnExamples) {
    for (const std::string command :
         {"bake", "build", "check", "completion", "examples", "fmt", "lsp", "man", "merge", "mutate", "new", "params",
          "reference", "render", "serve", "step", "tree", "view"}) {
        const std::string help = sgm(command + " --help").out;
        const size_t from = help.find("Example");
        ASSERT_NE(from, std::string::npos) << command;
        const std::string examples = help.substr(from);
        EXPECT_EQ(examples.find("Exit codes"), std::string::npos) << command << " shows the program's";
        const std::string called = command == "lsp" ? "\"lsp\"" : "sgm " + command;
        EXPECT_NE(examples.find(called), std::string::npos) << command;
    }
}

TEST_F(Cli, WrongUsageIsTwo) {
    EXPECT_EQ(sgm("").code, 2);
    EXPECT_EQ(sgm("build").code, 2);
    EXPECT_EQ(sgm("nonsense").code, 2);
    EXPECT_EQ(sgm("build examples/joints.sgm -o " + path("a.xyz")).code, 2);
    EXPECT_EQ(sgm("build examples/joints.sgm --start Nowhere").code, 2);
    EXPECT_EQ(sgm("build examples/joints.sgm --set nothing=1").code, 2);
    EXPECT_EQ(sgm("render examples/joints.sgm --size 12 -o " + path("a.png")).code, 2);
    EXPECT_EQ(sgm("--help").code, 0);
    EXPECT_EQ(sgm("build --help").code, 0);
}

TEST_F(Cli, MissingFileIsOne) {
    const Outcome run = sgm("build " + path("none.sgm"));
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.out.find("none.sgm"), std::string::npos);
    EXPECT_EQ(sgm("build examples/joints.sgm -o " + path("no/such/folder.glb")).code, 1);
}

TEST_F(Cli, BrokenGrammarLeavesTheOldOutput) {
    const std::string file = grammar("start A -> spere size 2\n");
    std::ofstream(path("a.glb")) << "precious";
    const Outcome run = sgm("build " + file + " -o " + path("a.glb"));
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.out.find("sphere"), std::string::npos) << "names the mend: " << run.out;
    EXPECT_NE(run.out.find("test.sgm:2:12"), std::string::npos) << run.out;
    EXPECT_EQ(read(path("a.glb")), "precious");
}

TEST_F(Cli, EveryBadGrammarIsRefusedAndWritesNothing) {
    size_t seen = 0;
    for (const auto& entry : fs::directory_iterator("tests/bad")) {
        if (entry.path().extension() != ".sgm") continue;
        ++seen;
        std::ofstream(path("bad.glb")) << "precious";
        const Outcome run = sgm("build " + entry.path().string() + " -o " + path("bad.glb"));
        EXPECT_EQ(run.code, 1) << entry.path() << ": " << run.out;
        EXPECT_NE(run.out.find(": error: "), std::string::npos) << entry.path() << ": " << run.out;
        EXPECT_EQ(read(path("bad.glb")), "precious") << entry.path();
    }
    EXPECT_GE(seen, 40u);
}

TEST_F(Cli, RunawayThatOnlyShowsWhileDerivingEndsInTheBudget) {
    const std::string file =
        grammar("start A -> cube : Grow\nrule Grow when scope.x > 0m -> + cube size 100% at +x : Grow\n");
    const double before = secondsOfChildren();
    const Outcome run = sgm("build " + file + " --max-shapes 20000 -o " + path("a.glb"));
    EXPECT_LT(secondsOfChildren() - before, boundSeconds(5));
    EXPECT_EQ(run.code, 3) << run.out;
    EXPECT_NE(run.out.find("Grow"), std::string::npos) << run.out;
    EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Cli, ProvablyEndlessRuleIsRefusedByTheCheck) {
    const Outcome run = sgm("check " + grammar("start A -> cube : Grow\nrule Grow -> + cube at +x to centre : Grow\n"));
    EXPECT_EQ(run.code, 1) << run.out;
    EXPECT_NE(run.out.find("Grow"), std::string::npos) << run.out;
}

TEST_F(Cli, SevenFormatsAtOnceAndTheReport) {
    std::string command = "build examples/joints.sgm --resolution 48 --report " + path("r.json");
    for (const char* ending : {"glb", "gltf", "obj", "ply", "stl", "off", "vdb"})
        command += " -o " + path(std::string("a.") + ending);
    const Outcome run = sgm(command);
    ASSERT_EQ(run.code, 0) << run.out;
    for (const char* ending : {"glb", "gltf", "obj", "ply", "stl", "off", "vdb"})
        EXPECT_GT(fs::file_size(path(std::string("a.") + ending)), 1000u) << ending;
    const Json report = Json::parse(read(path("r.json")));
    for (const char* stage :
         {"parse", "check", "derive", "lower", "compile", "subdivide", "sample", "polygonize", "write"})
        EXPECT_TRUE(report["stages"].contains(stage)) << stage;
    EXPECT_EQ(report["mesh"]["boundary_edges"], 0);
    EXPECT_EQ(report["mesh"]["nonmanifold_edges"], 0);
    EXPECT_EQ(report["mesh"]["components"], 1);
    EXPECT_EQ(report["pieces"], 1);
    EXPECT_TRUE(report["floating"].empty());
    EXPECT_GT(report["mesh"]["volume_m3"], 8.0);
    EXPECT_GT(report["field"]["point_evaluations"], 0);
    EXPECT_EQ(report["seed"], 1);
}

TEST_F(Cli, SameBytesAtAnyThreadCount) {
    for (const std::string example : {"grotto", "cumulus", "tower"}) {
        std::string first;
        for (const std::string threads : {"1", "2", "5"}) {
            const std::string out = path("t.ply");
            const Outcome run =
                sgm("build examples/" + example + ".sgm --resolution 64 --seed 5 --threads " + threads + " -o " + out);
            ASSERT_EQ(run.code, 0) << run.out;
            const std::string bytes = read(out);
            if (first.empty()) first = bytes;
            EXPECT_TRUE(bytes == first) << example << " at " << threads << " threads";
        }
    }
}

TEST_F(Cli, TownsOnHillsAreTheSameAtAnyThreadCount) {
    std::string first[2];
    for (const std::string threads : {"1", "3"}) {
        const std::string files[] = {path("town.glb"), path("plan.geojson")};
        const Outcome run = sgm("build examples/city/hills.sgm --set side=400m --cell 8 --object-cell 4 --threads " +
                                threads + " -o " + files[0] + " -o " + files[1]);
        ASSERT_EQ(run.code, 0) << run.out;
        for (const int k : {0, 1}) {
            const std::string bytes = read(files[k]);
            if (first[k].empty()) first[k] = bytes;
            EXPECT_TRUE(bytes == first[k]) << files[k] << " at " << threads << " threads";
        }
    }
    EXPECT_NE(first[0].find("\"mesh\""), std::string::npos);
}

TEST_F(Cli, AnotherSeedChangesOnlyWhatHasChoices) {
    for (const std::string example : {"grotto", "cumulus", "tower"}) {
        std::string bytes[2];
        for (const int k : {0, 1}) {  // .off holds nothing but the surface
            ASSERT_EQ(sgm("build examples/" + example + ".sgm --resolution 48 --seed " + std::to_string(5 + k) +
                          " -o " + path("s.off"))
                          .code,
                      0);
            bytes[k] = read(path("s.off"));
        }
        EXPECT_EQ(bytes[0] != bytes[1], example != "tower") << example;
    }
}

TEST_F(Cli, KilledInTheMiddleOfWritingLeavesTheOldFile) {
    const std::string out = path("a.obj");
    std::ofstream(out) << "precious";
    const pid_t child = fork();
    if (child == 0) {
        freopen("/dev/null", "w", stdout);
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/tower.sgm", "--resolution", "400", "-o", out.c_str(),
              static_cast<char*>(nullptr));
        _exit(127);
    }
    // Kill as soon as anything is being written beside the target.
    bool writing = false;
    for (int i = 0; i < 60000 && !writing && waitpid(child, nullptr, WNOHANG) == 0; ++i) {
        for (const auto& entry : fs::directory_iterator(scratch_.path())) writing |= entry.path().string() != out;
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    ASSERT_TRUE(writing) << "the writer finished before it was seen";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(read(out), "precious");
}

/// Whether a process has a handler for the signal by now.
bool catches(pid_t process, int signal) {
    std::ifstream in("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("SigCgt:")) return std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1;
    return false;
}

TEST_F(Cli, InterruptCancelsWith130AndLeavesNothing) {
    const std::string out = path("a.glb");
    const pid_t child = fork();
    if (child == 0) {
        freopen("/dev/null", "w", stderr);
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/grotto.sgm", "--resolution", "1500", "-o", out.c_str(),
              static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    while (!catches(child, SIGINT) && waitpid(child, &status, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // into the work
    kill(child, SIGINT);
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_TRUE(fs::is_empty(scratch_.path()));
}

TEST_F(Cli, FormatterIsIdempotentAndShippedGrammarsAreFormatted) {
    for (const char* folder : {"examples", "grammar/std"})
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.path().extension() != ".sgm") continue;
            const Outcome run = sgm("fmt --check " + entry.path().string());
            EXPECT_EQ(run.code, 0) << run.out;
        }
    const std::string file = grammar("start   A->cube   size 2 // a comment\n");
    EXPECT_EQ(sgm("fmt --check " + file).code, 1);
    EXPECT_EQ(sgm("fmt " + file).code, 0);
    EXPECT_NE(read(file).find("// a comment"), std::string::npos);
    EXPECT_EQ(sgm("fmt --check " + file).code, 0);
}

TEST_F(Cli, FormatterUpgradesAndReports) {
    const std::string file = grammar("start A -> size 4 B\nrule B -> cube size 1m move (1m, 0, 0) + sphere size 50%\n");
    const Outcome run = sgm("fmt --upgrade " + file);
    EXPECT_EQ(run.code, 0);
    EXPECT_NE(run.out.find("shapes behind this one were measured by it"), std::string::npos) << run.out;
    EXPECT_NE(read(file).find("grammar 2\n"), std::string::npos);
    EXPECT_NE(read(file).find("rule B -> move (1m, 0, 0) size 1m (cube + sphere size 50%)"), std::string::npos)
        << read(file);
    EXPECT_EQ(sgm("check " + file).code, 0);
    EXPECT_EQ(sgm("fmt --upgrade " + file).out, "");
}

TEST_F(Cli, ExamplesCheckFine) {
    for (const auto& entry : fs::directory_iterator("examples")) {
        if (entry.path().extension() != ".sgm") continue;
        const Outcome run = sgm("check " + entry.path().string());
        EXPECT_EQ(run.code, 0) << entry.path() << ": " << run.out;
    }
}

TEST_F(Cli, WhatAClosedJointKeepsFromGrowingIsTold) {
    const Outcome run =
        sgm("build --resolution 16 " + grammar("start A -> cube : B\nrule B -> + cube size .5 at +x + sphere at +x\n"));
    EXPECT_EQ(run.code, 0);
    EXPECT_NE(run.out.find("test.sgm:3:32: warning: '+x' of 'A/B' is closed by 'A/B/cube', made by rule"),
              std::string::npos)
        << run.out;
    // A chain that finds its end there, and what grew elsewhere, are no mistakes.
    const Outcome chain =
        sgm("build --resolution 16 " +
            grammar("start A -> cube : B\nrule B repeat 9 -> + cube at +x to -y + cube size .2 at -x : B\n"));
    EXPECT_EQ(chain.out.find("is closed by"), std::string::npos) << chain.out;
    for (const auto& entry : fs::recursive_directory_iterator("examples")) {
        if (entry.path().extension() != ".sgm") continue;
        const Outcome shipped = sgm("tree " + entry.path().string());
        EXPECT_EQ(shipped.out.find("is closed by"), std::string::npos) << shipped.out;
    }
}

TEST_F(Cli, GrammarsInTheDocsCheckFine) {
    size_t seen = 0;
    for (const char* page : {"README.md", "docs/language.md"}) {
        const std::string text = read(page);
        for (size_t at = 0; (at = text.find("```sgm\n", at)) != std::string::npos;) {
            at += 7;
            const std::string file = path("doc.sgm");
            std::ofstream(file) << text.substr(at, text.find("```", at) - at);
            const Outcome run = sgm("check " + file);
            EXPECT_EQ(run.code, 0) << page << ": " << run.out;
            ++seen;
        }
    }
    EXPECT_GE(seen, 3u);
}

TEST_F(Cli, EveryStepOfTheTutorialChecksFineAndTheLastIsTheExample) {
    const std::string page = read("docs/tutorial.md"), file = path("tower.sgm");
    int steps = 0;
    while (page.find("\n## Step " + std::to_string(steps + 1) + ":") != std::string::npos) {
        const std::string step = std::to_string(++steps);
        ASSERT_EQ(std::system(("awk -v step=" + step + " -f docs/tutorial.awk docs/tutorial.md >" + file).c_str()), 0);
        const Outcome run = sgm("check " + file);
        EXPECT_EQ(run.code, 0) << "step " << step << ": " << run.out;
        EXPECT_NE(run.out.find(file + ": fine\n"), std::string::npos) << "step " << step << ": " << run.out;
        EXPECT_EQ(run.out.find("warning"), std::string::npos) << "step " << step << ": " << run.out;
    }
    EXPECT_GE(steps, 9);
    sgm("fmt " + file);
    // The example says in comments what it is.
    std::string example = read("examples/tutorial.sgm");
    for (size_t at; (at = example.find("//")) != std::string::npos;) example.erase(at, example.find('\n', at) + 1 - at);
    EXPECT_EQ(read(file), example);
}

TEST_F(Cli, CheckJsonIsMachineReadable) {
    const Outcome run = sgm("check --json " + grammar("start A -> spere\n"));
    EXPECT_EQ(run.code, 1);
    const Json problems = Json::parse(run.out);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0]["line"], 2);
    EXPECT_EQ(problems[0]["column"], 12);
}

TEST_F(Cli, ParamsAndTreePrintJson) {
    const Json params = Json::parse(sgm("params --json examples/tower.sgm").out);
    EXPECT_FALSE(params.empty());
    const Json panel = Json::parse(sgm("params --panel examples/tower.sgm").out);
    EXPECT_EQ(panel["parameters"], params);
    EXPECT_EQ(panel["starts"], Json::parse(R"([{"name": "House", "values": {}}])"));
    const Json tree = Json::parse(sgm("tree --json examples/figure1.sgm --derive left").out);
    EXPECT_FALSE(tree.empty());
}

TEST_F(Cli, ProgressIsPrintedAsLines) {
    const Outcome run = sgm("build examples/tower.sgm --resolution 128 -q --progress -o " + path("tower.glb"));
    ASSERT_EQ(run.code, 0) << run.out;
    std::istringstream lines(run.out);
    size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        char stage[64];
        int percent = -1;
        ASSERT_EQ(std::sscanf(line.c_str(), "progress: %63[a-z -] %d", stage, &percent), 2) << line;
        EXPECT_TRUE(percent >= 0 && percent <= 100) << line;
    }
    EXPECT_GT(count, 0u);
    EXPECT_EQ(sgm("build examples/tower.sgm --resolution 128 -q -o " + path("tower.glb")).out, "");
}

TEST_F(Cli, ReferencePageIsUpToDate) {
    EXPECT_EQ(sgm("reference").out, read("docs/reference.md")) << "run: sgm reference > docs/reference.md";
}

TEST_F(Cli, StylesAndSettingsChangeTheModel) {
    const std::string file = grammar("param n = 2m in 1m..9m\nstart A -> cube size n\nstyle Big for A { n = 4m }\n");
    auto volume = [&](const std::string& more) {
        EXPECT_EQ(sgm("build " + file + " --resolution 32 --report " + path("r.json") + more).code, 0);
        return Json::parse(read(path("r.json")))["mesh"]["volume_m3"].get<double>();
    };
    EXPECT_NEAR(volume(""), 8, 0.1);
    EXPECT_NEAR(volume(" --style Big"), 64, 1);
    EXPECT_NEAR(volume(" --style Big --set n=3m"), 27, 0.5);
    EXPECT_EQ(sgm("build " + file + " --set n=10m").code, 1) << "outside its range";
}

TEST_F(Cli, ExamplesAreClosedAndFreeOfSelfIntersections) {
    for (const std::string example : {"grotto", "cumulus", "tower", "joints"}) {
        const Outcome run =
            sgm("build examples/" + example + ".sgm --resolution 128 --validate --report " + path("r.json"));
        EXPECT_EQ(run.code, 0) << example << ": " << run.out;
        const Json mesh = Json::parse(read(path("r.json")))["mesh"];
        EXPECT_EQ(mesh["boundary_edges"], 0) << example;
        EXPECT_EQ(mesh["nonmanifold_edges"], 0) << example;
        EXPECT_EQ(mesh["components"], 1) << example;
    }
}

TEST_F(Cli, GrottoIsOneConnectedVoid) {
    ASSERT_EQ(sgm("build examples/grotto.sgm --start Void --resolution 128 --report " + path("r.json")).code, 0);
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["mesh"]["components"], 1);
    EXPECT_GE(report["rules_applied"]["morphic"], 12);
    // The rock with its lid on, less the void, is the block: 36 x 10 x 30 m.
    const double hollow = report["mesh"]["volume_m3"];
    ASSERT_EQ(sgm("build examples/grotto.sgm --set cut=5m --resolution 128 --report " + path("r.json")).code, 0);
    const double rock = Json::parse(read(path("r.json")))["mesh"]["volume_m3"];
    EXPECT_NEAR(rock + hollow, 36.0 * 10 * 30, 500);
}

TEST_F(Cli, SmoothAndSimplifyKeepTheMeshClosed) {
    ASSERT_EQ(
        sgm("build examples/joints.sgm --resolution 64 --smooth 3 --simplify 0.3 --report " + path("r.json")).code, 0);
    const Json mesh = Json::parse(read(path("r.json")))["mesh"];
    EXPECT_EQ(mesh["boundary_edges"], 0);
    EXPECT_EQ(mesh["nonmanifold_edges"], 0);
}

}  // namespace
}  // namespace sgm::cli
