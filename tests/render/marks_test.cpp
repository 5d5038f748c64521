// Smooth pieces and hard edges of meshes, counted and as pictures.
#include "viewer/render/mesh_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "tests/hard_box.h"
#include "tests/render/gpu_fixture.h"
#include "viewer/render/mesh_scene.h"

namespace sgm::render {
namespace {

/// Two boxes of one part that share no vertex.
mesh::Mesh twoBoxes() {
    return meshOfChunks({hardBox({-1.5, 0, 0}, {}, {1, 1, 1}, 0), hardBox({1.5, 0, 0}, {}, {1, 1, 1}, 0)});
}

PreparedMesh prepared(const mesh::Mesh& mesh) {
    auto made = prepareMesh(mesh, {});
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    return made.ok() ? std::move(*made) : PreparedMesh();
}

std::set<uint32_t> piecesOf(const PreparedMesh& mesh) {
    std::set<uint32_t> pieces;
    for (const PreparedMesh::Owner& owner : mesh.owners) pieces.insert(owner.piece);
    return pieces;
}

TEST(Marks, ABoxHasSixPiecesAndTwelveHardEdges) {
    const PreparedMesh boxes = prepared(twoBoxes());
    EXPECT_EQ(piecesOf(boxes), (std::set<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
    for (size_t t = 0; t < 24; t += 2) EXPECT_EQ(boxes.owners[t].piece, boxes.owners[t + 1].piece) << "of one face";
    ASSERT_EQ(boxes.hardEdges.size(), 24u);
    for (const auto& [a, b] : boxes.hardEdges) EXPECT_EQ(length(b - a), 2) << "no diagonal of a face";
}

TEST(Marks, LabelsJoinFacesAndNormalsTheirEdges) {
    mesh::Chunk box = hardBox({0, 0, 0}, {}, {1, 1, 1}, 0);
    // +x and +z become one smooth piece: one label, and the vertices' own normals along their common edge.
    for (size_t t = 0; t < 12; ++t)
        if (box.labels[t] == 4) box.labels[t] = 0;
    std::erase_if(box.cornerNormals, [&](const mesh::CornerNormal& n) {
        const uint32_t v = box.triangles[n.corner / 3][static_cast<int>(n.corner % 3)];
        return box.labels[n.corner / 3] == 0 && box.positions[v].x > 0 && box.positions[v].z > 0;
    });
    const PreparedMesh one = prepared(meshOfChunks({box}));
    EXPECT_EQ(piecesOf(one).size(), 5u);
    EXPECT_EQ(one.hardEdges.size(), 11u);
    box.cornerNormals.clear();
    box.labels.clear();
    const PreparedMesh smooth = prepared(meshOfChunks({box}));
    EXPECT_EQ(piecesOf(smooth).size(), 1u);
    EXPECT_TRUE(smooth.hardEdges.empty());
}

using MarksPicture = test::OnGpu;
constexpr int edge = 192;  // pixels

Image pictureOf(MeshLook look, bool wires = false, std::optional<Section> section = {}) {
    const mesh::Mesh box = meshOfChunks({hardBox({0, 0, 0}, {}, {1, 1, 1}, 0)});
    auto painter = MeshPainter::create(box, {}, nullptr);
    EXPECT_TRUE(painter.ok());
    PictureOptions options;
    options.width = options.height = edge;
    options.camera = {{3, 2.5, 4}, {0, 0, 0}};
    options.ground = false;
    options.samples = 4;
    auto image = painter->draw(options, nullptr, {look, wires, section});
    EXPECT_TRUE(image.ok());
    return image.ok() ? std::move(*image) : Image();
}

/// Pixels that are nearly black.
size_t darkPixels(const Image& image) {
    size_t dark = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
        dark += image.rgb[i] < 60 && image.rgb[i + 1] < 60 && image.rgb[i + 2] < 60;
    return dark;
}

TEST_F(MarksPicture, LabelsHaveAHueEach) {
    const Image image = pictureOf(MeshLook::Labels);
    // The box takes the middle; sky and three faces meet it.
    std::set<int> hues;
    for (size_t y = 60; y < 132; ++y)
        for (size_t x = 60; x < 132; ++x) {
            const uint8_t* rgb = &image.rgb[(y * edge + x) * 3];
            const int most = std::max({rgb[0], rgb[1], rgb[2]}), least = std::min({rgb[0], rgb[1], rgb[2]});
            if (most - least < 30) continue;
            const double r = rgb[0], g = rgb[1], b = rgb[2], d = most - least;
            const double hue = most == rgb[0] ? (g - b) / d : most == rgb[1] ? 2 + (b - r) / d : 4 + (r - g) / d;
            hues.insert(static_cast<int>(std::floor(hue * 3 + 18)) % 18);
        }
    EXPECT_GE(hues.size(), 3u);
}

TEST_F(MarksPicture, CreasesAndWiresAreDarkLines) {
    const size_t lines = darkPixels(pictureOf(MeshLook::Creases));
    // Nine of the twelve edges are seen, some 75 pixels long and more than one wide.
    EXPECT_GT(lines, 250u);
    EXPECT_LT(lines, 1600u);
    EXPECT_EQ(darkPixels(pictureOf(MeshLook::Labels)), 0u);
    EXPECT_LT(darkPixels(pictureOf(MeshLook::Creases, false, Section{{1, 0, 0}, 0})), lines)
        << "a section cuts edges too";
    const Image plain = pictureOf(MeshLook::Materials), wires = pictureOf(MeshLook::Materials, true);
    EXPECT_NE(plain.rgb, wires.rgb);
}

/// Bars behind a wall, whose sides are seen from their edge: no line of theirs shows through it.
TEST_F(MarksPicture, WiresBehindAWallAreHidden) {
    std::vector<mesh::Chunk> boxes{hardBox({0, 0, 0}, {}, {5, 5, .5}, 0)};
    for (int i = -4; i <= 4; ++i) boxes.push_back(hardBox({1.0 * i, 0, -9}, {}, {.2, 4, 6}, 0));
    auto painter = MeshPainter::create(meshOfChunks(std::move(boxes)), {}, nullptr);
    ASSERT_TRUE(painter.ok());
    PictureOptions options;
    options.width = options.height = 400;
    options.camera = {{.5, .3, 30}, {0, 0, 0}};
    options.samples = 1;
    const auto plain = painter->draw(options, nullptr, {MeshLook::Materials, false, {}});
    const auto wires = painter->draw(options, nullptr, {MeshLook::Materials, true, {}});
    ASSERT_TRUE(plain.ok() && wires.ok());
    size_t lines = 0;
    for (size_t y = 120; y < 280; ++y)
        for (size_t x = 120; x < 280; ++x) {
            const size_t at = (y * 400 + x) * 3;
            lines += std::abs(plain->rgb[at] - wires->rgb[at]) > 8;
        }
    EXPECT_GT(lines, 100u) << "the diagonal of the wall";
    EXPECT_LT(lines, 200u);
}

}  // namespace
}  // namespace sgm::render
