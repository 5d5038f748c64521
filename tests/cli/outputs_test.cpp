// What `sgm build` writes beside the mesh: options of formats, colliders, levels of detail, the proxy.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

TEST_F(Cli, OptionsGoToTheOutputsThatKnowThem) {
    const std::string start = "build examples/joints.sgm --resolution 32 -o " + path("a.glb") + " -o " + path("a.vdb");
    EXPECT_EQ(sgm(start + " --format-option half=yes --format-option uv=none").code, 0);
    EXPECT_EQ(sgm("build examples/joints.sgm --resolution 32 -o " + path("b.glb") + " --format-option half=yes").code,
              2)
        << "does nothing";
    EXPECT_EQ(sgm(start + " --format-option half").code, 2);
    // Before the work, and before anything is written.
    fs::remove(path("a.glb"));
    EXPECT_EQ(sgm(start + " --format-option wisps=2").code, 2);
    EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Cli, OldNamesOfOptionsWorkAndSayTheNewOnes) {
    const std::string start = "build examples/joints.sgm --resolution 32 -o ";
    ASSERT_EQ(sgm(start + path("new.ply") + " --format-option up=z --format-option attributes=none").out.find("note"),
              std::string::npos);
    const Outcome old = sgm(start + path("old.ply") + " --export up=z --export attributes=none --judge");
    EXPECT_EQ(old.code, 0) << old.out;
    EXPECT_EQ(read(path("old.ply")), read(path("new.ply")));
    EXPECT_NE(old.out.find("note: --export is now --format-option"), std::string::npos) << old.out;
    EXPECT_NE(old.out.find("note: --judge is now --validate"), std::string::npos) << old.out;
    EXPECT_NE(old.out.find("CGAL: closed"), std::string::npos) << old.out;
    const Outcome mixed = sgm(start + path("mixed.ply") + " --export attributes=none --format-option up=z");
    EXPECT_EQ(mixed.code, 0) << mixed.out;
    EXPECT_EQ(read(path("mixed.ply")), read(path("new.ply")));
    const std::string help = sgm("build --help").out;
    for (const char* gone : {"--export", "--judge"}) EXPECT_EQ(help.find(gone), std::string::npos) << gone;
    for (const char* now : {"--format-option", "--validate"}) EXPECT_NE(help.find(now), std::string::npos) << now;
}

TEST_F(Cli, EditsWithoutAMeshAndNumbersWithoutFramesAreTold) {
    const std::string start = "build examples/joints.sgm --resolution 32 ";
    for (const char* edit : {"--smooth 2", "--simplify .5", "--tolerance 5mm", "--flip-normals"}) {
        const Outcome vain = sgm(start + edit + " -o " + path("a.vdb"));
        EXPECT_EQ(vain.code, 2) << vain.out;
        EXPECT_NE(vain.out.find("a.vdb' holds none"), std::string::npos) << vain.out;
    }
    EXPECT_EQ(sgm(start + "--keep largest -o " + path("a.vdb")).code, 0);
    const Outcome numbered = sgm(start + "-o " + path("a_%04d.glb"));
    EXPECT_EQ(numbered.code, 2) << numbered.out;
    EXPECT_NE(numbered.out.find("add --animate"), std::string::npos) << numbered.out;
    const Outcome smoothed = sgm(start + "--smooth 2 -o " + path("a.glb"));
    EXPECT_EQ(smoothed.code, 0);
    EXPECT_NE(smoothed.out.find("--smooth keeps all "), std::string::npos) << smoothed.out;
    EXPECT_EQ(sgm(start + "--smooth 2 --tolerance 5mm -o " + path("a.glb")).out.find("keeps all"), std::string::npos);
}

TEST_F(Cli, AReportIsPrintedOnDemandAndRefusedBeforeTheWork) {
    const std::string start = "build examples/joints.sgm --resolution 32 -o " + path("a.glb") + " --report ";
    const Outcome printed = sgm(start + "- -q");
    ASSERT_EQ(printed.code, 0) << printed.out;
    EXPECT_EQ(Json::parse(printed.out)["mesh"]["components"], 1);
    fs::remove(path("a.glb"));
    const Outcome piped = sgm(start + "/dev/stdout");
    EXPECT_NE(piped.out.find("not a regular file"), std::string::npos) << piped.out;
    EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Cli, AFormatOptionThatNoFormatHasNamesTheNearestOne) {
    const std::string start = "build examples/joints.sgm -o " + path("a.glb") + " --format-option ";
    const Outcome near = sgm(start + "pak=draco"), far = sgm(start + "zzzzzz=1");
    EXPECT_EQ(near.code, 2);
    EXPECT_NE(near.out.find("pak=draco: no format has that option; did you mean 'pack'?"), std::string::npos)
        << near.out;
    EXPECT_NE(far.out.find("zzzzzz=1: no format has that option; `sgm reference` lists them"), std::string::npos)
        << far.out;
}

