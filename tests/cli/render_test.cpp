// `sgm render`: what it writes and what it refuses. Pictures themselves are tested in tests/render.
#include <csignal>
#include <set>

#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Render : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        file_ = grammar("start A -> cube size (1, 2, 1) color #c04020");
        const Outcome run = sgm("render " + file_ + " --size 8x8 -q -o " + path("probe.png"));
        if (run.code != 0) GTEST_SKIP() << "nothing can be drawn here: " << run.out;
    }
    size_t filesLike(const std::string& start) const {
        size_t count = 0;
        for (const auto& entry : fs::directory_iterator(scratch_.path()))
            count += entry.path().filename().string().starts_with(start) ? 1 : 0;
        return count;
    }
    std::string file_;
};

TEST_F(Render, EndingsMayBeInCapitals) {
    EXPECT_EQ(sgm("render " + file_ + " --size 8x8 -q -o " + path("a.PNG")).code, 0);
    EXPECT_EQ(read(path("a.PNG")), read(path("probe.png")));
    EXPECT_EQ(sgm("render " + file_ + " --size 8x8 -q -o " + path("a.EXR") + " --aov depth").code, 0);
    const std::string varied = grammar(
        "param width = 4 in 2..8.0\nparam rounds = .5 in 0..1.0\nstart House -> morph(cube, sphere, rounds) size "
        "(width, 3, 3)\n");
    EXPECT_EQ(sgm("mutate " + varied + " --rows 1 --cols 2 --resolution 32 --size 32x32 -q -o " + path("b.Png")).code,
              0);
}

TEST_F(Render, LayersGoIntoAnExr) {
    const Outcome run = sgm("render " + file_ + " --size 40x30 -o " + path("a.exr") + " --aov depth,origin");
    EXPECT_EQ(run.code, 0) << run.out;
    const std::string bytes = read(path("a.exr"));
    EXPECT_EQ(bytes.substr(0, 4), "\x76\x2f\x31\x01");
    for (const char* name : {"depth.Z", "origin.V", "\"shape\":", "metres, Y up"})
        EXPECT_NE(bytes.find(name), std::string::npos) << name;
    EXPECT_EQ(bytes.find("normal.X"), std::string::npos);
}

TEST_F(Render, RefusesWhatItCannotWrite) {
    const auto refused = [&](const std::string& arguments, const std::string& hint) {
        const Outcome run = sgm("render " + file_ + " --size 8x8 " + arguments);
        EXPECT_EQ(run.code, 2) << arguments << '\n' << run.out;
        EXPECT_NE(run.out.find(hint), std::string::npos) << run.out;
    };
    refused("-o " + path("a.png") + " --aov depth", "a.exr");
    refused("-o " + path("a.jpg"), ".png");
    refused("-o " + path("a.exr") + " --view mesh", ".png");
    refused("-o " + path("a.exr") + " --aov colour", "depth");
    refused("-o " + path("a.png") + " --turntable 4", "%04d");
    refused("-o " + path("a_%04d.png") + " --turntable 0", "1");
    EXPECT_EQ(sgm("render " + file_ + " -o " + path("no/folder.png")).code, 1);
}

TEST_F(Render, MeshesHaveViewsOfLabelsCreasesAndWires) {
    std::set<std::string> pictures;
    for (const std::string view :
         {"mesh", "mesh --wires", "labels", "creases", "creases --wires", "mesh --surface cubes --wires"}) {
        const Outcome run =
            sgm("render " + file_ + " --resolution 24 --size 40x30 -q -o " + path("a.png") + " --view " + view);
        EXPECT_EQ(run.code, 0) << run.out;
        pictures.insert(read(path("a.png")));
    }
    EXPECT_EQ(pictures.size(), 6u) << "each differs";
    EXPECT_EQ(sgm("render " + file_ + " --wires -o " + path("b.png")).code, 2) << "the field has none";
}

TEST_F(Render, FogIsOneOfTheViews) {
    const Outcome run = sgm("render " + file_ + " --view fog --resolution 24 --size 40x30 -o " + path("a.png"));
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(read(path("a.png")).find("IEND"), std::string::npos);
    EXPECT_EQ(sgm("render " + file_ + " --extinction 2 -o " + path("b.png")).code, 2);
    EXPECT_EQ(sgm("render " + file_ + " --view fog --extinction 0 -o " + path("b.png")).code, 2);
}

TEST_F(Render, FogTakesTheOptionsOfFiles) {
    const auto drawn = [&](const std::string& options) {
        const Outcome run =
            sgm("render " + file_ + " --view fog --resolution 24 --size 40x30 -q -o " + path("a.png") + options);
        EXPECT_EQ(run.code, 0) << options << run.out;
        return read(path("a.png"));
    };
    const std::string plain = drawn(" --format-option edge=.2");
    EXPECT_NE(drawn(" --format-option edge=.2 --format-option wisps=.9"), plain);
    EXPECT_NE(drawn(" --format-option edge=.2 --format-option density=.05"), plain);
    EXPECT_NE(drawn(" --format-option edge=.9"), plain);
    const std::string start = "render " + file_ + " -o " + path("b.png");
    for (const char* wrong : {" --format-option wisps=.6", " --view fog --format-option wisps=7",
                              " --view fog --format-option half=yes", " --view fog --format-option wisps"})
        EXPECT_EQ(sgm(start + wrong).code, 2) << wrong;
}

