// Texture coordinates by scopes and faces, and light maps on which nothing overlaps.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <set>

#include "modeler/core/conventions.h"
#include "modeler/export/exporter.h"
#include "modeler/export/lightmap.h"
#include "tests/export/hand_made.h"
#include "tests/export/read_back.h"
#include "tests/hard_box.h"
#include "tests/scratch.h"

namespace sgm::exporter {
namespace {

using Uv = std::array<float, 2>;

/// What a .glb has of one mesh.
struct Textured {
    std::vector<Vec3f> positions;
    std::vector<Uv> texture, light;
    std::vector<mesh::Triangle> triangles;
};

struct TextureTest : testing::Test {
    mesh::Mesh mesh;
    Provenance provenance;
    ExportInput input;
    Scratch folder;

    TextureTest() {
        input.mesh = &mesh;
        input.provenance = &provenance;
    }
    /// A part that stands so; its origin.
    OriginId part(Vec3d centre, const Mat3& axes) {
        Part p;
        p.pose = {centre, axes};
        provenance.parts.push_back(p);
        return static_cast<OriginId>(provenance.parts.size() - 1);
    }
    mesh::Chunk box(Vec3d centre, const Mat3& axes, Vec3d half) {
        return hardBox(centre, axes, half, part(centre, axes));
    }

    Textured written(size_t meshIndex = 0) {
        const auto path = folder / "a.glb";
        const Status status = write(input, path);
        EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
        tinygltf::Model model;
        std::string error, warning;
        EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path.string())) << error;
        Textured out;
        for (const auto& primitive : model.meshes.at(meshIndex).primitives) {
            const auto base = static_cast<uint32_t>(out.positions.size());
            append(model, primitive.attributes.at("POSITION"), out.positions);
            if (primitive.attributes.count("TEXCOORD_0"))
                append(model, primitive.attributes.at("TEXCOORD_0"), out.texture);
            if (primitive.attributes.count("TEXCOORD_1"))
                append(model, primitive.attributes.at("TEXCOORD_1"), out.light);
            std::vector<uint32_t> corners;
            append(model, primitive.indices, corners);
            for (size_t i = 0; i < corners.size(); i += 3)
                out.triangles.push_back({base + corners[i], base + corners[i + 1], base + corners[i + 2]});
        }
        // v runs downwards in glTF.
        for (auto* set : {&out.texture, &out.light})
            for (Uv& uv : *set) uv[1] = 1 - uv[1];
        return out;
    }
    template <class T>
    static void append(const tinygltf::Model& model, int index, std::vector<T>& to) {
        const auto& accessor = model.accessors[static_cast<size_t>(index)];
        const auto& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
        const size_t first = to.size();
        to.resize(first + accessor.count);
        std::memcpy(to.data() + first, model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset,
                    accessor.count * sizeof(T));
    }
};

double area(const Textured& t, const mesh::Triangle& c) {
    const Vec3d a = t.positions[c.x].as<double>(), b = t.positions[c.y].as<double>(), d = t.positions[c.z].as<double>();
    return length(cross(b - a, d - a)) / 2;
}

/// Positive where the triangle isn't mirrored.
double area(const std::vector<Uv>& uv, const mesh::Triangle& c) {
    const auto x = [&](uint32_t v) { return static_cast<double>(uv[v][0] - uv[c.x][0]); };
    const auto y = [&](uint32_t v) { return static_cast<double>(uv[v][1] - uv[c.x][1]); };
    return (x(c.y) * y(c.z) - x(c.z) * y(c.y)) / 2;
}

TEST_F(TextureTest, AWallTurnedByAnyAngleIsMappedInMetres) {
    for (const double angle : {0.0, 30.0, 45.0, 123.0}) {
        provenance = {};
        mesh = meshOfChunks({box({4, 1, 2}, Mat3::rotation({0, 1, 0}, radians(angle)), {3, 1, .2}),
                             box({9, 1, 2}, Mat3::rotation({1, 2, 3}, radians(angle)), {1, 1, 1})});
        const Textured t = written();
        EXPECT_EQ(t.positions.size(), 48u) << "faces are cut by their normals alone";
        for (const mesh::Triangle& c : t.triangles) EXPECT_NEAR(area(t.texture, c), area(t, c), 1e-4) << angle;
    }
    input.options = {{"uv", "box"}};
    const Textured box = written();
    const auto squeezed = [&](const mesh::Triangle& c) { return area(box.texture, c) < .9 * area(box, c); };
    EXPECT_GT(std::count_if(box.triangles.begin(), box.triangles.end(), squeezed), 0);
}

