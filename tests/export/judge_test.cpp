// Judges from outside: Khronos' gltf-validator and OpenSCAD. Where one isn't installed its test skips aloud.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "modeler/export/exporter.h"
#include "modeler/mesh/convex_polyhedron.h"
#include "tests/export/hand_made.h"
#include "tests/export/read_back.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

int run(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

struct Judged : testing::Test {
    mesh::Mesh mesh = icosphere({0.1f, 0.2f, 0.3f}, 1.7f, 3, 4);
    Provenance provenance = twoMaterials();
    Scratch folder;
    ExportInput input;
    Judged() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.extras = {{"grammar", "a.sgm"}, {"seed", "1"}};
    }
};

TEST_F(Judged, GltfValidatorFindsNothing) {
    const auto glb = folder / "a.glb", gltf = folder / "a.gltf", plain = folder / "b.glb", verdict = folder / "verdict";
    ASSERT_TRUE(write(input, glb).ok());
    ASSERT_TRUE(write(input, gltf).ok());
    Collider box;
    mesh::ConvexPolyhedron(Box3d{{-1, -1, -1}, {1, 1, 1}}).triangulate(box.positions, box.triangles);
    const Collider colliders[] = {box, box};
    input.colliders = colliders;
    input.options = {{"uv", "none"}};
    ASSERT_TRUE(write(input, plain).ok());
    // Two objects under a group, and one piece.
    const auto tree = folder / "tree.glb", piece = folder / "piece.glb";
    ObjectTree objects{{{"a", 0, "A", "A", "", "a.sgm", 1, {}},
                        {"group", 0, "A/group", "group", "grow", "a.sgm", 2, {}},
                        {"B", 1, "A/group/B", "B", "grow", "a.sgm", 2, {{"size", Vec3d{1, 2, 3}}, {"with n", 1.0}}}},
                       {0, 0, 2}};
    input.options = {{"lightmap", "512"}};
    input.objects = &objects;
    ASSERT_TRUE(write(input, tree).ok());
    input.objects = nullptr;
    input.options = {};
    input.byMaterial = false;
    ASSERT_TRUE(write(input, piece).ok());
    const int code =
        run("node tests/export/validate_gltf.js " + glb.string() + " " + gltf.string() + " " + plain.string() + " " +
            tree.string() + " " + piece.string() + " > " + verdict.string() + " 2>/dev/null");
    if (code == 3 || code == 127)
        GTEST_SKIP() << "gltf-validator isn't installed: npm install --prefix build gltf-validator";
    ASSERT_EQ(code, 0);
    const std::string clean = "{\"errors\":0,\"warnings\":0,\"messages\":[]}\n";
    EXPECT_EQ(contentOf(verdict), clean + clean + clean + clean + clean);
}

TEST_F(Judged, OpenScadTakesTheStlInADifference) {
    if (run("command -v openscad > /dev/null 2>&1") != 0) GTEST_SKIP() << "openscad isn't installed";
    ASSERT_TRUE(write(input, folder / "a.stl").ok());
    const auto scene = folder / "cut.scad", cut = folder / "cut.stl";
    std::ofstream(scene) << "difference() { import(\"a.stl\"); translate([0, 0, 5]) cube(10, center = true); }\n";
    ASSERT_EQ(run("openscad -o " + cut.string() + " " + scene.string() + " > /dev/null 2>&1"), 0);
    const ReadBack r = readBack(cut);
    Box3f box;
    for (const Vec3f& p : r.positions) box = hull(box, p);
    EXPECT_NEAR(box.hi.z, 0, 1e-5f);
    EXPECT_NEAR(box.lo.z, 0.3f - 1.7f, 0.05f);
}

}  // namespace
}  // namespace sgm::exporter
