// Objects that are alike and touch nothing show one surface.
#include "modeler/export/shared_objects.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstdlib>
#include <numeric>
#include <set>

#include "modeler/export/exporter.h"
#include "tests/export/made_part.h"
#include "tests/hard_box.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

/// A street of houses, each a wall with two flags: three boxes that touch nothing.
struct Street : testing::Test {
    mesh::Mesh mesh;
    ObjectTree tree;
    Provenance provenance;
    ExportInput input;
    Scratch folder;

    Street() {
        provenance.materials = {{"stone", {.5f, .5f, .5f}, .8f, 0, nullptr}};
        tree.nodes.push_back({"street", 0, "Street", "Street", "", "a.sgm", 1, {}});
        tree.ofOrigin = {0};
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.objects = &tree;
        input.name = "street";
    }
    uint32_t node(const std::string& symbol, uint32_t parent, uint64_t likeness, Vec3d centre) {
        ObjectNode n;
        n.name = symbol + "_" + std::to_string(tree.nodes.size());
        n.parent = parent, n.symbol = symbol, n.likeness = likeness, n.centre = centre;
        tree.nodes.push_back(n);
        return static_cast<uint32_t>(tree.nodes.size() - 1);
    }
    /// A box of the node; its chunk.
    mesh::Chunk box(uint32_t node, Vec3d half) {
        tree.ofOrigin.push_back(node);
        provenance.parts.push_back(madePart(tree.nodes[node].name + "/box", {"box", "grow", "a.sgm", 3}, 0));
        return hardBox(tree.nodes[node].centre, {}, half, static_cast<OriginId>(provenance.parts.size() - 1));
    }
    void addHouse(std::vector<mesh::Chunk>& chunks, double x, double halfHeight = 1) {
        const uint32_t house = node("House", 0, 7, {x, 0, 0});
        chunks.push_back(box(house, {1, halfHeight, 1}));
        for (const double z : {-3.0, 3.0}) chunks.push_back(box(node("Flag", house, 9, {x, 2, z}), {.1, .2, .3}));
    }
    std::filesystem::path written(const std::string& name) {
        const auto path = folder / name;
        const Status status = write(input, path);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return path;
    }
};

TEST_F(Street, HousesShowTheFirstOneAndItsFlagsTheFirstFlag) {
    std::vector<mesh::Chunk> chunks;
    for (const double x : {0.0, 10.0, 25.5}) addHouse(chunks, x);
    mesh = meshOfChunks(chunks);
    const SharedObjects shared = shareObjects(mesh, tree);
    EXPECT_EQ(shared.of, (std::vector<uint32_t>{0, 1, 2, 2, 1, 2, 2, 1, 2, 2}));
    EXPECT_EQ(shared.moved[3], (Vec3d{0, 0, 6})) << "the second flag of the first house";
    EXPECT_EQ(shared.moved[4], (Vec3d{10, 0, 0}));
    EXPECT_EQ(shared.moved[5], Vec3d{}) << "a flag goes with its house";
    EXPECT_EQ(shared.moved[6], (Vec3d{0, 0, 6}));
    EXPECT_TRUE(shared.isTop(tree, 3) && shared.isTop(tree, 4) && !shared.isTop(tree, 6));
    ASSERT_TRUE(shared.mesh);
    EXPECT_EQ(shared.mesh->triangleCount(), 24u);
    EXPECT_EQ(shared.mesh->vertexCount(), 16u);
    EXPECT_EQ(shared.mesh->chunks[0].cornerNormals.size(), 72u);
}

TEST_F(Street, WhatTouchesOrDiffersKeepsItsOwnSurface) {
    std::vector<mesh::Chunk> chunks;
    addHouse(chunks, 0);
    addHouse(chunks, 10, 1.5);  // as if something outside had changed it
    addHouse(chunks, 20);
    // The third house's wall hangs together with the ground: a triangle of the root uses its vertices.
    chunks.push_back(chunks[6]);
    mesh = meshOfChunks(chunks);
    mesh::Chunk& ground = mesh.chunks[9];
    const uint32_t wall = mesh.chunks[6].firstVertex;
    ground.ghosts.vertices.clear();
    for (uint32_t v = 0; v < 8; ++v) ground.ghosts.vertices.push_back(wall + v);
    ground.positions.clear(), ground.normals.clear();
    for (mesh::Triangle& t : ground.triangles) t = {t.x | mesh::ghostBit, t.y | mesh::ghostBit, t.z | mesh::ghostBit};
    std::fill(ground.origins.begin(), ground.origins.end(), 0u);
    const SharedObjects shared = shareObjects(mesh, tree);
    EXPECT_EQ(shared.of, (std::vector<uint32_t>{0, 1, 2, 2, 4, 2, 2, 7, 2, 2})) << "their flags are free";
}

TEST_F(Street, NothingIsSharedWhereNothingIsAlike) {
    std::vector<mesh::Chunk> chunks;
    addHouse(chunks, 0);
    for (ObjectNode& n : tree.nodes) n.likeness = 0;
    mesh = meshOfChunks(chunks);
    const SharedObjects shared = shareObjects(mesh, tree);
    EXPECT_FALSE(shared.mesh);
}

