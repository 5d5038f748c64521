// Packed glTF is what the plain file is: the same triangles over positions rounded to one grid.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>

#include "modeler/export/exporter.h"
#include "modeler/export/gltf_draco.h"
#include "modeler/export/gltf_meshopt.h"
#include "modeler/mesh/convex_polyhedron.h"
#include "tests/export/hand_made.h"
#include "tests/export/unpack.h"
#include "tests/hard_box.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::json;

/// A triangle by its material and its corners' positions in steps, the least first.
using Key = std::tuple<std::string, std::array<std::array<int64_t, 3>, 3>>;
struct Corners {
    std::array<Vec3f, 3> positions, normals;
    std::array<std::array<float, 2>, 3> uvs;
};

std::array<int64_t, 3> stepsOf(Vec3f p, double step) {
    const Vec3d at = p.as<double>() / step;
    return {std::llround(at.x), std::llround(at.y), std::llround(at.z)};
}

std::multimap<Key, Corners> trianglesOf(const ReadBack& mesh, double step) {
    std::multimap<Key, Corners> out;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const mesh::Triangle& t = mesh.triangles[i];
        std::array<std::array<int64_t, 3>, 3> steps;
        for (size_t k = 0; k < 3; ++k) steps[k] = stepsOf(mesh.positions[t[static_cast<int>(k)]], step);
        const auto first = static_cast<size_t>(std::min_element(steps.begin(), steps.end()) - steps.begin());
        Key key{mesh.materials[i], {}};
        Corners corners{};
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = t[static_cast<int>((first + k) % 3)];
            std::get<1>(key)[k] = steps[(first + k) % 3];
            corners.positions[k] = mesh.positions[v];
            corners.normals[k] = mesh.normals[v];
            if (!mesh.uvs.empty()) corners.uvs[k] = mesh.uvs[v];
        }
        out.emplace(key, corners);
    }
    return out;
}

int run(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A ball of two materials beside a box with hard edges, far from the origin.
mesh::Mesh ballAndBox() {
    mesh::Mesh ball = icosphere({100.1f, 0.2f, -30.3f}, 1.7f, 4, 3);
    mesh::Chunk box = hardBox({104, 0, -30}, {{.8, 0, .6}, {0, 1, 0}, {-.6, 0, .8}}, {1, 3, .4}, 1);
    box.block = {9, 0, 0};
    box.firstVertex = static_cast<uint32_t>(ball.vertexCount());
    for (mesh::Chunk& chunk : ball.chunks) chunk.labels.assign(chunk.triangles.size(), 7);
    ball.chunks.push_back(std::move(box));
    return ball;
}

struct Packed : testing::TestWithParam<const char*> {
    mesh::Mesh mesh = ballAndBox();
    Provenance provenance = twoMaterials();
    std::vector<Collider> colliders{1};
    Scratch folder;
    ExportInput input;
    Packed() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.name = "rock";
        input.extras = {{"seed", "1"}};
        mesh::ConvexPolyhedron(Box3d{{-1, -1.3, -1}, {1.1, 0, 1}})
            .triangulate(colliders[0].positions, colliders[0].triangles);
    }
    std::filesystem::path written(const std::string& name, const std::string& pack) {
        input.options["pack"] = pack;
        const Status status = write(input, folder / name);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        return folder / name;
    }
    /// The grid's step by its definition: the least power of two of which the largest extent has at most 65534.
    double step() const {
        return std::exp2(std::ceil(std::log2(static_cast<double>(maxComponent(mesh.bounds().size())) / 65534)));
    }
};

