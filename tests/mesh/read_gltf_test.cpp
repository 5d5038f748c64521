// glTF from anybody: what it holds stands where its nodes put it, and a file that lies is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "modeler/mesh/distances.h"
#include "modeler/mesh/read.h"
#include "tests/fuzz_keys.h"
#include "tests/scratch.h"

namespace sgm::mesh {
namespace {

using Json = nlohmann::json;

template <class T>
void put(std::string& out, std::initializer_list<T> values) {
    for (const T value : values) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        out.append(bytes, sizeof value);
    }
}

/// A pyramid of 1 m: five corners in 60 bytes, and 18 numbers of 16 bits.
std::string pyramidBytes() {
    std::string out;
    put<float>(out, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, .5f, .5f, 1});
    put<uint16_t>(out, {3, 2, 1, 3, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4});
    return out;
}

Json pyramid() {
    return Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 18, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 60}, {"buffer": 0, "byteOffset": 60, "byteLength": 36}],
        "buffers": [{"byteLength": 96}]})");
}

std::string glb(const Json& json, std::string binary = pyramidBytes()) {
    std::string text = json.dump(), out;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    put<uint32_t>(out, {0x46546C67, 2, static_cast<uint32_t>(28 + text.size() + binary.size())});
    put<uint32_t>(out, {static_cast<uint32_t>(text.size()), 0x4E4F534A});
    out += text;
    put<uint32_t>(out, {static_cast<uint32_t>(binary.size()), 0x004E4942});
    return out + binary;
}

class ReadGltf : public testing::Test {
protected:
    Result<TriangleSoup> read(const std::string& name, const std::string& bytes) {
        return readMesh(scratch_.write(name, bytes));
    }
    /// What is said of a pyramid whose JSON has been changed; "" where it can be read.
    std::string refusal(const std::string& place, const Json& value) {
        Json json = pyramid();
        json[Json::json_pointer(place)] = value;
        const auto mesh = read("a.glb", glb(json));
        return mesh.ok() ? "" : mesh.error().message;
    }
    void expectPyramid(const std::string& name, const std::string& bytes, const Box3d& box = {{0, 0, 0}, {1, 1, 1}}) {
        const auto mesh = read(name, bytes);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        EXPECT_EQ(mesh->triangles.size(), 6u) << name;
        EXPECT_EQ(mesh->bounds(), box) << name;
        EXPECT_TRUE(toDistances(*mesh, 20).ok()) << name << ": closed, and not inside out";
    }
    Scratch scratch_;
};

TEST_F(ReadGltf, WithBuffersInItAndBesideIt) {
    expectPyramid("a.glb", glb(pyramid()));
    Json json = pyramid();
    json["buffers"][0]["uri"] =
        "data:application/"
        "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAPwAAAD8A"
        "AIA/AwACAAEAAwABAAAAAAABAAQAAQACAAQAAgADAAQAAwAAAAQA";
    expectPyramid("b.gltf", json.dump());
    scratch_.write("my bytes.bin", pyramidBytes());
    json["buffers"][0]["uri"] = "my%20bytes.bin";
    std::vector<std::filesystem::path> named;
    EXPECT_TRUE(readMesh(scratch_.write("c.gltf", json.dump()), nullptr, &named).ok());
    ASSERT_EQ(named.size(), 1u);
    EXPECT_EQ(named[0].filename(), "my bytes.bin");
}

TEST_F(ReadGltf, WhereItsNodesPutIt) {
    Json json = pyramid();
    json["nodes"] = Json::parse(R"([{"children": [1], "translation": [10, 0, 0]},
        {"mesh": 0, "scale": [2, 1, 1], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}])");
    const auto turned = read("turned.glb", glb(json));
    ASSERT_TRUE(turned.ok()) << turned.error().message;
    const Box3d box = turned->bounds();  // a quarter turn about z: x goes to y, y to -x
    EXPECT_NEAR(box.lo.x, 9, 1e-9);
    EXPECT_NEAR(box.hi.x, 10, 1e-9);
    EXPECT_NEAR(box.hi.y, 2, 1e-9);
    json["nodes"] = Json::parse(R"([{"mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]}])");
    expectPyramid("mirrored.glb", glb(json), {{4, 0, 0}, {5, 1, 1}});
    json["nodes"] = Json::parse(R"([{"mesh": 0}])");
    json["scenes"] = Json::parse(R"([{"nodes": []}, {"nodes": [0]}])");
    json["scene"] = 1;
    expectPyramid("second.glb", glb(json));
}