TEST_F(Cli, ALightMapIsThatOfObjectsWhereTheModelHasNoMeshOfItsOwn) {
    const std::string town =
        grammar("start Town -> size 8 Plot\nrule Plot -> place House\nstart House -> cube size 4\n");
    const Outcome run = sgm("build " + town + " --resolution 32 --format-option lightmap=256 -o " + path("a.gltf"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(read(path("a.gltf")).find("TEXCOORD_1"), std::string::npos);
}

TEST_F(Cli, CollidersGoIntoFilesThatHoldThem) {
    const std::string start = "build examples/joints.sgm --resolution 32 ";
    const Outcome run =
        sgm(start + "--collider convex --format-option engine=unreal -o " + path("a.gltf") + " -o " + path("a.stl"));
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find(" colliders (convex)"), std::string::npos) << run.out;
    const Json file = Json::parse(read(path("a.gltf")));
    EXPECT_EQ(file["nodes"][1]["name"], "UCX_joints_00");
    EXPECT_EQ(sgm(start + "--collider convex -o " + path("b.stl")).code, 2) << "holds none";
    EXPECT_EQ(sgm(start + "--collider hulls -o " + path("b.glb")).code, 2);
    EXPECT_EQ(sgm(start + "--format-option engine=unreal -o " + path("b.glb")).code, 2) << "of no colliders";
    EXPECT_EQ(sgm(start + "--collider mesh --format-option engine=unreal -o " + path("b.glb")).code, 2);
    EXPECT_EQ(sgm(start + "--collider boxes --flip-normals -o " + path("b.glb")).code, 2);
    EXPECT_FALSE(fs::exists(path("b.glb")));
}

TEST_F(Cli, LevelsOfDetailGoIntoFilesThatHoldThem) {
    const std::string start = "build examples/grotto.sgm --resolution 32 ";
    const Outcome run = sgm(start + "--lod 3 -o " + path("a.glb") + " -o " + path("a.stl"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("\nlevel 1: "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(", up to 1/4 of the picture's height\n"), std::string::npos) << run.out;
    EXPECT_NE(read(path("a.glb")).find("\"grotto_LOD2\""), std::string::npos);
    EXPECT_EQ(sgm(start + "-q --lod 1 -o " + path("b.glb")).code, 0);
    EXPECT_EQ(read(path("b.glb")).find("_LOD"), std::string::npos) << "one level is the mesh itself";
    EXPECT_EQ(sgm(start + "--lod 3 -o " + path("b.stl")).code, 2) << "holds none";
    EXPECT_EQ(sgm(start + "--lod 0 -o " + path("b.glb")).code, 2);
    EXPECT_EQ(sgm(start + "--lod 9 -o " + path("b.glb")).code, 2);
    EXPECT_EQ(sgm(start + "--format-option levels=msft -o " + path("b.glb")).code, 2) << "of no levels";
    EXPECT_EQ(sgm(start + "--stream --lod 2 -o " + path("b.stl")).code, 2);
    // Turned inside out, coarser levels are as well; the same bytes at any number of threads.
    for (const char* threads : {"1", "4"})
        ASSERT_EQ(sgm(start + "-q --start Void --flip-normals --lod 6 --threads " + threads + " -o " +
                      path(std::string("in") + threads + ".glb"))
                      .code,
                  0);
    EXPECT_EQ(read(path("in1.glb")), read(path("in4.glb")));
}

TEST_F(Cli, CollidersSayWhatTheyLeaveOut) {
    const std::string file = grammar("start A -> cube size 2 + sphere size 1 at +y blend .3\n");
    const Outcome run = sgm("build " + file + " --resolution 32 --collider convex -o " + path("a.glb"));
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("note: collider: "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("test.sgm:2:"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("taken as sharp"), std::string::npos) << run.out;
}

TEST_F(Cli, ProxyIsASecondCoarseMesh) {
    const Outcome run =
        sgm("build examples/joints.sgm --resolution 64 -o " + path("a.off") + " --proxy " + path("p.off"));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("note: --proxy is now --collider"), std::string::npos) << run.out;
    EXPECT_LT(fs::file_size(path("p.off")), fs::file_size(path("a.off")) / 10);
    EXPECT_EQ(sgm("build examples/joints.sgm --proxy " + path("p.vdb")).code, 2);
    EXPECT_EQ(sgm("build examples/joints.sgm --proxy-tolerance 1").code, 2) << "of no proxy";
}

TEST_F(Cli, AReportOnTheStandardOutputStandsThereAlone) {
    const std::string file = grammar("start A -> cube size 4, cube size .5 move (6, 0, 0)\n");
    const Outcome run = sgm("build " + file + " --resolution 32 --keep largest --validate --report - 2> /dev/null");
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(Json::accept(run.out)) << run.out;
}

TEST_F(Cli, AModelOfWhichNothingIsLeftIsAnErrorWithoutAFileToo) {
    const std::string file = grammar("start A -> cube size 2 & cube size 2 move (5, 0, 0)\n");
    for (const char* words : {"", " --report -"}) EXPECT_EQ(sgm("build " + file + words).code, 1) << words;
}

TEST_F(Cli, BoundsThatReachFarBeyondTheMeshAreTold) {
    const std::string wide = grammar("start A -> cube size 10 & cube size (1, 10, 1)\n");
    const Outcome exact = sgm("build " + wide + " --resolution 32");
    EXPECT_EQ(exact.out.find("warning"), std::string::npos) << exact.out;
    const std::string noisy = grammar("start A -> sphere size 1 displace billow(2m, .01/m)\n");
    const Outcome loose = sgm("build " + noisy + " --resolution 32");
    EXPECT_NE(loose.out.find("of the 32 cells, which are counted along"), std::string::npos) << loose.out;
    EXPECT_EQ(sgm("build " + noisy + " --cell .05").out.find("which are counted along"), std::string::npos);
}

}  // namespace
}  // namespace sgm::cli
