// Levels of detail in files: named meshes beside each other.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "modeler/export/exporter.h"
#include "modeler/mesh/convex_polyhedron.h"
#include "tests/export/hand_made.h"
#include "tests/export/unpack.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::json;

struct Levels : testing::Test {
    mesh::Mesh mesh = icosphere({0, 0, 0}, 1, 3, 2);
    std::vector<mesh::LevelOfDetail> levels{{icosphere({0, 0, 0}, 1, 2, 1), 0.1, 0, 0.5},
                                            {icosphere({0, 0, 0}, 1, 1, 1), 0.2, 0, 0.25}};
    Provenance provenance = twoMaterials();
    std::vector<Collider> colliders{1};
    Scratch folder;
    ExportInput input;
    Levels() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.name = "rock";
        input.extras = {{"seed", "1"}};
        input.levels = levels;
        mesh::ConvexPolyhedron(Box3d{{-1, -1, -1}, {1, 1, 1}})
            .triangulate(colliders[0].positions, colliders[0].triangles);
    }
    std::filesystem::path written(const std::string& name) {
        const Status status = write(input, folder / name);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return folder / name;
    }
};

TEST_F(Levels, GltfHasANodeALevelAndSaysWhichStandsForWhich) {
    input.colliders = colliders;
    const Unpacked file = unpack(written("a.glb"));
    const Json& nodes = file.json["nodes"];
    EXPECT_EQ(nodes[0]["name"], "rock");
    EXPECT_EQ(nodes[0]["extras"], Json({{"seed", "1"}}));
    EXPECT_FALSE(nodes[0].contains("mesh"));
    EXPECT_EQ(file.json["scenes"][0]["nodes"], Json::array({0}));
    std::vector<std::string> names;
    for (const Json& child : nodes[0]["children"]) names.push_back(nodes[child.get<size_t>()]["name"]);
    EXPECT_EQ(names, (std::vector<std::string>{"rock_LOD0", "rock_LOD1", "rock_LOD2", "rock_00-convcolonly"}));
    const Json& finest = nodes[nodes[0]["children"][0].get<size_t>()];
    EXPECT_EQ(finest["extensions"]["MSFT_lod"]["ids"], Json({nodes[0]["children"][1], nodes[0]["children"][2]}));
    EXPECT_EQ(finest["extras"]["MSFT_screencoverage"], Json({0.5, 0.25, 0.0}));
    EXPECT_EQ(file.json["extensionsUsed"], Json({"MSFT_lod"}));
    EXPECT_EQ(file.json["materials"].size(), 2u) << "levels share materials";
    const std::map<std::string, size_t> triangles{{"rock_LOD0", 1280}, {"rock_LOD1", 320}, {"rock_LOD2", 80}};
    for (const UnpackedMesh& mesh : file.meshes)
        if (triangles.contains(mesh.node)) {
            EXPECT_EQ(mesh.data.triangles.size(), triangles.at(mesh.node));
            const auto moss = std::count(mesh.data.materials.begin(), mesh.data.materials.end(), "moss");
            EXPECT_NEAR(static_cast<double>(moss) / static_cast<double>(triangles.at(mesh.node)), 0.47, 0.03);
        }
    EXPECT_EQ(file.meshes.size(), 4u);
}

TEST_F(Levels, OutsideOfTheSceneOnlyTheExtensionReachesThem) {
    input.options = {{"levels", "msft"}};
    const Unpacked file = unpack(written("a.glb"));
    EXPECT_EQ(file.json["nodes"][0]["children"], Json({1}));
    EXPECT_EQ(file.json["nodes"][1]["name"], "rock_LOD0");
    EXPECT_EQ(file.json["nodes"][1]["extensions"]["MSFT_lod"]["ids"], Json({2, 3}));
    EXPECT_EQ(file.json["nodes"][3]["name"], "rock_LOD2");
}