TEST_F(ReadGltf, OfEveryKindOfNumbersAndLists) {
    std::string bytes;
    put<int16_t>(bytes, {0, 0, 0, 99, 32767, 0, 0, 99, 32767, 32767, 0, 99, 0, 32767, 0, 99, 16384, 16384, 32767, 99});
    for (const unsigned char v : {3, 2, 1, 3, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}) bytes += static_cast<char>(v);
    Json json = pyramid();
    json["extensionsRequired"] = {"KHR_mesh_quantization"};
    json["accessors"][0]["componentType"] = 5122;
    json["accessors"][0]["normalized"] = true;
    json["accessors"][1]["componentType"] = 5121;
    json["bufferViews"] = Json::parse(R"([{"buffer": 0, "byteLength": 40, "byteStride": 8},
                                          {"buffer": 0, "byteOffset": 40, "byteLength": 18}])");
    json["buffers"][0]["byteLength"] = 58;
    expectPyramid("short.glb", glb(json, bytes));

    // The sides as a fan about the tip, the base as a strip: 0 3 1 2 gives (0 3 1) and (3 2 1).
    std::string lists = pyramidBytes().substr(0, 60);
    put<uint32_t>(lists, {4, 0, 1, 2, 3, 0, 0, 3, 1, 2});
    json = pyramid();
    json["accessors"] = Json::parse(R"([{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"},
        {"bufferView": 1, "byteOffset": 24, "componentType": 5125, "count": 4, "type": "SCALAR"}])");
    json["bufferViews"][1]["byteLength"] = 40;
    json["buffers"][0]["byteLength"] = 100;
    json["meshes"][0]["primitives"] = Json::parse(R"([{"attributes": {"POSITION": 0}, "indices": 1, "mode": 6},
        {"attributes": {"POSITION": 0}, "indices": 2, "mode": 5}, {"attributes": {"POSITION": 0}, "mode": 1}])");
    expectPyramid("lists.glb", glb(json, lists));
}

