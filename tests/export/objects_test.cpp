// Files divided into objects: the tree, whose triangles are whose, and that nothing is lost between them.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstdlib>
#include <cstring>
#include <set>

#include "modeler/export/exporter.h"
#include "tests/export/made_part.h"
#include "tests/hard_box.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

/// A house with a group of two windows, a third window that shows nowhere, and a door: four boxes of origins 1 … 4.
struct House : testing::Test {
    mesh::Mesh mesh;
    Provenance provenance;
    ObjectTree tree;
    ExportInput input;
    Scratch folder;

    House() {
        provenance.materials = {{"stone", {.5f, .5f, .5f}, .8f, 0, nullptr},
                                {"glass", {.1f, .3f, .5f}, .1f, 0, nullptr}};
        provenance.parts = {Part{}};
        const std::pair<const char*, uint32_t> parts[] = {
            {"House/wall", 0}, {"House/Wing/Window", 1}, {"House/Wing/Window[2]", 1}, {"House/Door", 0}};
        for (const auto& [path, material] : parts)
            provenance.parts.push_back(madePart(path, {"box", "grow", "a.sgm", 7}, material));
        const auto node = [&](const char* name, uint32_t parent) {
            tree.nodes.push_back({name, parent, "House/…", name, "grow", "a.sgm", 5, {{"size", Vec3d{1, 2, 3}}}});
        };
        node("House", 0), node("Wing", 0), node("Window", 1), node("Window_2", 1), node("Window_3", 1), node("Door", 0);
        tree.nodes[2].values.emplace_back("with n", 3.0);
        tree.nodes[2].values.emplace_back("with kind", std::string("a \"b\""));
        tree.ofOrigin = {0, 0, 2, 3, 5};
        std::vector<mesh::Chunk> chunks;
        for (uint32_t origin = 1; origin <= 4; ++origin)
            chunks.push_back(hardBox({3.0 * origin, 0, 0}, {}, {1, 1, 1}, origin));
        mesh = meshOfChunks(std::move(chunks));
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.objects = &tree;
        input.name = "house";
        input.extras = {{"seed", "1"}};
    }
    std::filesystem::path written(const std::string& name) {
        const auto path = folder / name;
        const Status status = write(input, path);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return path;
    }
    tinygltf::Model gltf(const std::string& name) {
        tinygltf::Model model;
        std::string error, warning;
        EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, written(name).string())) << error;
        EXPECT_EQ(error + warning, "");
        return model;
    }
};

size_t trianglesOf(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    return model.accessors[static_cast<size_t>(primitive.indices)].count / 3;
}

/// Name of each node with those below it in brackets.
std::string outline(const tinygltf::Model& model, int index) {
    const tinygltf::Node& node = model.nodes[static_cast<size_t>(index)];
    std::string text = node.name;
    if (node.mesh >= 0) {
        size_t triangles = 0;
        for (const auto& p : model.meshes[static_cast<size_t>(node.mesh)].primitives)
            triangles += trianglesOf(model, p);
        text += " " + std::to_string(triangles);
    }
    if (node.children.empty()) return text;
    text += " (";
    for (const int child : node.children) text += (child == node.children[0] ? "" : ", ") + outline(model, child);
    return text + ")";
}

TEST_F(House, NodesOfGltfMirrorTheTreeOfWhatShows) {
    const tinygltf::Model model = gltf("house.glb");
    EXPECT_EQ(outline(model, model.scenes[0].nodes[0]), "house 12 (Wing (Window 12, Window_2 12), Door 12)");
    EXPECT_EQ(model.meshes[1].name, "Window");
    EXPECT_EQ(model.materials.size(), 2u) << "objects share materials";
    const tinygltf::Value& extras = model.nodes[2].extras;
    EXPECT_EQ(extras.Get("rule").Get<std::string>(), "grow");
    EXPECT_EQ(extras.Get("line").GetNumberAsInt(), 5);
    EXPECT_EQ(extras.Get("size").Get(1).GetNumberAsDouble(), 2);
    EXPECT_EQ(extras.Get("with n").GetNumberAsDouble(), 3);
    EXPECT_EQ(extras.Get("with kind").Get<std::string>(), "a \"b\"");
    EXPECT_EQ(model.nodes[0].extras.Get("seed").Get<std::string>(), "1");
}

