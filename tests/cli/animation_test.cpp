// `sgm build --animate`: frames that are whole, alike and in order.
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

TEST_F(Cli, FramesOfAnAnimationAreClosedAndGoFromEndToEnd) {
    const Outcome run = sgm("build examples/morphs.sgm --set steps=2 --animate become=0..1:5 --resolution 40 -o " +
                            path("f_%02d.off") + " --report " + path("r_%02d.json"));
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
        const std::string build = "build examples/morphs.sgm --set steps=2 --set become=" + std::to_string(still) +
                                  " --resolution 40 --report " + path("s.json");
        ASSERT_EQ(sgm(build).code, 0);
        EXPECT_NEAR(volume[4 * still], Json::parse(read(path("s.json")))["mesh"]["volume_m3"], 0.05);
    }
    EXPECT_NE(volume[0], volume[1]);
    // Where volumes are asked for nothing is kept from frame to frame: the same bytes.
    const Outcome whole = sgm("build examples/morphs.sgm --set steps=2 --animate become=0..1:5 --resolution 40 -o " +
                              path("w_%02d.off") + " -o " + path("w_%02d.vdb"));
    ASSERT_EQ(whole.code, 0) << whole.out;
    for (const char* frame : {"1", "2", "5"})
        EXPECT_EQ(read(path("w_0") + frame + ".off"), read(path("f_0") + frame + ".off"));
}

TEST_F(Cli, InterruptedAnimationLeavesWholeFrames) {
    const std::string out = path("f_%04d.off");
    const pid_t child = fork();
    if (child == 0) {
        freopen("/dev/null", "w", stderr);
        execl(SGM_PROGRAM, SGM_PROGRAM, "build", "examples/morphs.sgm", "-q", "--animate", "become=0..1:2000",
              "--resolution", "64", "-o", out.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    for (int i = 0; i < 60000 && !fs::exists(path("f_0003.off")) && waitpid(child, nullptr, WNOHANG) == 0; ++i)
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_TRUE(fs::exists(path("f_0003.off")));
    for (const auto& entry : fs::directory_iterator(scratch_.path())) {
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
        EXPECT_TRUE(fs::is_empty(scratch_.path())) << more;
        return std::to_string(run.code) + run.out.substr(run.out.find(':') + 1);
    };
    const std::string out = " -o " + path("f_%d.off");
    for (const char* wrong :
         {"become", "become=0..1", "become=0:4", "become=0..1:1", "become=0..1:many", "become=..1:4"})
        EXPECT_NE(said("--animate " + std::string(wrong) + out)[0], '0') << wrong;
    EXPECT_EQ(said("--animate became=0..1:4" + out),
              "2 --animate became=0..1:4: no parameter is called 'became' (did you mean 'become'?)\n");
    EXPECT_EQ(said("--animate become=0..2:4" + out),
              "1 --animate become=0..2:4: 'become' is 2, outside its range 0..1\n");
    EXPECT_EQ(said("--animate become=0..1:4 --animate steps=2..4:3" + out),
              "2 --animate steps=2..4:3: all parameters run over the same frames, and another has 4\n");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f_%d_%d.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4 -o " + path("f_%s.off")).substr(0, 1), "2");
    EXPECT_EQ(said("--animate become=0..1:4").substr(0, 1), "2");
}

}  // namespace
}  // namespace sgm::cli