TEST_F(ReadGltf, BelievesNoNumber) {
    for (const auto& [place, value] : {
             std::pair("/accessors/0/count", Json(6)),
             {"/accessors/0/count", Json(18446744073709551615u)},
             {"/accessors/0/count", Json(-1)},
             {"/accessors/0/count", Json(1e300)},
             {"/accessors/0/byteOffset", Json(4)},
             {"/accessors/0/byteOffset", Json(18446744073709551608u)},
             {"/accessors/0/type", Json("VEC4")},
             {"/accessors/0/componentType", Json(5130)},
             {"/accessors/0/bufferView", Json(2)},
             {"/accessors/0/bufferView", Json("x")},
             {"/accessors/0/sparse", Json::object()},
             {"/accessors/1/componentType", Json(5120)},
             {"/accessors/1/componentType", Json(5126)},
             {"/accessors/1/byteOffset", Json(1)},
             {"/bufferViews/0/buffer", Json(1)},
             {"/bufferViews/0/byteLength", Json(97)},
             {"/bufferViews/0/byteLength", Json(18446744073709551615u)},
             {"/bufferViews/0/byteOffset", Json(18446744073709551615u)},
             {"/bufferViews/0/byteStride", Json(4)},
             {"/bufferViews/0/byteStride", Json(16)},
             {"/bufferViews/0/extensions", Json{{"EXT_meshopt_compression", 1}}},
             {"/buffers/0/byteLength", Json(97)},
             {"/buffers/0/uri", Json("../secret.bin")},
             {"/buffers/0/uri", Json("/etc/passwd")},
             {"/buffers/0/uri", Json("%2fetc/passwd")},
             {"/buffers/0/uri", Json(".")},
             {"/buffers/0/uri", Json("data:;base64,!!!!")},
             {"/buffers", Json(3)},
             {"/nodes/0/mesh", Json(1)},
             {"/nodes/0/children", Json{0}},
             {"/nodes/0/matrix", Json{1, 2}},
             {"/nodes/0/scale", Json{1e308, 1e308, "x"}},
             {"/nodes/0/translation", Json{1e308, -1e308, "x"}},
             {"/nodes/0/extensions", Json{{"EXT_mesh_gpu_instancing", 1}}},
             {"/nodes/0", Json(3)},
             {"/scenes/0/nodes", Json{0, 0}},
             {"/scenes/0/nodes", Json{7}},
             {"/scenes", Json(1)},
             {"/scene", Json(9)},
             {"/meshes/0/primitives", Json(1)},
             {"/meshes/0/primitives/0", Json(1)},
             {"/meshes/0/primitives/0/mode", Json(9)},
             {"/meshes/0/primitives/0/attributes", Json(1)},
             {"/meshes/0/primitives/0/indices", Json(0)},
             {"/meshes/0/primitives/0/extensions", Json{{"KHR_draco_mesh_compression", 1}}},
             {"/extensionsRequired", Json{"KHR_draco_mesh_compression"}},
             {"/extensionsRequired", Json{"EXT_other"}},
             {"/extensionsRequired", Json(1)},
             {"/asset/version", Json("1.0")},
             {"/asset", Json(1)},
         })
        EXPECT_NE(refusal(place, value).find("a.glb' "), std::string::npos) << place << " " << value;
    std::string far = pyramidBytes();
    far[60] = 9;
    EXPECT_NE(read("b.glb", glb(pyramid(), far)).error().message.find("none of its vertices"), std::string::npos);
    EXPECT_FALSE(read("c.gltf", std::string(100'000, '[')).ok());
    EXPECT_FALSE(read("d.gltf", "").ok());
    EXPECT_FALSE(read("e.glb", "glTF").ok());
}

TEST_F(ReadGltf, ReachesNoFileElsewhere) {
    Json json = pyramid();
    json["buffers"][0]["uri"] = "link.bin";
    Scratch elsewhere;
    std::filesystem::create_symlink(elsewhere.write("secret", pyramidBytes()), scratch_ / "link.bin");
    const auto mesh = read("a.gltf", json.dump());
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().message.find("its own folder"), std::string::npos) << mesh.error().message;
}

TEST_F(ReadGltf, AFileOfMillionsOfPlacesIsRefusedAtOnce) {
    Json json = pyramid();
    json["nodes"] = Json::array();
    json["scenes"][0]["nodes"] = Json::array();
    for (int i = 0; i < 300'000; ++i) json["nodes"].push_back({{"mesh", 0}}), json["scenes"][0]["nodes"].push_back(i);
    json["meshes"][0]["primitives"] = Json::array();
    for (int i = 0; i < 1000; ++i)
        json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    const auto mesh = read("a.glb", glb(json));
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().message.find("so many places"), std::string::npos) << mesh.error().message;
}

/// Every file cut anywhere, and with bytes changed. SGM_FUZZ_MUTANTS sets how many.
TEST_F(ReadGltf, SurvivesWhateverTheBytesAre) {
    const std::string whole = glb(pyramid());
    for (size_t cut = 0; cut < whole.size(); ++cut) EXPECT_FALSE(read("m.glb", whole.substr(0, cut)).ok()) << cut;
    const FuzzKeys keys = fuzzKeys(2000);
    std::mt19937_64 random(7 + keys.first);
    size_t good = 0;
    for (int i = 0; i < static_cast<int>(keys.count); ++i) {
        std::string mutant = whole;
        for (uint64_t k = 1 + random() % 3; k > 0; --k)
            mutant[random() % mutant.size()] = static_cast<char>(random() % 2 ? '0' + random() % 10 : random());
        const auto mesh = read("m.glb", mutant);
        if (mesh.ok()) good += toDistances(*mesh, 8).ok();
    }
    EXPECT_GT(good, 0u) << "some change nothing that matters";
}

}  // namespace
}  // namespace sgm::mesh
