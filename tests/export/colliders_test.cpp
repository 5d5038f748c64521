// Colliders in glTF: meshes of their own below the first node, by the names that engines read.
#include "modeler/export/colliders.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "modeler/export/exporter.h"
#include "modeler/mesh/convex_polyhedron.h"
#include "tests/export/hand_made.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::json;

Collider box(Box3d at) {
    Collider collider;
    mesh::ConvexPolyhedron(at).triangulate(collider.positions, collider.triangles);
    return collider;
}

struct Colliding : testing::Test {
    mesh::Mesh mesh = icosphere({0, 0, 0}, 1, 2, 1);
    Provenance provenance = twoMaterials();
    std::vector<Collider> colliders{box({{-1, -1, -1}, {1, 0, 1}}), box({{-.5, 0, -.5}, {.5, 1, .5}})};
    Scratch folder;
    ExportInput input;
    Colliding() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.name = "rock";
        input.colliders = colliders;
    }
    /// The JSON of what is written for an engine; null where that fails.
    Json written(const std::string& engine) {
        input.options = {{"engine", engine}};
        if (!write(input, folder / "a.glb").ok()) return {};
        const std::string bytes = contentOf(folder / "a.glb");
        uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, 4);
        return Json::parse(bytes.substr(20, length));
    }
};

TEST_F(Colliding, NodesBearTheNamesOfTheEngine) {
    const std::map<std::string, std::vector<std::string>> wanted{
        {"godot", {"rock_00-convcolonly", "rock_01-convcolonly"}},
        {"unreal", {"UCX_rock_00", "UCX_rock_01"}},
        {"unity", {"rock_collider_00", "rock_collider_01"}}};
    for (const auto& [engine, names] : wanted) {
        const Json file = written(engine);
        ASSERT_EQ(file["nodes"].size(), 3u);
        EXPECT_EQ(file["nodes"][0]["children"], Json({1, 2}));
        for (size_t i = 0; i < 2; ++i) {
            const Json& node = file["nodes"][i + 1];
            EXPECT_EQ(node["name"], names[i]);
            const Json& primitive = file["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
            EXPECT_FALSE(primitive.contains("material"));
            const Json& position = file["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
            EXPECT_EQ(position["count"], 8) << "a box has eight corners";
            EXPECT_EQ(position["max"], i == 0 ? Json({1.0, 0.0, 1.0}) : Json({0.5, 1.0, 0.5}));
            EXPECT_EQ(file["accessors"][primitive["indices"].get<size_t>()]["count"], 36);
        }
    }
}

TEST_F(Colliding, TrianglesAreNamedSoAndRefusedWhereTheEngineWantsConvexOnes) {
    colliders[1].convex = false;
    EXPECT_EQ(written("godot")["nodes"][2]["name"], "rock_01-colonly");
    std::filesystem::remove(folder / "a.glb");
    EXPECT_TRUE(written("unreal").is_null());
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST_F(Colliding, NothingIsAddedWithoutColliders) {
    ASSERT_FALSE(written("godot").is_null());
    const std::string with = contentOf(folder / "a.glb");
    input.colliders = {};
    const Json without = written("godot");
    EXPECT_EQ(without["nodes"].size(), 1u);
    EXPECT_FALSE(without["nodes"][0].contains("children"));
    EXPECT_LT(contentOf(folder / "a.glb").size(), with.size());
    EXPECT_TRUE(holdsColliders(*findExporter(".gltf")));
    EXPECT_FALSE(holdsColliders(*findExporter(".obj")));
}

}  // namespace
}  // namespace sgm::exporter
