// What a build without OpenVDB, CGAL or the window says where they are needed; with them the same commands work.
#include "tests/cli/program.h"

namespace sgm::cli {
namespace {

/// A command that needs a package: works where the build has it, else ends with 1, the option's name and no file.
struct Need {
    const char* arguments;  ///< behind which the test puts a file
    const char* file;
    bool isBuilt;
    const char* words;
};

const Need needs[] = {
    {"build examples/joints.sgm --resolution 32 -o ", "a.vdb", SGM_HAS_OPENVDB,
     ".vdb needs OpenVDB: this sgm was built without it (SGM_OPENVDB=OFF)"},
    {"build examples/grotto.sgm --resolution 32 --cave -o ", "b.glb", SGM_HAS_OPENVDB,
     "--cave needs OpenVDB: this sgm was built without it (SGM_OPENVDB=OFF)"},
    {"render examples/joints.sgm --size 40x40 --view fog -o ", "f.png", SGM_HAS_OPENVDB,
     "--view fog needs OpenVDB: this sgm was built without it (SGM_OPENVDB=OFF)"},
    {"build examples/joints.sgm --resolution 32 --validate -o ", "c.glb", SGM_HAS_CGAL,
     "--validate needs CGAL: this sgm was built without it (SGM_CGAL=OFF)"},
    {"build examples/joints.sgm --resolution 32 --simplify .5 -o ", "d.glb", SGM_HAS_CGAL,
     "--simplify needs CGAL: this sgm was built without it (SGM_CGAL=OFF)"},
    {"build examples/joints.sgm --resolution 32 --lod 2 -o ", "e.glb", SGM_HAS_CGAL,
     "--lod needs CGAL: this sgm was built without it (SGM_CGAL=OFF)"},
};

TEST_F(Cli, CommandsSayWhichPackageTheBuildLacks) {
    for (const Need& need : needs) {
        const Outcome run = sgm(need.arguments + path(need.file));
        EXPECT_EQ(run.code, need.isBuilt ? 0 : 1) << need.arguments << run.out;
        EXPECT_EQ(run.out.find(need.words) != std::string::npos, !need.isBuilt) << run.out;
        EXPECT_EQ(fs::exists(path(need.file)), need.isBuilt) << need.file;
    }
}

TEST_F(Cli, AMissingModuleOfVolumesIsToldBeforeTheWork) {
    if (!SGM_HAS_OPENVDB) GTEST_SKIP() << "this build needs no module";
    const std::string alone = path("sgm");
    fs::copy_file(SGM_PROGRAM, alone);
    for (const std::string arguments : {" build nowhere.sgm --cave -o a.glb", " build nowhere.sgm -o a.vdb",
                                        " render nowhere.sgm --view fog -o a.png"}) {
        const Outcome run = outcomeOf(alone + arguments);
        EXPECT_EQ(run.code, 1) << arguments;
        EXPECT_NE(run.out.find("sgm_volumes.so is not installed"), std::string::npos) << arguments << run.out;
    }
}

TEST_F(Cli, LotsOfASkeletonNeedCgal) {
    const std::string file = path("lots.sgm");
    std::ofstream(file)
        << "grammar 2\nstart A -> size (60, 4, 40) lots skeleton(300, front: 8m) { lot: cube | inner: cube }\n";
    const Outcome run = sgm("check " + file);
    EXPECT_EQ(run.code, SGM_HAS_CGAL ? 0 : 1) << run.out;
    EXPECT_EQ(run.out.find("lots.sgm:2:34: error: 'skeleton' needs CGAL") != std::string::npos, !SGM_HAS_CGAL)
        << run.out;
}

TEST_F(Cli, ACrispMeshKeepsItsTrianglesWithoutCgal) {
    const Outcome run = sgm("build examples/joints.sgm --resolution 32 -o " + path("a.glb"));
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(run.out.find("the mesh keeps all its triangles") != std::string::npos, !SGM_HAS_CGAL) << run.out;
}

TEST_F(Cli, ViewSaysThatTheWindowIsMissing) {
    const Outcome run = sgm("view examples/tower.sgm --size 1x1");
    EXPECT_EQ(run.out.find("sgm-viewer: --size 1x1") != run.out.npos, SGM_HAS_WINDOW) << run.out;
    const bool says =
        run.out.find("view needs the window: this sgm was built without it (SGM_WINDOW=OFF)") != run.out.npos;
    EXPECT_EQ(says, !SGM_HAS_WINDOW) << run.out;
    EXPECT_EQ(run.code == 1, !SGM_HAS_WINDOW);
}

}  // namespace
}  // namespace sgm::cli