TEST_F(TextureTest, TexturesGoOnAlongAWallOfSeveralShapes) {
    const Mat3 axes = Mat3::rotation({0, 1, 0}, radians(33));
    mesh = meshOfChunks({box(axes * Vec3d{-2, 0, 0}, axes, {2, 1, .2}), box(axes * Vec3d{3, 0, 0}, axes, {3, 1, .2}),
                         box(axes * Vec3d{1, 2, 0}, axes, {4, 1, .2})});
    const Textured t = written();
    const Vec3f front = (axes * Vec3d{0, 0, 1}).as<float>();
    size_t shared = 0;
    for (const mesh::Triangle& c : t.triangles) {
        const Vec3f a = t.positions[c.x];
        if (dot(normalized(cross(t.positions[c.y] - a, t.positions[c.z] - a)), front) < .99f) continue;
        for (int k = 0; k < 3; ++k) {
            // Along the wall and up it from one place, whichever shape the face is of.
            const Vec3d local = axes.transposed() * t.positions[c[k]].as<double>();
            EXPECT_NEAR(t.texture[c[k]][0], local.x, 1e-4);
            EXPECT_NEAR(t.texture[c[k]][1], local.y, 1e-4);
            ++shared;
        }
    }
    EXPECT_EQ(shared, 18u);
}

TEST_F(TextureTest, SlopesAreMappedInTheirOwnPlane) {
    // A roof of two sides of 40° and a floor: the box's top lifted in its middle.
    mesh::Chunk roof = box({0, 0, 0}, {}, {2, 1, 3});
    const auto slope = static_cast<float>(std::tan(radians(40)));
    for (Vec3f& p : roof.positions)
        if (p.y > 0) p.y += (2 - p.x) * slope;
    for (mesh::CornerNormal& n : roof.cornerNormals)
        if (n.normal.y > .5f) n.normal = normalized(Vec3f{slope, 1, 0});
    mesh = meshOfChunks({roof});
    const Textured t = written();
    for (const mesh::Triangle& c : t.triangles) EXPECT_NEAR(area(t.texture, c), area(t, c), 1e-4);
}

TEST_F(TextureTest, SlopesThatACoarseCellMakesOneAreMappedInTheirOwnPlanes) {
    // Both slopes of a roof under one label, as where a cell has no room for the crease between them.
    mesh::Chunk roof;
    roof.positions = {{-2, 0, -3}, {-2, 0, 3}, {0, 1.5f, -3}, {0, 1.5f, 3}, {2, 0, -3}, {2, 0, 3}};
    roof.normals.assign(6, {0, 1, 0});
    roof.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
    roof.origins.assign(4, part({}, {}));
    roof.labels.assign(4, 7);
    mesh = meshOfChunks({roof});
    for (const bool isFaceted : {true, false}) {
        provenance.parts.back().hasFlatFaces = isFaceted;
        const Textured t = written();
        ASSERT_EQ(t.triangles.size(), 4u);
        for (const mesh::Triangle& c : t.triangles)
            EXPECT_NEAR(area(t.texture, c), (isFaceted ? 1 : .8) * area(t, c), 1e-4)
                << "curved ones are seen from above";
    }
}

TEST_F(TextureTest, RoundThingsAreSeenAlongTheAxesOfTheirScope) {
    const Mat3 axes = Mat3::rotation({0, 1, 0}, radians(45));
    provenance.parts.clear();
    for (int i = 0; i < 3; ++i) part({}, axes);
    mesh = icosphere({}, 2, 3, 2);
    const Textured t = written();
    for (const mesh::Triangle& c : t.triangles) {
        const Vec3d a = t.positions[c.x].as<double>();
        const Vec3d n = axes.transposed() * cross(t.positions[c.y].as<double>() - a, t.positions[c.z].as<double>() - a);
        EXPECT_NEAR(2 * area(t.texture, c), std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1e-5);
    }
}

/// How often a texel's centre is covered, and by how many triangles at most.
struct Cover {
    double share = 0;
    int most = 0;
    std::vector<int> island;  ///< by texel: a triangle of it, -1 for none
};