TEST_P(Packed, HoldsTheSameTrianglesOnTheGrid) {
    const Unpacked plain = unpack(written("plain.glb", "none")), packed = unpack(written("packed.glb", GetParam()));
    ASSERT_EQ(packed.meshes.size(), 1u);
    EXPECT_EQ(packed.meshes[0].node, "rock");
    EXPECT_EQ(packed.json["nodes"][0]["extras"], Json({{"seed", "1"}}));
    const double grid = step();
    EXPECT_LE(grid, 2 * static_cast<double>(maxComponent(mesh.bounds().size())) / 65534);
    const auto before = trianglesOf(plain.meshes[0].data, grid), after = trianglesOf(packed.meshes[0].data, grid);
    ASSERT_EQ(before.size(), 20u * 256u + 12u);
    ASSERT_EQ(after.size(), before.size());
    double worst = 0, turned = 1, slid = 0;
    for (auto a = before.begin(), b = after.begin(); a != before.end(); ++a, ++b) {
        ASSERT_EQ(a->first, b->first);
        for (size_t k = 0; k < 3; ++k) {
            const auto& [p, n, uv] = a->second;
            const Vec3d off = p[k].as<double>() - b->second.positions[k].as<double>();
            worst = std::max({worst, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
            turned = std::min(turned, static_cast<double>(dot(n[k], b->second.normals[k])));
            for (size_t i = 0; i < 2; ++i)
                slid =
                    std::max(slid, std::abs(static_cast<double>(uv[k][i]) - static_cast<double>(b->second.uvs[k][i])));
        }
        // Rounded to the grid and no farther: exact, so that primitives meet.
        for (const Vec3f& p : b->second.positions)
            for (int axis = 0; axis < 3; ++axis) {
                const double steps = static_cast<double>(p[axis]) / grid;
                ASSERT_EQ(steps, std::round(steps));
            }
    }
    EXPECT_LE(worst, grid / 2);
    EXPECT_GT(worst, 0) << "nothing was rounded";
    EXPECT_GT(turned, std::cos(0.02)) << "normals are off by more than 1.1 degrees";
    EXPECT_LE(slid, 140.0 / 65534) << "texture coordinates lie within 140 m";
}

TEST_P(Packed, IsSmallerAndDeterministic) {
    const auto plain = written("plain.glb", "none"), packed = written("a.glb", GetParam()),
               again = written("b.glb", GetParam());
    EXPECT_EQ(contentOf(packed), contentOf(again));
    EXPECT_LT(contentOf(packed).size(), contentOf(plain).size() / 3);
}

TEST_P(Packed, LeavesCollidersExact) {
    input.colliders = colliders;
    const Unpacked packed = unpack(written("packed.glb", GetParam()));
    ASSERT_EQ(packed.meshes.size(), 2u);
    const auto collider = std::find_if(packed.meshes.begin(), packed.meshes.end(),
                                       [](const UnpackedMesh& m) { return m.node == "rock_00-convcolonly"; });
    ASSERT_NE(collider, packed.meshes.end());
    EXPECT_EQ(collider->data.positions, colliders[0].positions);
    EXPECT_EQ(collider->data.triangles, colliders[0].triangles);
    EXPECT_EQ(collider->scale, 1) << "physics takes no scaled shapes";
    EXPECT_EQ(packed.json["nodes"][0]["name"], "rock");
}

/// One triangle of a corner and colours, below three nodes: as it is, moved and larger, turned by 90° about y.
tinygltf::Model threeColoredTriangles() {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.buffers.emplace_back();
    const auto add = [&](const auto& values, size_t count, int type, int componentType, bool normalized = false) {
        auto& data = model.buffers[0].data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = sizeof values;
        data.resize(data.size() + sizeof values);
        std::memcpy(data.data() + view.byteOffset, &values, sizeof values);
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model.bufferViews.size());
        accessor.count = count;
        accessor.type = type;
        accessor.componentType = componentType;
        accessor.normalized = normalized;
        model.bufferViews.push_back(view);
        model.accessors.push_back(accessor);
        return static_cast<int>(model.accessors.size()) - 1;
    };
    const Vec3f positions[] = {{1, 0, 0}, {3, 0, 0}, {1, 2, 0}}, normals[] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const uint16_t colors[][4] = {{65535, 0, 0, 65535}, {0, 257, 514, 65535}, {1, 2, 3, 4}};
    const uint32_t corners[] = {0, 1, 2};
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes = {
        {"POSITION", add(positions, 3, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT)},
        {"NORMAL", add(normals, 3, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT)},
        {"COLOR_0", add(colors, 3, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, true)}};
    primitive.indices = add(corners, 3, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    model.meshes.emplace_back();
    model.meshes[0].name = "mesh";
    model.meshes[0].primitives = {primitive};
    model.nodes.resize(3);
    for (tinygltf::Node& node : model.nodes) node.mesh = 0;
    model.nodes[1].translation = {10, 0, 0};
    model.nodes[1].scale = {2, 2, 2};
    model.nodes[2].rotation = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};
    model.scenes.emplace_back();
    model.scenes[0].nodes = {0, 1, 2};
    model.defaultScene = 0;
    return model;
}

TEST_P(Packed, KeepsInstancesAndOtherAttributes) {
    tinygltf::Model model = threeColoredTriangles();
    {
        std::ofstream out(folder / "a.glb", std::ios::binary);
        if (std::string(GetParam()) == "meshopt") {
            auto packed = packByMeshopt(std::move(model), nullptr);
            ASSERT_TRUE(packed.ok());
            writeMeshopt(*packed, out, true);
        } else {
            ASSERT_TRUE(packByDraco(model, nullptr).ok());
            tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true);
        }
    }
    const Unpacked packed = unpack(folder / "a.glb");
    ASSERT_EQ(packed.meshes.size(), 3u);
    const std::array<double, 4> red{1, 0, 0, 1}, blue{0, 257 / 65535.0, 514 / 65535.0, 1};
    for (const UnpackedMesh& mesh : packed.meshes) {
        ASSERT_EQ(mesh.colors.size(), 3u);
        for (const auto& color : {red, blue}) EXPECT_EQ(std::count(mesh.colors.begin(), mesh.colors.end(), color), 1);
        const size_t corner =
            static_cast<size_t>(std::find(mesh.colors.begin(), mesh.colors.end(), red) - mesh.colors.begin());
        const Vec3f at = mesh.data.positions[corner];
        if (at.x == 12)
            EXPECT_EQ(at, (Vec3f{12, 0, 0}));
        else if (at.x == 1)
            EXPECT_EQ(at, (Vec3f{1, 0, 0}));
        else
            EXPECT_LT(length(at - Vec3f{0, 0, -1}), 1e-6f);
    }
}

