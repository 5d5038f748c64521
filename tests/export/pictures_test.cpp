// Pictures of materials in files: embedded in glTF, named by the others.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "modeler/export/exporter.h"
#include "modeler/image/texture.h"
#include "tests/export/hand_made.h"
#include "tests/hard_box.h"
#include "tests/image/pictures.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

struct PicturesTest : testing::Test {
    mesh::Mesh mesh;
    Provenance provenance;
    ExportInput input;
    Scratch folder;
    std::string png = image::pngOf(2, 1, {255, 0, 0, 0, 0, 255}),
                jpeg = image::jpegOf(2, 2, std::vector<uint8_t>(12, 128));

    PicturesTest() {
        folder.write("brick.png", png);
        folder.write("bump.jpg", jpeg);
        auto texture = std::make_shared<image::Texture>();
        texture->color = *image::readImageFile(folder / "brick.png");
        texture->normals = *image::readImageFile(folder / "bump.jpg");
        texture->width_m = 2, texture->height_m = .5f;
        Material brick;
        brick.name = "brick";
        brick.color = {.5f, .2f, .1f};
        brick.texture = texture;
        provenance.materials.push_back(brick);
        Part part;
        part.material = 1;
        provenance.parts.push_back(part);
        mesh = meshOfChunks({hardBox({0, 0, 0}, {}, {1, 1, 1}, 1)});
        input.mesh = &mesh;
        input.provenance = &provenance;
    }
    tinygltf::Model written(const std::string& pack = "none") {
        input.options = {{"pack", pack}};
        const Status status = write(input, folder / "a.gltf");
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        tinygltf::Model model;
        std::string error, warning;
        tinygltf::TinyGLTF reader;
        reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                                 const unsigned char*, int, void*) { return true; },
                              nullptr);
        if (pack == "none") {
            EXPECT_TRUE(reader.LoadASCIIFromFile(&model, &error, &warning, (folder / "a.gltf").string())) << error;
        }
        return model;
    }
};

TEST_F(PicturesTest, GltfHoldsThemAsTheyAre) {
    const tinygltf::Model model = written();
    ASSERT_EQ(model.images.size(), 2u);
    ASSERT_EQ(model.textures.size(), 2u);
    EXPECT_EQ(model.images[0].name, "brick");
    EXPECT_EQ(model.images[0].mimeType, "image/png");
    EXPECT_EQ(model.images[1].mimeType, "image/jpeg");
    const auto bytesOf = [&](size_t i) {
        const auto& view = model.bufferViews[static_cast<size_t>(model.images[i].bufferView)];
        const auto* from = reinterpret_cast<const char*>(model.buffers[0].data.data() + view.byteOffset);
        return std::string(from, view.byteLength);
    };
    EXPECT_EQ(bytesOf(0), png);
    EXPECT_EQ(bytesOf(1), jpeg);
    ASSERT_EQ(model.materials.size(), 1u);
    const auto& pbr = model.materials[0].pbrMetallicRoughness;
    EXPECT_EQ(pbr.baseColorTexture.index, 0);
    EXPECT_EQ(pbr.baseColorFactor, (std::vector<double>{1, 1, 1, 1})) << "the picture is the colour";
    EXPECT_EQ(model.materials[0].normalTexture.index, 1);
    EXPECT_EQ(model.samplers[0].wrapS, TINYGLTF_TEXTURE_WRAP_REPEAT);
}

/// What the transform makes of the stored coordinates is tiles: metres along u over the width, up v over the height.
TEST_F(PicturesTest, TilesAreInMetres) {
    const tinygltf::Model model = written();
    const auto& transform =
        model.materials[0].pbrMetallicRoughness.baseColorTexture.extensions.at("KHR_texture_transform");
    const double scale = transform.Get("scale").Get(1).GetNumberAsDouble(),
                 offset = transform.Get("offset").Get(1).GetNumberAsDouble();
    EXPECT_DOUBLE_EQ(transform.Get("scale").Get(0).GetNumberAsDouble(), .5);
    for (const double v_m : {0.0, .5, 1.25}) EXPECT_NEAR(scale * (1 - v_m) + offset, 1 - v_m / .5, 1e-12);
    EXPECT_EQ(model.extensionsUsed, std::vector<std::string>{"KHR_texture_transform"});
}