Cover cover(const Textured& t, int texels) {
    Cover out;
    out.island.assign(static_cast<size_t>(texels * texels), -1);
    std::vector<int> count(out.island.size());
    for (size_t i = 0; i < t.triangles.size(); ++i) {
        const mesh::Triangle& c = t.triangles[i];
        std::array<std::array<double, 2>, 3> p;
        for (int k = 0; k < 3; ++k)
            p[size_t(k)] = {double(t.light[c[k]][0]) * texels, double(t.light[c[k]][1]) * texels};
        const auto [x0, x1] = std::minmax({p[0][0], p[1][0], p[2][0]});
        const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
        EXPECT_TRUE(x0 >= 0 && y0 >= 0 && x1 <= texels && y1 <= texels);
        for (int x = int(x0); x < std::min(int(x1) + 1, texels); ++x)
            for (int y = int(y0); y < std::min(int(y1) + 1, texels); ++y) {
                bool inside = true;
                for (size_t k = 0; k < 3; ++k) {
                    const auto &a = p[k], &b = p[(k + 1) % 3];
                    inside = inside && (b[0] - a[0]) * (y + .5 - a[1]) - (b[1] - a[1]) * (x + .5 - a[0]) > 1e-4;
                }
                if (!inside) continue;
                const auto at = static_cast<size_t>(y * texels + x);
                out.most = std::max(out.most, ++count[at]);
                out.island[at] = static_cast<int>(i);
                out.share += 1.0 / (texels * texels);
            }
    }
    return out;
}

TEST_F(TextureTest, NothingOverlapsOnALightMap) {
    std::vector<mesh::Chunk> chunks;
    for (int i = 0; i < 40; ++i)
        chunks.push_back(box({3.0 * i, 0, 0}, Mat3::rotation({0, 1, 0}, i), {1, .3 + .05 * i, .5 + .02 * i}));
    mesh = meshOfChunks(std::move(chunks));
    input.options = {{"lightmap", "512"}};
    const Textured t = written();
    ASSERT_EQ(t.light.size(), t.positions.size());
    ASSERT_EQ(t.texture.size(), t.positions.size());
    const Cover c = cover(t, 512);
    EXPECT_EQ(c.most, 1);
    EXPECT_GT(c.share, .5);
    // One scale for all, and nothing is mirrored.
    const double scale = area(t.light, t.triangles[0]) / area(t, t.triangles[0]);
    EXPECT_GT(scale, 0);
    for (const mesh::Triangle& corner : t.triangles)
        EXPECT_NEAR(area(t.light, corner) / area(t, corner), scale, 1e-2 * scale);
    // Two texels of another face are never neighbours: one between them is nobody's.
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x + 1 < 512; ++x) {
            const int a = c.island[size_t(y * 512 + x)], b = c.island[size_t(y * 512 + x + 1)];
            if (a < 0 || b < 0) continue;
            ASSERT_EQ(a / 2, b / 2) << "triangles in pairs make faces";
        }
}

TEST_F(TextureTest, ARampThatWindsUpIsCutWhereItWouldCoverItself) {
    // Three turns of a ramp, a strip of quads that all look up.
    mesh::Chunk ramp;
    constexpr uint32_t steps = 180;
    for (uint32_t i = 0; i <= steps; ++i) {
        const float angle = static_cast<float>(i) * .1047f, height = static_cast<float>(i) * .02f;
        for (const float radius : {3.0f, 1.0f})
            ramp.positions.push_back({radius * std::cos(angle), height, radius * std::sin(angle)});
    }
    ramp.normals.resize(ramp.positions.size());
    std::fill(ramp.normals.begin(), ramp.normals.end(), Vec3f{0, 1, 0});
    const OriginId origin = part({}, {});
    for (uint32_t i = 0; i < steps; ++i)
        for (const mesh::Triangle t :
             {mesh::Triangle{2 * i, 2 * i + 1, 2 * i + 3}, mesh::Triangle{2 * i, 2 * i + 3, 2 * i + 2}}) {
            ramp.triangles.push_back(t);
            ramp.origins.push_back(origin);
            ramp.labels.push_back(1);
        }
    mesh = meshOfChunks({ramp});
    input.options = {{"lightmap", "256"}};
    const Textured t = written();
    EXPECT_EQ(cover(t, 256).most, 1);
    std::set<std::pair<float, float>> corners;
    for (const Vec3f& p : t.positions) corners.insert({p.x, p.y});
    EXPECT_LT(t.positions.size(), corners.size() + 20) << "it is cut into few islands";
}