TEST_P(Packed, GltfValidatorFindsNothing) {
    const auto a = written("a.glb", GetParam()), json = written("a.gltf", GetParam());
    input.colliders = colliders;
    const auto b = written("b.glb", GetParam());
    const int code = run("node tests/export/validate_gltf.js " + a.string() + " " + json.string() + " " + b.string() +
                         " > " + (folder / "verdict").string() + " 2>/dev/null");
    if (code == 3 || code == 127)
        GTEST_SKIP() << "gltf-validator isn't installed: npm install --prefix build gltf-validator";
    ASSERT_EQ(code, 0);
    const std::string clean = "{\"errors\":0,\"warnings\":0,\"messages\":[]}\n";
    EXPECT_EQ(contentOf(folder / "verdict"), clean + clean + clean);
}

TEST_P(Packed, ThreeLoadsIt) {
    const auto plain = written("plain.glb", "none"), packed = written("packed.glb", GetParam());
    const int code = run("node tests/export/three_gltf.mjs " + plain.string() + " " + packed.string() + " > " +
                         (folder / "facts").string() + " 2> " + (folder / "errors").string());
    if (code == 3 || code == 127) GTEST_SKIP() << "three isn't installed: npm install --prefix build three";
    ASSERT_EQ(code, 0) << contentOf(folder / "errors");
    std::istringstream lines(contentOf(folder / "facts"));
    std::string first, second;
    std::getline(lines, first), std::getline(lines, second);
    const Json before = Json::parse(first), after = Json::parse(second);
    EXPECT_EQ(before["triangles"], 5132);
    EXPECT_EQ(after["triangles"], before["triangles"]);
    EXPECT_EQ(after["materials"], before["materials"]);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(after["box"][i].get<double>(), before["box"][i].get<double>(), step()) << i;
    EXPECT_NEAR(after["volume"].get<double>(), before["volume"].get<double>(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(By, Packed, testing::Values("meshopt", "draco"),
                         [](const auto& by) { return std::string(by.param); });

}  // namespace
}  // namespace sgm::exporter