TEST_F(PicturesTest, ReliefsComeWithTangentsAlongTheirTiles) {
    const tinygltf::Model model = written();
    const auto& attributes = model.meshes[0].primitives[0].attributes;
    const auto floats = [&](const char* name) {
        const auto& accessor = model.accessors[static_cast<size_t>(attributes.at(name))];
        const auto& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
        const size_t each = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
        std::vector<float> numbers(accessor.count * each);
        std::memcpy(numbers.data(), model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset,
                    4 * numbers.size());
        return numbers;
    };
    const std::vector<float> normals = floats("NORMAL"), tangents = floats("TANGENT");
    ASSERT_EQ(tangents.size() / 4, normals.size() / 3);
    for (size_t i = 0; i < normals.size() / 3; ++i) {
        const Vec3f n{normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]},
            t{tangents[4 * i], tangents[4 * i + 1], tangents[4 * i + 2]};
        EXPECT_NEAR(dot(n, t), 0, 1e-6);
        EXPECT_NEAR(length(t), 1, 1e-6);
        EXPECT_EQ(tangents[4 * i + 3], 1);
        if (std::abs(n.y) < .5f) {
            EXPECT_NEAR(cross(n, t).y, 1, 1e-6) << "up a wall";
        }
    }
}

TEST_F(PicturesTest, PackedFilesHoldThemToo) {
    for (const std::string pack : {"meshopt", "draco"}) {
        written(pack);
        const std::string text = contentOf(folder / "a.gltf");
        for (const char* part : {"\"image/png\"", "\"image/jpeg\"", "KHR_texture_transform", "baseColorTexture"})
            EXPECT_NE(text.find(part), std::string::npos) << pack << " " << part;
    }
}

TEST_F(PicturesTest, WithoutCoordinatesThereAreNone) {
    input.options = {{"uv", "none"}};
    for (const char* name : {"a.gltf", "a.usda", "a.obj"}) ASSERT_TRUE(write(input, folder / name).ok());
    EXPECT_EQ(contentOf(folder / "a.gltf").find("baseColorTexture"), std::string::npos);
    EXPECT_EQ(contentOf(folder / "a.usda").find("UsdUVTexture"), std::string::npos);
    EXPECT_EQ(contentOf(folder / "a.mtl").find("map_Kd"), std::string::npos);
}

TEST_F(PicturesTest, ObjNamesThemByTheWayFromItsFolder) {
    std::filesystem::create_directories(folder / "out");
    ASSERT_TRUE(write(input, folder / "out/a.obj").ok());
    const std::string text = contentOf(folder / "out/a.mtl");
    EXPECT_NE(text.find("map_Kd -s 0.5 2 1 ../brick.png\n"), std::string::npos) << text;
    EXPECT_NE(text.find("norm -s 0.5 2 1 ../bump.jpg\n"), std::string::npos) << text;
}

TEST_F(PicturesTest, UsdReadsThemByShaders) {
    ASSERT_TRUE(write(input, folder / "a.usda").ok());
    const std::string text = contentOf(folder / "a.usda");
    for (const char* part : {"asset inputs:file = @brick.png@", "asset inputs:file = @bump.jpg@",
                             "float2 inputs:scale = (0.5, 2)", "inputs:diffuseColor.connect", "inputs:normal.connect"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(PicturesTest, UsdNamesAPathThatHoldsTheSignAroundPaths) {
    auto texture = std::make_shared<image::Texture>(*provenance.materials[1].texture);
    folder.write("wood@2x.png", png);
    texture->color = *image::readImageFile(folder / "wood@2x.png");
    provenance.materials[1].texture = texture;
    ASSERT_TRUE(write(input, folder / "a.usda").ok());
    EXPECT_NE(contentOf(folder / "a.usda").find("asset inputs:file = @@@wood@2x.png@@@"), std::string::npos);
}

TEST_F(PicturesTest, GltfValidatorFindsNothing) {
    std::string command = "node tests/export/validate_gltf.js", verdict = (folder / "verdict").string();
    for (const std::string pack : {"none", "meshopt", "draco"}) {
        input.options = {{"pack", pack}};
        const auto path = folder / (pack + ".glb");
        ASSERT_TRUE(write(input, path).ok());
        command += " " + path.string();
    }
    const int status = std::system((command + " > " + verdict + " 2>/dev/null").c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (code == 3 || code == 127)
        GTEST_SKIP() << "gltf-validator isn't installed: npm install --prefix build gltf-validator";
    ASSERT_EQ(code, 0);
    std::istringstream lines(contentOf(verdict));
    size_t files = 0;
    for (std::string line; std::getline(lines, line); ++files)
        EXPECT_NE(line.find("\"errors\":0,\"warnings\":0"), std::string::npos) << line;
    EXPECT_EQ(files, 3u);
}

}  // namespace
}  // namespace sgm::exporter