TEST_F(Street, PlacesAreAllInTheSceneOfGltf) {
    mesh::Scene scene;
    scene.ground = provenance;
    std::vector<mesh::Chunk> chunks;
    for (const char* name : {"House", "Shed"}) {
        mesh::SceneObject object;
        object.name = name;
        object.provenance.materials = provenance.materials;
        object.provenance.parts.push_back(madePart(name, {"box", "grow", "a.sgm", 3}, 0));
        chunks.assign(1, hardBox({}, {}, {1, 1, 1}, 0));
        object.mesh = meshOfChunks(chunks);
        scene.objects.push_back(std::move(object));
    }
    for (int i = 0; i < 10; ++i) {
        mesh::Instance instance;
        instance.object = static_cast<uint32_t>(i % 2);
        instance.part = madePart("place", {"box", "grow", "a.sgm", 3}, 0);
        instance.part.pose.origin = {6. * i, 0, 0};
        scene.instances.push_back(instance);
    }
    input.objects = nullptr;
    input.scene = &scene;
    for (const std::string_view places : {"nodes", "gpu"}) {
        input.options = {{"places", std::string(places)}};
        tinygltf::Model model;
        std::string error, warning;
        ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, written("a.glb").string()))
            << error;
        ASSERT_EQ(model.nodes.size(), places == "gpu" ? 3u : 11u);
        std::vector<int> all(model.nodes.size() - 1);
        std::iota(all.begin(), all.end(), 1);
        EXPECT_EQ(model.nodes[0].children, all) << places;
        std::set<std::string> names;
        for (const tinygltf::Node& node : model.nodes) names.insert(node.name);
        EXPECT_EQ(names.size(), model.nodes.size()) << places;
        EXPECT_TRUE(names.contains("House") && names.contains("Shed")) << places;
        EXPECT_EQ(names.contains("House_5"), places == "nodes");
        EXPECT_EQ(model.meshes.size(), 2u) << "places share them";
        for (const tinygltf::BufferView& view : model.bufferViews) EXPECT_GT(view.byteLength, 0u);
    }
}

TEST_F(Street, NodesOfGltfShareMeshes) {
    std::vector<mesh::Chunk> chunks;
    for (const double x : {0.0, 10.0, 25.5}) addHouse(chunks, x);
    mesh = meshOfChunks(chunks);
    tinygltf::Model model;
    std::string error, warning;
    ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, written("a.glb").string())) << error;
    ASSERT_EQ(model.nodes.size(), 10u);
    EXPECT_EQ(model.meshes.size(), 2u);
    EXPECT_EQ(model.nodes[7].mesh, model.nodes[1].mesh);
    EXPECT_EQ(model.nodes[7].translation, (std::vector<double>{25.5, 0, 0}));
    EXPECT_TRUE(model.nodes[8].translation.empty());
    EXPECT_EQ(model.nodes[9].translation, (std::vector<double>{0, 0, 6}));
    const tinygltf::Value& origins = model.nodes[9].extras.Get("origins");
    ASSERT_EQ(origins.ArrayLen(), 2u);
    EXPECT_EQ(origins.Get(0).GetNumberAsInt(), 2) << "of the first house's first flag";
    EXPECT_EQ(origins.Get(1).GetNumberAsInt(), 9);
    EXPECT_EQ(model.asset.extras.Get("origins").Get("id").ArrayLen(), 9u) << "the table has those of all houses";
    input.options = {{"instances", "no"}};
    tinygltf::Model apart;
    ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&apart, &error, &warning, written("b.glb").string())) << error;
    EXPECT_EQ(apart.meshes.size(), 9u);
    for (const tinygltf::Node& node : apart.nodes) EXPECT_TRUE(node.translation.empty());
}

TEST_F(Street, UsdRefersToThePrimThatIsShown) {
    std::vector<mesh::Chunk> chunks;
    for (const double x : {0.0, 10.0, 25.5}) addHouse(chunks, x);
    mesh = meshOfChunks(chunks);
    EXPECT_EQ(contentOf(written("own.usda")).find("references"), std::string::npos);
    input.options = {{"up", "z"}, {"unit", "cm"}, {"instances", "yes"}};
    const std::string text = contentOf(written("a.usda"));
    const auto count = [&](const std::string& what) {
        size_t n = 0;
        for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count("def Mesh"), 2u);
    EXPECT_EQ(count("instanceable = true"), 3u);
    EXPECT_EQ(count("prepend references = </street/House_1>"), 2u);
    EXPECT_EQ(count("prepend references = </street/House_1/Flag_2>"), 1u);
    EXPECT_NE(text.find("double3 xformOp:translate = (2550, -0, 0)"), std::string::npos);
    EXPECT_NE(text.find("double3 xformOp:translate = (0, -600, 0)"), std::string::npos);
    EXPECT_EQ(count("{"), count("}"));
}

TEST_F(Street, OtherProgramsSeeTheWholeStreet) {
    std::vector<mesh::Chunk> chunks;
    for (const double x : {0.0, 10.0, 25.5}) addHouse(chunks, x);
    mesh = meshOfChunks(chunks);
    const std::string glb = written("street.glb").string(), said = (folder / "said").string();
    const int valid = std::system(("node tests/export/validate_gltf.js " + glb + " > " + said).c_str());
    if (WEXITSTATUS(valid) == 0) {
        EXPECT_EQ(contentOf(said), "{\"errors\":0,\"warnings\":0,\"messages\":[]}\n");
    }
    const int code = std::system(("node tests/export/load_three.mjs " + glb + " > " + said + " 2>&1").c_str());
    if (WEXITSTATUS(code) == 3 || WEXITSTATUS(code) == 127)
        GTEST_SKIP() << "three isn't installed: npm install --prefix build three";
    EXPECT_EQ(contentOf(said),
              "street.glb street (House_1 12 (Flag_2 12, Flag_3 12), House_4 12 (Flag_5 12, Flag_6 12), "
              "House_7 12 (Flag_8 12, Flag_9 12)) {\"stone\":108} size 27.5 3.2 6.6\n");
}

}  // namespace
}  // namespace sgm::exporter
