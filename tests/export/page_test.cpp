// The page of a model: what is packed is what the mesh is, and nothing in it leads elsewhere.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "modeler/export/page_data.h"
#include "modeler/image/texture.h"
#include "tests/export/hand_made.h"
#include "tests/image/pictures.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Json = nlohmann::json;

struct Fixture {
    mesh::Mesh mesh = icosphere({1, 2, 3}, 2, 3, 5);
    Provenance provenance = twoMaterials();
    ExportInput input;

    Fixture() {
        input.mesh = &mesh;
        input.provenance = &provenance;
        input.extras = {{"grammar", "a.sgm"}, {"seed", "7"}, {"param floors", "3"}};
    }
};

std::vector<uint8_t> inflated(const std::vector<uint8_t>& packed) {
    std::vector<uint8_t> bytes(1 << 20);
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    stream.next_in = const_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = bytes.data();
    stream.avail_out = static_cast<uInt>(bytes.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    bytes.resize(stream.total_out);
    inflateEnd(&stream);
    return bytes;
}

/// The JSON in front of the numbers, and the numbers.
std::pair<Json, std::vector<uint8_t>> unpacked(const std::vector<uint8_t>& packed) {
    const std::vector<uint8_t> bytes = inflated(packed);
    uint32_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof length);
    const auto begin = bytes.begin() + sizeof length, end = begin + length;
    return {Json::parse(begin, end), {end, bytes.end()}};
}

TEST(Page, CarriesPicturesAndWhereTheyLie) {
    Fixture sphere;
    const auto plain = packPage(sphere.input);
    ASSERT_TRUE(plain.ok());
    EXPECT_FALSE(unpacked(*plain).first.contains("files")) << "nothing for models without";
    auto texture = std::make_shared<image::Texture>();
    texture->color = *image::readImageBytes(image::pngOf(2, 1, {255, 0, 0, 0, 0, 255}));
    texture->roughness = texture->color;
    texture->width_m = 2, texture->height_m = .5f;
    sphere.provenance.materials.back().texture = texture;
    const auto packed = packPage(sphere.input);
    ASSERT_TRUE(packed.ok());
    const auto [json, numbers] = unpacked(*packed);
    const std::string& file = texture->color->bytes;
    ASSERT_EQ(json["files"], Json::parse(R"([{"type": "image/png", "length": )" + std::to_string(file.size()) + "}]"));
    EXPECT_EQ(json["materials"].back()["texture"],
              Json({{"width", 2}, {"height", .5}, {"color", 0}, {"normals", -1}, {"roughness", 0}}));
    EXPECT_TRUE(json["materials"][0]["texture"].is_null());
    EXPECT_GT(json["charts"].size(), 1u);
    for (const Json& chart : json["charts"]) EXPECT_EQ(chart.size(), 10u);
    ASSERT_GE(numbers.size(), file.size());
    EXPECT_TRUE(std::equal(file.begin(), file.end(), numbers.end() - static_cast<std::ptrdiff_t>(file.size()),
                           [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; }));
}

TEST(Page, HoldsEveryTriangleByPartAndMaterial) {
    const Fixture sphere;
    const auto packed = packPage(sphere.input);
    ASSERT_TRUE(packed.ok());
    const auto [json, numbers] = unpacked(*packed);
    EXPECT_EQ(json["triangles"], sphere.mesh.triangleCount());
    EXPECT_EQ(json["facts"], Json({{"grammar", "a.sgm"}, {"seed", "7"}}));
    EXPECT_EQ(json["parameters"], Json({{"floors", "3"}}));
    ASSERT_EQ(json["groups"].size(), 3u) << "the whole, A and B";
    EXPECT_EQ(json["groups"][1]["name"], "A");
    ASSERT_EQ(json["patches"].size(), 2u);
    size_t triangles = 0;
    for (const Json& patch : json["patches"]) {
        triangles += patch["triangles"].get<size_t>();
        ASSERT_EQ(patch["parts"].size(), 2u) << "one run";
        EXPECT_EQ(patch["parts"][1], patch["triangles"]);
    }
    EXPECT_EQ(triangles, sphere.mesh.triangleCount());
    EXPECT_EQ(json["parts"][json["patches"][1]["parts"][0].get<size_t>()]["path"], "Cave/B");
    // Eight bytes a vertex, and a byte or more a corner.
    const size_t vertices = json["vertices"];
    EXPECT_GE(vertices, sphere.mesh.vertexCount());
    EXPECT_GE(numbers.size(), 8 * vertices + 3 * triangles);
}

TEST(Page, PositionsAreWithinHalfAStep) {
    const Fixture sphere;
    const auto [json, numbers] = unpacked(*packPage(sphere.input));
    const size_t vertices = json["vertices"];
    const double step = json["step"];
    const auto unzigzag = [](uint32_t v) { return static_cast<uint16_t>((v >> 1) ^ (0u - (v & 1))); };
    Vec3d centre{1, 2, 3};
    std::vector<double> squares(vertices, 0);
    for (size_t axis = 0; axis < 3; ++axis) {
        uint16_t steps = 0;
        for (size_t v = 0; v < vertices; ++v) {
            const size_t at = 2 * axis * vertices + v;
            steps = static_cast<uint16_t>(steps +
                                          unzigzag(static_cast<uint32_t>(numbers[at] | numbers[at + vertices] << 8)));
            const double place = (json["origin"][axis].get<double>() + steps) * step;
            squares[v] += (place - centre[static_cast<int>(axis)]) * (place - centre[static_cast<int>(axis)]);
        }
    }
    for (const double square : squares) EXPECT_NEAR(std::sqrt(square), 2, step);
}

TEST(Page, IsOneFileThatNamesNoOther) {
    Fixture sphere;
    const Scratch folder;
    sphere.input.name = "<script>@DATA@";
    ASSERT_TRUE(write(sphere.input, folder / "a.html").ok());
    ASSERT_TRUE(write(sphere.input, folder / "b.html").ok());
    const std::string page = contentOf(folder / "a.html");
    EXPECT_EQ(page, contentOf(folder / "b.html"));
    EXPECT_NE(page.find("<title>&lt;script&gt;@DATA@</title>"), std::string::npos);
    EXPECT_EQ(page.find("@SCRIPT@"), std::string::npos);
    for (const char* elsewhere : {"http:", "https:", "src=\"", "import "})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
}

}  // namespace
}  // namespace sgm::exporter