TEST_F(Levels, ObjHasAGroupALevel) {
    const std::string text = contentOf(written("a.obj"));
    std::istringstream lines(text);
    std::string group;
    std::map<std::string, size_t> faces;
    size_t positions = 0, normals = 0, coordinates = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("g ")) group = line.substr(2);
        positions += line.starts_with("v ");
        normals += line.starts_with("vn ");
        coordinates += line.starts_with("vt ");
        if (!line.starts_with("f ")) continue;
        ++faces[group];
        // Each face takes what its own level has written just before.
        std::istringstream corners(line.substr(2));
        for (size_t p = 0, t = 0, n = 0;
             corners >> p && corners.ignore(1) && corners >> t && corners.ignore(1) && corners >> n;) {
            EXPECT_LE(p, positions);
            EXPECT_GT(p + 642, positions);
            EXPECT_LE(t, coordinates);
            EXPECT_LE(n, normals);
            EXPECT_GT(n + 642, normals);
        }
    }
    EXPECT_EQ(faces, (std::map<std::string, size_t>{{"rock_LOD0", 1280}, {"rock_LOD1", 320}, {"rock_LOD2", 80}}));
    EXPECT_NE(text.find("o rock_LOD1\n"), std::string::npos);
    EXPECT_EQ(positions, 642u + 162u + 42u);
    input.levels = {};
    EXPECT_EQ(contentOf(written("b.obj")).find("\ng "), std::string::npos) << "one level needs no group";
}

TEST_F(Levels, UsdHasAVariantALevel) {
    const std::string text = contentOf(written("a.usda"));
    EXPECT_NE(text.find("    variants = {\n        string LOD = \"LOD0\"\n    }\n    prepend variantSets = \"LOD\"\n"),
              std::string::npos);
    size_t at = 0;
    const std::map<std::string, size_t> levels{{"rock_LOD0", 1280}, {"rock_LOD1", 320}, {"rock_LOD2", 80}};
    for (const auto& [name, triangles] : levels) {
        at = text.find("def Xform \"" + name + "\"", at);
        ASSERT_NE(at, std::string::npos) << name;
        const size_t begin = text.find("faceVertexCounts = [", at), end = text.find(']', begin);
        const std::string counts = text.substr(begin, end - begin);
        EXPECT_EQ(static_cast<size_t>(std::count(counts.begin(), counts.end(), '3')), triangles);
    }
    at = text.find("variantSet \"LOD\" = {", at);
    for (size_t chosen = 0; chosen < 3; ++chosen) {
        at = text.find("\"LOD" + std::to_string(chosen) + "\" {", at);
        ASSERT_NE(at, std::string::npos);
        for (size_t level = 0; level < 3; ++level) {
            const std::string over = "over \"rock_LOD" + std::to_string(level) + "\" (\n                active = ";
            const size_t found = text.find(over, at);
            ASSERT_NE(found, std::string::npos);
            EXPECT_EQ(text.substr(found + over.size(), 4), level == chosen ? "true" : "fals");
        }
    }
    EXPECT_LT(at, text.find("def Scope \"Materials\"")) << "materials are those of all variants";
    input.levels = {};
    EXPECT_EQ(contentOf(written("b.usda")).find("LOD"), std::string::npos);
}

TEST_F(Levels, ArePackedToo) {
    for (const char* pack : {"meshopt", "draco"}) {
        input.options = {{"pack", pack}};
        const Unpacked file = unpack(written("a.glb"));
        ASSERT_EQ(file.meshes.size(), 3u);
        EXPECT_EQ(file.meshes[0].node, "rock_LOD0") << "the scale is on the level's own node";
        EXPECT_EQ(file.meshes[2].data.triangles.size(), 80u);
        EXPECT_EQ(file.meshes[0].scale, file.meshes[2].scale) << "one grid";
    }
}

TEST_F(Levels, GltfValidatorFindsNothing) {
    std::string files;
    std::string clean;
    for (const char* place : {"scene", "msft"})
        for (const char* pack : {"none", "meshopt", "draco"}) {
            input.options = {{"levels", place}, {"pack", pack}};
            files += written(std::string(place) + "-" + pack + ".glb").string() + " ";
            clean += "{\"errors\":0,\"warnings\":0,\"messages\":[]}\n";
        }
    const int status = std::system(
        ("node tests/export/validate_gltf.js " + files + "> " + (folder / "verdict").string() + " 2>/dev/null")
            .c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (code == 3 || code == 127)
        GTEST_SKIP() << "gltf-validator isn't installed: npm install --prefix build gltf-validator";
    ASSERT_EQ(code, 0);
    EXPECT_EQ(contentOf(folder / "verdict"), clean);
}

}  // namespace
}  // namespace sgm::exporter