TEST_F(Render, SectionsOpenEveryViewAndFile) {
    const std::string hall =
        grammar("start A -> cube size 4 color #c04030 - cube size 2 + sphere size 1 color #3040c0\n");
    std::set<std::string> pictures;
    for (const char* section : {"", " --section x=50%", " --section=-x=50%", " --section z=.5m"}) {
        const Outcome run = sgm("render " + hall + " --size 64x64 -q -o " + path("a.png") + section);
        EXPECT_EQ(run.code, 0) << run.out;
        pictures.insert(read(path("a.png")));
    }
    EXPECT_EQ(pictures.size(), 4u) << "each differs";
    const Json whole = built(hall + " --cell .1 -o " + path("a.stl")),
               half = built(hall + " --cell .1 --section y=0 -o " + path("a.stl"));
    EXPECT_NEAR(half["mesh"]["volume_m3"].get<double>(), whole["mesh"]["volume_m3"].get<double>() / 2, .05);
    const std::string start = "build " + hall + " -o " + path("b.stl") + " --section ";
    for (const char* wrong : {"x", "w=1", "x=", "x=1km", "x=nan", "x=-9"})
        EXPECT_EQ(sgm(start + wrong).code, 2) << wrong;
    EXPECT_EQ(sgm("build " + hall + " -o " + path("b.scad") + " --section x=0").code, 2)
        << "trees of solids aren't cut";
    EXPECT_FALSE(fs::exists(path("b.stl")));
}

TEST_F(Render, StatisticsStandBesidePlainSphereTracing) {
    const Outcome run = sgm("render " + file_ + " --size 40x30 --stats -o " + path("a.png"));
    EXPECT_EQ(run.code, 0) << run.out;
    for (const char* line : {"evaluations a pixel", "plain sphere tracing", "samples a pixel", "draw"})
        EXPECT_NE(run.out.find(line), std::string::npos) << line;
    EXPECT_EQ(sgm("render " + file_ + " --view mesh --stats -o " + path("a.png")).code, 2);
}

TEST_F(Render, TurntableGoesAroundTheModel) {
    const Outcome run = sgm("render " + file_ + " --size 48x48 --samples 1 --turntable 4 -o " + path("turn_%02d.png"));
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(filesLike("turn_"), 4u);
    // Every side has another light; all are whole.
    for (int i = 1; i <= 4; ++i)
        for (int j = 1; j < i; ++j)
            EXPECT_NE(read(path("turn_0" + std::to_string(i) + ".png")),
                      read(path("turn_0" + std::to_string(j) + ".png")));
}

TEST_F(Render, AnInterruptLeavesWholePictures) {
    const std::string name = path("turn_%04d.png");
    FILE* pipe = popen((SGM_PROGRAM " render " + file_ + " --size 64x64 --turntable 10000 -o " + name +
                        " & echo $!; wait $!; echo code $?")
                           .c_str(),
                       "r");
    ASSERT_TRUE(pipe);
    char line[4096];
    ASSERT_TRUE(fgets(line, sizeof line, pipe));
    const pid_t pid = std::atoi(line);
    ASSERT_TRUE(fgets(line, sizeof line, pipe)) << "the first picture is written";
    kill(pid, SIGTERM);
    std::string rest;
    while (fgets(line, sizeof line, pipe)) rest += line;
    pclose(pipe);
    EXPECT_NE(rest.find("code 130"), std::string::npos) << rest;
    EXPECT_EQ(filesLike(".sgm-"), 0u) << "no temporary files";
    for (const auto& entry : fs::directory_iterator(scratch_.path()))
        if (entry.path().extension() == ".png") {
            EXPECT_NE(read(entry.path()).find("IEND"), std::string::npos);
        }
}

TEST_F(Cli, APictureOfAMeshTakesTheEditsOfABuild) {
    const std::string file =
        grammar("start A -> cube size (9, 1, 9), sphere size 4 move (0, 2, 0), sphere size 2 move (0, 7, 0)\n");
    const auto drawn = [&](const std::string& options) {
        const Outcome run =
            sgm("render " + file + " --size 64x64 --resolution 48 --view mesh -q -o " + path("a.png") + " " + options);
        EXPECT_EQ(run.code, 0) << options << run.out;
        return read(path("a.png"));
    };
    const std::string plain = drawn("");
    EXPECT_NE(drawn("--keep grounded"), plain) << "the ball in the air is left out";
    EXPECT_NE(drawn("--simplify .02"), plain);
    EXPECT_NE(drawn("--smooth 20"), plain);
    EXPECT_EQ(drawn("--keep all"), plain);
    const Outcome field = sgm("render " + file + " -o " + path("b.png") + " --keep grounded");
    EXPECT_EQ(field.code, 2);
    EXPECT_NE(field.out.find("add --view mesh"), std::string::npos) << field.out;
}

}  // namespace
}  // namespace sgm::cli