TEST_F(House, OriginsOfGltfAreNamedByNumber) {
    const tinygltf::Model model = gltf("house.glb");
    const tinygltf::Value& table = model.asset.extras.Get("origins");
    ASSERT_EQ(table.Get("id").ArrayLen(), 4u);
    EXPECT_EQ(table.Get("id").Get(2).GetNumberAsInt(), 3);
    EXPECT_EQ(table.Get("path").Get(2).Get<std::string>(), "House/Wing/Window[2]");
    EXPECT_EQ(table.Get("rule").Get(2).Get<std::string>(), "grow");
    EXPECT_EQ(table.Get("file").Get(2).Get<std::string>(), "a.sgm");
    EXPECT_EQ(table.Get("line").Get(2).GetNumberAsInt(), 7);
    const tinygltf::Value& runs = model.meshes[2].primitives[0].extras.Get("origins");
    ASSERT_EQ(runs.ArrayLen(), 2u);
    EXPECT_EQ(runs.Get(0).GetNumberAsInt(), 3);
    EXPECT_EQ(runs.Get(1).GetNumberAsInt(), 12);
}

TEST_F(House, RunsOfOriginsCoverAPrimitiveInOrder) {
    input.objects = nullptr;
    const tinygltf::Model model = gltf("house.glb");
    ASSERT_EQ(model.meshes.size(), 1u);
    ASSERT_EQ(model.meshes[0].primitives.size(), 2u) << "one a material";
    const tinygltf::Value& runs = model.meshes[0].primitives[0].extras.Get("origins");
    EXPECT_EQ(runs.Get(0).GetNumberAsInt(), 1);
    EXPECT_EQ(runs.Get(2).GetNumberAsInt(), 4);
    EXPECT_EQ(runs.Get(1).GetNumberAsInt() + runs.Get(3).GetNumberAsInt(), 24);
}

TEST_F(House, OnePieceHasItsColoursAlone) {
    input.objects = nullptr;
    input.byMaterial = false;
    const tinygltf::Model model = gltf("house.glb");
    ASSERT_EQ(model.meshes[0].primitives.size(), 1u);
    const tinygltf::Primitive& all = model.meshes[0].primitives[0];
    EXPECT_EQ(trianglesOf(model, all), 48u);
    const tinygltf::Accessor& color = model.accessors[static_cast<size_t>(all.attributes.at("COLOR_0"))];
    EXPECT_TRUE(color.normalized);
    const auto& view = model.bufferViews[static_cast<size_t>(color.bufferView)];
    std::set<std::array<uint16_t, 4>> colors;
    for (size_t i = 0; i < color.count; ++i) {
        std::array<uint16_t, 4> c;
        std::memcpy(&c, model.buffers[0].data.data() + view.byteOffset + i * sizeof c, sizeof c);
        colors.insert(c);
    }
    EXPECT_EQ(colors, (std::set<std::array<uint16_t, 4>>{{6554, 19661, 32768, 65535}, {32768, 32768, 32768, 65535}}));
    const std::string obj = contentOf(written("house.obj")), usd = contentOf(written("house.usda"));
    EXPECT_EQ(obj.find("usemtl"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "house.mtl"));
    EXPECT_EQ(usd.find("Material"), std::string::npos);
    EXPECT_NE(usd.find("displayColor = [(0.5, 0.5, 0.5), (0.1, 0.3, 0.5)]"), std::string::npos);
}

