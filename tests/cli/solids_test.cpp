// Solid trees (.csg.json, .scad), through the whole program.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

class Solids : public Cli {
protected:
    /// A box with a hole and a hat, its text on lines 2 and 3.
    std::string model() const {
        return grammar(
            "start A -> cube size (4, 2, 4) color #ff0000 - cylinder size (2, 3, 2)\n"
            "  + pyramid size (4, 2, 4) at +y color #00ff00 + capsule size (1, 3, 2) move (5, 0, 0) turn (0deg, 30deg, "
            "0deg)\n");
    }
};

TEST_F(Solids, HoldWhatTheGrammarSays) {
    const std::string file = path("a.csg.json");
    const Outcome run = sgm("build " + model() + " -o " + file + " -o " + path("a.PLY"));
    ASSERT_EQ(run.code, 0) << run.out;
    const Json tree = Json::parse(read(file));
    EXPECT_EQ(tree["format"], "sgm solid tree");
    EXPECT_EQ(tree["extras"]["grammar"], "test.sgm");
    ASSERT_EQ(tree["nodes"].size(), 6u);
    const Json& hole = tree["nodes"][1];
    EXPECT_EQ(hole["solid"], "cylinder");
    EXPECT_EQ(hole["size"], Json({2, 3, 2}));
    const Json& part = tree["parts"][hole["origin"].get<size_t>()];
    EXPECT_EQ(part["path"], "A/cube/cylinder");
    EXPECT_EQ(part["line"], 2);
    EXPECT_EQ(tree["materials"][part["material"].get<size_t>()]["color"], Json({1, 0, 0}))
        << "a cut looks like its host";
    EXPECT_EQ(tree["nodes"][3], Json({{"op", "difference"}, {"of", {0, 1}}}));
    EXPECT_EQ(tree["nodes"][2]["centre"], Json({0, 2, 0}));
    EXPECT_EQ(tree["nodes"].back(), Json({{"op", "union"}, {"of", {3, 2, 4}}}));
    EXPECT_GT(fs::file_size(path("a.PLY")), 1000u) << "beside meshes";
}

TEST_F(Solids, NeedNoMesh) {
    const std::string file = path("a.csg.json");
    const std::string thin = grammar("start A -> cube size (1000, 1, .001)\n");  // no cell shows it
    const Outcome run = sgm("build " + thin + " -o " + file);
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(run.out, "wrote " + file + "\n");
    EXPECT_EQ(sgm("build -q " + thin + " --animate x=0..1:2 -o " + path("a_%d.scad")).code, 2) << "no such parameter";
}

TEST_F(Solids, ComeFrameByFrame) {
    const std::string file = grammar("param high = 1 in 1..3 \"Height\"\nstart A -> cube size (1, high, 1)\n");
    ASSERT_EQ(sgm("build " + file + " --animate high=1..3:3 -o " + path("a_%d.csg.json")).code, 0);
    EXPECT_EQ(Json::parse(read(path("a_3.csg.json")))["nodes"][0]["size"], Json({1, 3, 1}));
}

TEST_F(Solids, RefuseWhatIsNoneBeforeTheyMesh) {
    std::ofstream(path("a.csg.json")) << "precious";
    const Outcome run = sgm("build " + grammar("start A -> cube size 2\n  + sphere size 1 at +y blend .2m\n") + " -o " +
                            path("a.glb") + " -o " + path("a.csg.json"));
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.out.find("test.sgm:3:3: 'A/cube/sphere' is blended in over 0.2 m"), std::string::npos) << run.out;
    EXPECT_EQ(read(path("a.csg.json")), "precious");
    EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Solids, AreNoMeshes) {
    for (const std::string& option :
         {"--proxy " + path("a.scad"), "--cave --floor " + path("a.csg.json"), "-o " + path("a.scad") + " --stream",
          "-o " + path("a.scad") + " --export sides=7", "-o " + path("a.json")})
        EXPECT_EQ(sgm("build " + model() + " " + option).code, 2) << option;
}

TEST_F(Solids, AreOpenScadsToo) {
    if (sgm("--version", "command -v openscad > /dev/null || exit 127; ").code == 127)
        GTEST_SKIP() << "openscad isn't installed";
    const std::string file = path("a.scad"), stl = path("a.stl");
    ASSERT_EQ(sgm("build " + model() + " -o " + file + " --export sides=32").code, 0);
    ASSERT_EQ(std::system(("openscad -o " + stl + " " + file + " > /dev/null 2>&1").c_str()), 0);
    const Json mesh = built(grammar("start A -> mesh(\"a.stl\") size 10\n") + " --resolution 32")["mesh"];
    EXPECT_EQ(mesh["boundary_edges"], 0);
    EXPECT_EQ(mesh["components"], 2);
}

}  // namespace
}  // namespace sgm::cli
