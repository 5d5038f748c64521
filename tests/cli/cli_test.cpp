// The program as its user meets it: exit codes, files, messages. Runs the built `sgm` from the repository root.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Outcome {
    int code = -1;
    std::string out;  ///< stdout and stderr together
};

Outcome sgm(const std::string& arguments) {
    Outcome run;
    FILE* pipe = popen((std::string(SGM_PROGRAM " ") + arguments + " 2>&1").c_str(), "r");
    char buffer[4096];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) run.out.append(buffer, n);
    const int status = pclose(pipe);
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// A folder of its own for each test, removed afterwards.
class Cli : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("sgm-" + std::to_string(getpid()) + "-" + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string grammar(const std::string& text) const {
        const std::string file = path("test.sgm");
        std::ofstream(file) << "grammar 1\n" << text;
        return file;
    }
    fs::path folder_;
};

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
    const std::string file = grammar("start A -> cube : Grow\nrule Grow when scope.x > 0m -> + cube size 100% at +x : Grow\n");
    const Outcome run = sgm("build " + file + " --max-shapes 20000 -o " + path("a.glb"));
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
    for (const char* ending : {"glb", "gltf", "obj", "ply", "stl", "off", "vdb"}) command += " -o " + path(std::string("a.") + ending);
    const Outcome run = sgm(command);
    ASSERT_EQ(run.code, 0) << run.out;
    for (const char* ending : {"glb", "gltf", "obj", "ply", "stl", "off", "vdb"}) EXPECT_GT(fs::file_size(path(std::string("a.") + ending)), 1000u) << ending;
    const Json report = Json::parse(read(path("r.json")));
    for (const char* stage : {"parse", "check", "derive", "lower", "compile", "subdivide", "sample", "polygonize", "write"})
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

TEST_F(Cli, AFloatingStoreyIsReportedWithItsRuleAndLine) {
    const std::string file = grammar(
        "start House -> cube size (8, 3, 6) : Storey\n"
        "rule Build: Storey repeat 3\n"
        "  -> + cube size (8, 3, 6) at +y move (0, if(i == 2, 1, 0), 0) : Storey\n");
    const Outcome run = sgm("build " + file + " --resolution 32 --report " + path("r.json"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("'House/Storey/Storey[2]', made by rule 'Build' (" + file + ":4) floats"), std::string::npos) << run.out;
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["pieces"], 2);
    ASSERT_EQ(report["floating"].size(), 1u);
    EXPECT_EQ(report["floating"][0]["rule"], "Build");
    EXPECT_EQ(report["floating"][0]["line"], 4);
    EXPECT_NEAR(report["floating"][0]["volume_m3"].get<double>(), 2 * 8 * 3 * 6, 3);
}

TEST_F(Cli, AStalactiteThatHangsInTheAirIsReported) {
    const std::string cave = "start Cave -> cube size 20 - sphere size 16 + Drip size (1, 4, 1) move (0, ";
    const std::string file = grammar(cave + "3, 0)\nrule Drip -> cone turn (180deg, 0deg, 0deg)\n");
    const Outcome run = sgm("build " + file + " --resolution 64");
    EXPECT_NE(run.out.find("'Cave/cube/Drip', made by the start (" + file + ":2) floats"), std::string::npos) << run.out;
    const Outcome hangs = sgm("build " + grammar(cave + "6.5, 0)\nrule Drip -> cone turn (180deg, 0deg, 0deg)\n") + " --resolution 64");
    EXPECT_EQ(hangs.out.find("floats"), std::string::npos) << hangs.out;
}

TEST_F(Cli, SameBytesAtAnyThreadCount) {
    for (const std::string example : {"grotto", "cumulus", "tower"}) {
        std::string first;
        for (const std::string threads : {"1", "2", "5"}) {
            const std::string out = path("t.ply");
            const Outcome run = sgm("build examples/" + example + ".sgm --resolution 64 --seed 5 --threads " + threads + " -o " + out);
            ASSERT_EQ(run.code, 0) << run.out;
            const std::string bytes = read(out);
            if (first.empty()) first = bytes;
            EXPECT_TRUE(bytes == first) << example << " at " << threads << " threads";
        }
    }
}