TEST_F(House, ObjNamesObjectsAndKeepsPositionsShared) {
    // The door's box begins with the wall's eight vertices: one solid of two objects.
    mesh::Chunk& door = mesh.chunks[3];
    door.ghosts.vertices = {0, 1, 2, 3, 4, 5, 6, 7};
    door.positions.clear(), door.normals.clear();
    for (mesh::Triangle& t : door.triangles)
        for (int k = 0; k < 3; ++k) t[k] |= mesh::ghostBit;
    const std::string text = contentOf(written("house.obj"));
    size_t at = 0;
    for (const char* line :
         {"# origin 3: House/Wing/Window[2], rule grow, a.sgm:7\n", "o house\n", "usemtl stone\n", "# origin 1\n",
          "# shape House/…, rule grow, a.sgm:5\n", "o Window\n", "usemtl glass\n", "# origin 2\n", "o Window_2\n",
          "# origin 3\n", "o Door\n", "usemtl stone\n", "# origin 4\n"}) {
        at = text.find(line, at);
        ASSERT_NE(at, std::string::npos) << line;
    }
    size_t positions = 0;
    for (size_t i = text.find("\nv "); i != std::string::npos; i = text.find("\nv ", i + 1)) ++positions;
    EXPECT_EQ(positions, 24u);
    EXPECT_NE(text.find("\nf 1/"), text.rfind("\nf 1/")) << "a face of either object begins at the first position";
}

TEST_F(House, UsdNestsObjectsWithTheirPoints) {
    const std::string text = contentOf(written("house.usda"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
    std::string prims;
    for (size_t at = text.find("\ndef "); at != std::string::npos; at = text.find("\ndef ", at + 1)) {
        const size_t open = text.find('"', at), close = text.find('"', open + 1);
        prims += text.substr(open + 1, close - open - 1) + " ";
    }
    EXPECT_EQ(prims, "house Surface Wing Window Surface Window_2 Surface Door Surface ");
    EXPECT_NE(text.find("string[] path = [\"House/wall\", "), std::string::npos);
    EXPECT_NE(text.find("double3 \"size\" = (1, 2, 3)"), std::string::npos);
    EXPECT_NE(text.find("string \"with kind\" = \"a \\\"b\\\"\""), std::string::npos);
    size_t points = 0;
    for (size_t at = text.find("point3f[] points"); at != std::string::npos;
         at = text.find("point3f[] points", at + 1)) {
        const size_t end = text.find(']', at + 17);
        points += static_cast<size_t>(
            std::count(text.begin() + static_cast<long>(at), text.begin() + static_cast<long>(end), '('));
    }
    EXPECT_EQ(points, 32u) << "each prim has its own eight points";
    EXPECT_NE(text.find("int[] primvars:origin = [3, 3,"), std::string::npos);
}

TEST_F(House, PlyTellsTheTableInItsHeader) {
    const std::string text = contentOf(written("house.ply"));
    EXPECT_NE(text.find("comment origin 4: House/Door, rule grow, a.sgm:7\n"), std::string::npos);
    input.options = {{"attributes", "none"}};
    EXPECT_EQ(contentOf(written("bare.ply")).find("comment origin"), std::string::npos);
}

TEST_F(House, UnrealsCollidersWantOneMesh) {
    Collider box;
    box.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    box.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    input.colliders = {&box, 1};
    const tinygltf::Model model = gltf("house.glb");
    EXPECT_EQ(outline(model, 0), "house 12 (Wing (Window 12, Window_2 12), Door 12, house_00-convcolonly 4)");
    input.options = {{"engine", "unreal"}};
    EXPECT_EQ(write(input, folder / "b.glb").error().kind, Error::Kind::Usage);
}

TEST_F(House, OtherProgramsReadTheTree) {
    const std::string said = (folder / "said").string();
    const int code = std::system(("node tests/export/load_three.mjs " + written("house.glb").string() + " " +
                                  written("house.usda").string() + " > " + said + " 2>&1")
                                     .c_str());
    if (WEXITSTATUS(code) == 3 || WEXITSTATUS(code) == 127)
        GTEST_SKIP() << "three isn't installed: npm install --prefix build three";
    ASSERT_EQ(code, 0) << contentOf(said);
    EXPECT_EQ(contentOf(said),
              "house.glb house 12 (Wing (Window 12, Window_2 12), Door 12) {\"stone\":24,\"glass\":24} size 11 2 2\n"
              "house.usda house 12 (Wing (Window 12, Window_2 12), Door 12) {\"0.50 0.50 0.50\":24,\"0.10 0.30 "
              "0.50\":24} size 11 2 2\n");
}

}  // namespace
}  // namespace sgm::exporter
