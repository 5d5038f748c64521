// A mesh with creases keeps its hard edges in every format that has any.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <tuple>

#include "modeler/core/conventions.h"
#include "modeler/export/exporter.h"
#include "tests/export/read_back.h"
#include "tests/hard_box.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Key = std::tuple<float, float, float>;
std::set<Key> distinct(const std::vector<Vec3f>& all) {
    std::set<Key> keys;
    for (const Vec3f& v : all) keys.insert({v.x, v.y, v.z});
    return keys;
}

/// How many lines begin with `word`.
size_t linesOf(const std::string& text, const std::string& word) {
    std::istringstream in(text);
    size_t count = 0;
    for (std::string line; std::getline(in, line);) count += line.starts_with(word + " ");
    return count;
}

struct HardEdges : testing::Test {
    mesh::Mesh mesh = meshOfChunks({hardBox({1, 2, 3}, {}, {1, 1, 1}, 0)});
    ExportInput input;
    Scratch folder;
    HardEdges() { input.mesh = &mesh; }
    std::filesystem::path written(const std::string& name) {
        const auto path = folder / name;
        const Status status = write(input, path);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return path;
    }
};

TEST_F(HardEdges, ACubeInGltfHas24VerticesOver8Positions) {
    for (const char* name : {"cube.glb", "cube.gltf"}) {
        const ReadBack r = readBack(written(name));
        EXPECT_EQ(r.triangles.size(), 12u);
        EXPECT_EQ(r.positions.size(), 24u);
        EXPECT_EQ(distinct(r.positions).size(), 8u);
        EXPECT_EQ(distinct(r.normals).size(), 6u);
        for (const mesh::Triangle& t : r.triangles) {
            const Vec3f a = r.positions[t.x], n = normalized(cross(r.positions[t.y] - a, r.positions[t.z] - a));
            for (int k = 0; k < 3; ++k) EXPECT_EQ(r.normals[t[k]], n);
        }
    }
}

TEST_F(HardEdges, AVertexIsSharedWhileItsNormalIsOne) {
    input.options = {{"uv", "none"}};
    // The faces +x and +z become one smooth piece, as a quarter of a pillar's round.
    for (mesh::CornerNormal& n : mesh.chunks[0].cornerNormals)
        if (n.normal.x + n.normal.z > 0) n.normal = normalized(Vec3f{1, 0, 1});
    const ReadBack r = readBack(written("cube.glb"));
    EXPECT_EQ(r.positions.size(), 22u) << "two of its eight corners are met by both triangles of the piece";
    EXPECT_EQ(distinct(r.normals).size(), 5u);
    EXPECT_EQ(linesOf(contentOf(written("cube.obj")), "vn"), 5u);
}

TEST_F(HardEdges, VerticesKeepTheirOwnNormalsWhereNoCornerHasAnother) {
    input.options = {{"uv", "none"}};
    std::erase_if(mesh.chunks[0].cornerNormals, [](const mesh::CornerNormal& n) { return n.corner >= 3; });
    const ReadBack r = readBack(written("cube.glb"));
    EXPECT_EQ(r.positions.size(), 11u);
    EXPECT_EQ(distinct(r.normals).size(), 9u);
}

TEST_F(HardEdges, ObjHasANormalAndASmoothingGroupAFace) {
    const std::string text = contentOf(written("cube.obj"));
    EXPECT_EQ(linesOf(text, "v"), 8u);
    EXPECT_EQ(linesOf(text, "vn"), 6u);
    EXPECT_EQ(linesOf(text, "f"), 12u);
    for (const char* group : {"s 1", "s 2", "s 3"}) EXPECT_NE(text.find(group + std::string("\n")), std::string::npos);
    EXPECT_EQ(text.find("s 4\n"), std::string::npos);
    for (mesh::Chunk& c : mesh.chunks) c.cornerNormals.clear();
    const std::string smooth = contentOf(written("smooth.obj"));
    EXPECT_EQ(linesOf(smooth, "s"), 1u);
    EXPECT_EQ(linesOf(smooth, "vn"), 8u);
}

TEST_F(HardEdges, UsdKeepsEightPointsAndANormalACorner) {
    const ReadBack r = readBack(written("cube.usda"));
    EXPECT_EQ(r.positions.size(), 8u);
    ASSERT_EQ(r.normals.size(), 36u);
    EXPECT_EQ(distinct(r.normals).size(), 6u);
    EXPECT_NE(contentOf(folder / "cube.usda").find("(interpolation = \"faceVarying\")"), std::string::npos);
    for (size_t t = 0; t < 12; ++t) {
        const mesh::Triangle tri = r.triangles[t];
        const Vec3f a = r.positions[tri.x];
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(r.normals[3 * t + k], normalized(cross(r.positions[tri.y] - a, r.positions[tri.z] - a)));
    }
}

TEST_F(HardEdges, BlenderSeesSharpEdgesOnAClosedMesh) {
    if (std::system("command -v blender > /dev/null && /usr/bin/python3 -c 'import numpy' 2> /dev/null") != 0)
        GTEST_SKIP() << "blender or python3-numpy isn't installed";
    const std::string said = (folder / "said").string();
    ASSERT_EQ(std::system(("blender -b --factory-startup --python tests/cli/importers/blender.py -- " +
                           written("cube.obj").string() + " > " + said + " 2>&1")
                              .c_str()),
              0);
    const std::string facts = contentOf(said);
    EXPECT_NE(facts.find("\"open\": 0,"), std::string::npos) << facts;
    EXPECT_NE(facts.find("\"sharp\": 12,"), std::string::npos) << facts;
}

}  // namespace
}  // namespace sgm::exporter