TEST_F(TextureTest, FramesDontKeepARectangleEmpty) {
    // Eight flat frames, 10 m wide and .2 m thick: mitred strips, seen from above.
    mesh::Chunk frames;
    const OriginId origin = part({}, {});
    for (uint32_t i = 0; i < 8; ++i) {
        const uint32_t first = 8 * i;
        for (const float half : {5.0f, 4.8f})
            for (const auto& [x, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
                frames.positions.push_back({half * float(x), float(i), half * float(z)});
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t a = first + k, b = first + (k + 1) % 4;
            for (const mesh::Triangle t : {mesh::Triangle{a, b + 4, b}, mesh::Triangle{a, a + 4, b + 4}}) {
                frames.triangles.push_back(t);
                frames.origins.push_back(origin);
                frames.labels.push_back(i);
            }
        }
    }
    frames.normals.assign(frames.positions.size(), {0, 1, 0});
    mesh = meshOfChunks({frames});
    input.options = {{"lightmap", "512"}};
    const Textured t = written();
    const Cover c = cover(t, 512);
    EXPECT_EQ(c.most, 1);
    EXPECT_GT(c.share, .3) << "whole frames cover 8 % of their rectangles";
    EXPECT_LE(t.positions.size(), 16 * 8u) << "a frame becomes four strips";
}

TEST_F(TextureTest, EachObjectHasALightMapOfItsOwn) {
    mesh = meshOfChunks({box({0, 0, 0}, {}, {1, 1, 1}), box({5, 0, 0}, {}, {2, 2, 2})});
    const ObjectTree objects{{{"a", 0, "A", "A", "", "", 1, {}}, {"B", 0, "A/B", "B", "", "", 1, {}}}, {0, 0, 1}};
    input.objects = &objects;
    input.options = {{"lightmap", "256"}};
    for (const size_t object : {size_t{0}, size_t{1}}) {
        const Cover c = cover(written(object), 256);
        EXPECT_EQ(c.most, 1);
        EXPECT_GT(c.share, .5) << "six squares fill two thirds";
    }
}

TEST_F(TextureTest, LightMapsThatAreTooSmallSaySo) {
    std::vector<mesh::Chunk> chunks;
    for (int i = 0; i < 1500; ++i) chunks.push_back(box({3.0 * i, 0, 0}, {}, {1, 1, 1}));
    mesh = meshOfChunks(std::move(chunks));
    input.options = {{"lightmap", "256"}};
    const Status status = write(input, folder / "a.glb");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("no room for 9000 islands"), std::string::npos) << status.error().message;
    EXPECT_EQ(folder.fileCount(), 0u);
    input.options = {{"lightmap", "256"}, {"uv", "none"}};
    EXPECT_EQ(write(input, folder / "a.glb").error().kind, Error::Kind::Usage);
}

TEST_F(TextureTest, ALightMapIsCancelled) {
    mesh = meshOfChunks({box({0, 0, 0}, {}, {1, 1, 1})});
    TextureCharts charts = chartTexture("scope", mesh, provenance);
    Progress progress;
    EXPECT_TRUE(LightMap::make(mesh, nullptr, 256, &progress, charts).ok());
    progress.cancel();
    charts = chartTexture("scope", mesh, provenance);
    const auto map = LightMap::make(mesh, nullptr, 256, &progress, charts);
    ASSERT_FALSE(map.ok());
    EXPECT_EQ(map.error().kind, Error::Kind::Cancelled);
}

TEST_F(TextureTest, UsdHasBothSets) {
    mesh = meshOfChunks({box({0, 0, 0}, {}, {1, 1, 1})});
    input.options = {{"lightmap", "256"}};
    ASSERT_TRUE(write(input, folder / "a.usda").ok());
    const std::string text = contentOf(folder / "a.usda");
    EXPECT_NE(text.find("texCoord2f[] primvars:st ="), std::string::npos);
    EXPECT_NE(text.find("texCoord2f[] primvars:st1 ="), std::string::npos);
    EXPECT_NE(text.find("int[] primvars:st1:indices"), std::string::npos);
}

}  // namespace
}  // namespace sgm::exporter