TEST_F(Cli, AnotherSeedChangesOnlyWhatHasChoices) {
    for (const std::string example : {"grotto", "cumulus", "tower"}) {
        std::string bytes[2];
        for (const int k : {0, 1}) {  // .off holds nothing but the surface
            ASSERT_EQ(sgm("build examples/" + example + ".sgm --resolution 48 --seed " + std::to_string(5 + k) + " -o " + path("s.off")).code, 0);
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
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/tower.sgm", "--resolution", "400", "-o", out.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    // Kill as soon as anything is being written beside the target.
    bool writing = false;
    for (int i = 0; i < 60000 && !writing && waitpid(child, nullptr, WNOHANG) == 0; ++i) {
        for (const auto& entry : fs::directory_iterator(folder_)) writing |= entry.path().string() != out;
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
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/grotto.sgm", "--resolution", "1500", "-o", out.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    while (!catches(child, SIGINT) && waitpid(child, &status, WNOHANG) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // into the work
    kill(child, SIGINT);
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Cli, FormatterIsIdempotentAndExamplesAreFormatted) {
    for (const auto& entry : fs::directory_iterator("examples")) {
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

TEST_F(Cli, ExamplesCheckFine) {
    for (const auto& entry : fs::directory_iterator("examples")) {
        if (entry.path().extension() != ".sgm") continue;
        const Outcome run = sgm("check " + entry.path().string());
        EXPECT_EQ(run.code, 0) << entry.path() << ": " << run.out;
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
    const Json tree = Json::parse(sgm("tree --json examples/figure1.sgm --derive left").out);
    EXPECT_FALSE(tree.empty());
}

TEST_F(Cli, FramesOfAnAnimationAreClosedAndGoFromEndToEnd) {
    const Outcome run = sgm("build examples/morphs.sgm --set steps=2 --animate become=0..1:5 --resolution 40 -o " + path("f_%02d.off") + " --report " + path("r_%02d.json"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("frame 5 of 5, become = 1"), std::string::npos) << run.out;
    double volume[5];
    for (int frame = 1; frame <= 5; ++frame) {
        EXPECT_TRUE(fs::exists(path("f_0" + std::to_string(frame) + ".off")));
        const Json mesh = Json::parse(read(path("r_0" + std::to_string(frame) + ".json")))["mesh"];
        EXPECT_EQ(mesh["boundary_edges"], 0);
        EXPECT_EQ(mesh["nonmanifold_edges"], 0);
        volume[frame - 1] = mesh["volume_m3"];
    }
    for (int still : {0, 1}) {
        const std::string build = "build examples/morphs.sgm --set steps=2 --set become=" + std::to_string(still) + " --resolution 40 --report " + path("s.json");
        ASSERT_EQ(sgm(build).code, 0);
        EXPECT_NEAR(volume[4 * still], Json::parse(read(path("s.json")))["mesh"]["volume_m3"], 0.05);
    }
    EXPECT_NE(volume[0], volume[1]);
    // Where volumes are asked for nothing is kept from frame to frame: the same bytes.
    const Outcome whole = sgm("build examples/morphs.sgm --set steps=2 --animate become=0..1:5 --resolution 40 -o " + path("w_%02d.off") + " -o " + path("w_%02d.vdb"));
    ASSERT_EQ(whole.code, 0) << whole.out;
    for (const char* frame : {"1", "2", "5"})
        EXPECT_EQ(read(path("w_0") + frame + ".off"), read(path("f_0") + frame + ".off"));
}

TEST_F(Cli, InterruptedAnimationLeavesWholeFrames) {
    const std::string out = path("f_%04d.off");
    const pid_t child = fork();
    if (child == 0) {
        freopen("/dev/null", "w", stderr);
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/morphs.sgm", "-q", "--animate", "become=0..1:2000", "--resolution", "64", "-o", out.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    for (int i = 0; i < 60000 && !fs::exists(path("f_0003.off")) && waitpid(child, nullptr, WNOHANG) == 0; ++i) std::this_thread::sleep_for(std::chrono::microseconds(500));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_TRUE(fs::exists(path("f_0003.off")));
    for (const auto& entry : fs::directory_iterator(folder_)) {
        ASSERT_EQ(entry.path().extension(), ".off") << entry.path();
        std::istringstream text(read(entry.path()));
        std::string word;
        size_t vertices = 0, faces = 0, lines = 0;
        text >> word >> vertices >> faces;
        for (std::getline(text, word); std::getline(text, word);) lines += !word.empty();
        EXPECT_EQ(lines, vertices + faces) << entry.path();
    }
}

TEST_F(Cli, AnimationsThatMeanNothingAreWrongUsage) {
    const auto said = [&](const std::string& more) {
        const Outcome run = sgm("build examples/morphs.sgm --resolution 16 " + more);
        EXPECT_TRUE(fs::is_empty(folder_)) << more;
        return std::to_string(run.code) + run.out.substr(run.out.find(':') + 1);
    };
    const std::string out = " -o " + path("f_%d.off");
    for (const char* wrong : {"become", "become=0..1", "become=0:4", "become=0..1:1", "become=0..1:many", "become=..1:4"}) EXPECT_NE(said("--animate " + std::string(wrong) + out)[0], '0') << wrong;
    EXPECT_EQ(said("--animate became=0..1:4" + out), "2 --animate became=0..1:4: no parameter is called 'became' (did you mean 'become'?)\n");
    EXPECT_EQ(said("--animate become=0..2:4" + out), "1 --animate become=0..2:4: 'become' is 2, outside its range 0..1\n");
    EXPECT_EQ(said("--animate become=0..1:4 --animate steps=2..4:3" + out), "2 --animate steps=2..4:3: all parameters run over the same frames, and another has 4\n");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f_%d_%d.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f_%s.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4").substr(0, 1), "2");
}

/// What `sgm step FILE` says when these lines are piped to it.
Outcome stepped(const std::string& commands, const std::string& file) {
    Outcome run;
    FILE* pipe = popen(("printf '" + commands + "' | " SGM_PROGRAM " step " + file + " 2>&1").c_str(), "r");
    char buffer[4096];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) run.out.append(buffer, n);
    run.code = WEXITSTATUS(pclose(pipe));
    return run;
}

TEST_F(Cli, StepSavesFigureOnesWays) {
    const std::string file = path("figure1.sgm");
    const std::string text = read("examples/figure1.sgm");
    std::ofstream(file) << text;
    const Outcome run = stepped("R0\\nundo\\nredo\\nR1\\nundo\\nR2 at Figure/A\\n1\\nway\\nsave mine\\nsave right\\n", file);
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("derive way: R0 => R2 => R4\n"), std::string::npos) << run.out;
    EXPECT_EQ(read(file), text + "derive mine: R0 => R2 => R4\n");
    const auto tree = [&](const std::string& way) { return sgm("tree " + file + " --derive " + way).out; };
    EXPECT_EQ(tree("mine"), tree("right"));
    EXPECT_NE(tree("mine"), tree("left"));
    const Outcome hand = stepped("R0 => R2\\nrest\\ntree\\n", file);
    EXPECT_NE(hand.out.find(tree("right")), std::string::npos) << hand.out;
}

TEST_F(Cli, StepStopsAtTheFirstMistakeInAPipe) {
    const auto expectSaid = [&](const std::string& commands, const char* said) {
        const Outcome run = stepped(commands, "examples/figure1.sgm");
        EXPECT_EQ(run.code, 1) << run.out;
        EXPECT_NE(run.out.find(said), std::string::npos) << run.out;
        EXPECT_EQ(run.out.find("DE"), std::string::npos) << "went on: " << run.out;
    };
    expectSaid("undo\\nR0\\nR2\\n", "there is nothing to undo");
    expectSaid("R9\\nR0\\nR2\\n", "no rule is called 'R9'");
    expectSaid("R1\\nR0\\nR2\\n", "rule 'R1' matches nothing here");
    expectSaid("7\\nR0\\nR2\\n", "there is no number 7");
    expectSaid("way\\nR0\\nR2\\n", "no rule was applied yet");
    expectSaid("R0 at Figure/B\\nR0\\nR2\\n", "there is no shape 'Figure/B' here");
    EXPECT_EQ(sgm("step examples/figure1.sgm </dev/null").code, 0);
}

TEST_F(Cli, ReferencePageIsUpToDate) { EXPECT_EQ(sgm("reference").out, read("docs/reference.md")) << "run: sgm reference > docs/reference.md"; }

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
        const Outcome run = sgm("build examples/" + example + ".sgm --resolution 128 --judge --report " + path("r.json"));
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
    ASSERT_EQ(sgm("build examples/joints.sgm --resolution 64 --smooth 3 --simplify 0.3 --report " + path("r.json")).code, 0);
    const Json mesh = Json::parse(read(path("r.json")))["mesh"];
    EXPECT_EQ(mesh["boundary_edges"], 0);
    EXPECT_EQ(mesh["nonmanifold_edges"], 0);
}

TEST_F(Cli, OptionsGoToTheOutputsThatKnowThem) {
    const std::string start = "build examples/joints.sgm --resolution 32 -o " + path("a.glb") + " -o " + path("a.vdb");
    EXPECT_EQ(sgm(start + " --export half=yes --export uv=none").code, 0);
    EXPECT_EQ(sgm("build examples/joints.sgm --resolution 32 -o " + path("b.glb") + " --export half=yes").code, 2) << "does nothing";
    EXPECT_EQ(sgm(start + " --export half").code, 2);
    // Before the work, and before anything is written.
    fs::remove(path("a.glb"));
    EXPECT_EQ(sgm(start + " --export wisps=2").code, 2);
    EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Cli, ProxyIsASecondCoarseMesh) {
    ASSERT_EQ(sgm("build examples/joints.sgm --resolution 64 -o " + path("a.off") + " --proxy " + path("p.off")).code, 0);
    EXPECT_LT(fs::file_size(path("p.off")), fs::file_size(path("a.off")) / 10);
    EXPECT_EQ(sgm("build examples/joints.sgm --proxy " + path("p.vdb")).code, 2);
    EXPECT_EQ(sgm("build examples/joints.sgm --proxy-tolerance 1").code, 2) << "of no proxy";
}

const char* const threeRooms = R"(start Rock -> cube size (24, 8, 12) - Air
rule Air -> cube size (4, 3, 4) + cube size (4, 3, 4) move (-8, 0, 0) + cube size (4, 3, 4) move (8, 0, 0)
            + cube size (6, 2.4, 2) move (-4, -.3, 0) + cube size (6, 2.4, .5) move (4, -.3, 0)
start Void -> Air
)";

TEST_F(Cli, TheCaveReportTellsRoomsAndPassages) {
    const Outcome run = sgm("build " + grammar(threeRooms) + " --cave --agent .5,1.8 --cell .15 --report " + path("r.json") + " --floor " + path("f.obj"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("too narrow"), std::string::npos) << run.out;
    const Json cave = Json::parse(read(path("r.json")))["cave"];
    EXPECT_EQ(cave["spaces"].size(), 1u);
    EXPECT_EQ(cave["rooms"].size(), 3u);
    ASSERT_EQ(cave["passages"].size(), 2u);
    EXPECT_NE(cave["passages"][0]["passable"], cave["passages"][1]["passable"]);
    EXPECT_NEAR(cave["narrowest_m"].get<double>(), 0.25, 0.15);
    EXPECT_EQ(cave["walkable"]["parts"], 2);
    EXPECT_NE(read(path("f.obj")).find("\nf "), std::string::npos);
}

TEST_F(Cli, WithoutCaveThereIsNoSurvey) {
    ASSERT_EQ(sgm("build " + grammar(threeRooms) + " --cell .4 -q --report " + path("r.json")).code, 0);
    EXPECT_FALSE(Json::parse(read(path("r.json"))).contains("cave"));
}

TEST_F(Cli, AHollowFacesInward) {
    const std::string file = grammar(threeRooms);
    ASSERT_EQ(sgm("build " + file + " --start Void --cell .2 -q -o " + path("out.obj")).code, 0);
    ASSERT_EQ(sgm("build " + file + " --start Void --cell .2 -q --inward --cave --agent .5,1.8 --report " + path("r.json") + " -o " + path("in.obj")).code, 0);
    const Json report = Json::parse(read(path("r.json")));
    EXPECT_EQ(report["cave"]["rooms"].size(), 3u);
    EXPECT_TRUE(report["cave"]["entrances"].empty());
    // The signed volume under each file's faces.
    const auto volume = [&](const std::string& name) {
        std::istringstream lines(read(path(name)));
        std::vector<std::array<double, 3>> v;
        double sum = 0;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string kind;
            words >> kind;
            if (kind == "v") {
                auto& p = v.emplace_back();
                words >> p[0] >> p[1] >> p[2];
            } else if (kind == "f") {
                size_t at[3];
                std::string corner;
                for (size_t& i : at) words >> corner, i = std::stoul(corner) - 1;
                const auto &a = v[at[0]], &b = v[at[1]], &c = v[at[2]];
                sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
            }
        }
        return sum;
    };
    const double outward = volume("out.obj");
    EXPECT_GT(outward, 100);
    EXPECT_NEAR(volume("in.obj"), -outward, 1e-3 * outward);
}

TEST_F(Cli, AFloatingStalactiteIsReported) {
    const std::string hanging = "start Rock -> cube size (8, 6, 8) - cube size (6, 4, 6) + cone size (1, 2, 1) turn (180deg, 0deg, 0deg) move (0, ";
    const Outcome floats = sgm("build " + grammar(hanging + ".5, 0)\n") + " --cell .1");
    EXPECT_EQ(floats.code, 0);
    EXPECT_NE(floats.out.find("floats"), std::string::npos) << floats.out;
    const Outcome attached = sgm("build " + grammar(hanging + "1.1, 0)\n") + " --cell .1");
    EXPECT_EQ(attached.out.find("floats"), std::string::npos) << attached.out;
}

TEST_F(Cli, WrongCaveOptionsAreTwo) {
    const std::string file = grammar(threeRooms);
    EXPECT_EQ(sgm("build " + file + " --cave --agent tall").code, 2);
    EXPECT_EQ(sgm("build " + file + " --cave --agent 1,1 --cell .4").code, 2);
    EXPECT_EQ(sgm("build " + file + " --floor " + path("f.vdb")).code, 2);
    EXPECT_EQ(sgm("build " + file + " --floor " + path("f.obj") + " --agent .3,40 --cell .4").code, 1);
    EXPECT_FALSE(fs::exists(path("f.obj")));
}

}  // namespace
