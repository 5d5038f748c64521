// What the measuring is worth: on boxes whose figures are known, and the script on solids with closed forms. Where node
// or manifold-3d isn't installed the tests of the script skip aloud.
#include "tests/exact/quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "modeler/core/conventions.h"
#include "modeler/export/exporter.h"
#include "tests/export/made_part.h"
#include "tests/scratch.h"

namespace sgm::exact {
namespace {

using exporter::madePart;

/// The eight corners of a box by bits x, y, z, and its faces, outward, from low x to high z.
constexpr uint32_t boxFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

Vec3d cornerOf(Vec3d lo, Vec3d hi, uint32_t bits) {
    return {bits & 1 ? hi.x : lo.x, bits & 2 ? hi.y : lo.y, bits & 4 ? hi.z : lo.z};
}

Vec3d outward(int face) {
    Vec3d n;
    n[face / 2] = face % 2 ? 1 : -1;
    return n;
}

/// A box as the script would describe it.
ExactModel boxModel(Vec3d lo, Vec3d hi) {
    ExactModel m;
    for (uint32_t v = 0; v < 8; ++v) m.points.push_back(cornerOf(lo, hi, v));
    for (const auto& f : boxFaces) {
        m.triangles.push_back({f[0], f[1], f[2]});
        m.triangles.push_back({f[0], f[2], f[3]});
    }
    m.origins.assign(12, 1);
    m.round.assign(12, 0);
    for (int face = 0; face < 6; ++face) m.normals.insert(m.normals.end(), 2, outward(face));
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t v = 0; v < 8; ++v) {
            if (v >> axis & 1) continue;
            const int other[2] = {(axis + 1) % 3, (axis + 2) % 3};
            Crease c{{m.points[v], m.points[v | 1u << axis]}, static_cast<uint32_t>(m.creases.size()), 90, true, {}};
            for (int i = 0; i < 2; ++i) c.normals[i] = outward(2 * other[i] + static_cast<int>(v >> other[i] & 1));
            m.creases.push_back(c);
        }
    for (const Vec3d p : m.points) m.corners.push_back({p, 3, minComponent(hi - lo)});
    const Vec3d s = hi - lo;
    m.volume_m3 = s.x * s.y * s.z;
    return m;
}

/// The box as a mesh, its upper face of part 2 where `capped`.
mesh::Mesh boxMesh(Vec3d lo, Vec3d hi, bool capped = false) {
    mesh::Chunk c;
    for (uint32_t v = 0; v < 8; ++v) {
        c.positions.push_back(cornerOf(lo, hi, v).as<float>());
        c.normals.push_back({0, 1, 0});
    }
    for (int face = 0; face < 6; ++face) {
        const auto& f = boxFaces[face];
        c.triangles.push_back({f[0], f[1], f[2]});
        c.triangles.push_back({f[0], f[2], f[3]});
        c.origins.insert(c.origins.end(), 2, capped && face == 3 ? 2 : 1);
    }
    mesh::Mesh mesh;
    mesh.chunks.push_back(std::move(c));
    return mesh;
}

Provenance twoLooks() {
    Provenance p;
    p.materials = {{"red", {1, 0, 0}, 1, 0, nullptr},
                   {"green", {0, 1, 0}, 1, 0, nullptr},
                   {"red again", {1, 0, 0}, 1, 0, nullptr}};
    p.parts = {{},
               madePart("A", {"A", "", "a.sgm", 1}, 0),
               madePart("B", {"B", "", "a.sgm", 2}, 1),
               madePart("C", {"C", "", "a.sgm", 3}, 2)};
    return p;
}

constexpr Vec3d lo{-1, -1, -1}, hi{1, 1, 1};

TEST(Quality, OfTheExactMeshIsPerfect) {
    const ExactModel model = boxModel(lo, hi);
    const Quality q = measureQuality(boxMesh(lo, hi, true), twoLooks(), model, 0.1, true);
    EXPECT_EQ(q.thickShare, 1);
    EXPECT_EQ(q.crease.count, 12u * 40);
    EXPECT_EQ(q.corner.count, 8u);
    EXPECT_LT(q.crease.most, 1e-9);
    EXPECT_LT(q.corner.most, 1e-9);
    EXPECT_LT(q.stray.most, 1e-9);
    EXPECT_EQ(q.stray.count, 12u * 40);
    EXPECT_NEAR(q.volumeError, 0, 1e-12);
    EXPECT_NEAR(q.border_m, 8, 1e-12);
    EXPECT_EQ(q.boundaryEdges + q.nonmanifoldEdges + *q.crossings, 0u);
}

TEST(Quality, SeesHowFarAMeshIsOff) {
    const ExactModel model = boxModel(lo, hi);
    const double off = 0.02;  // a fifth of a cell, outward
    const Quality q =
        measureQuality(boxMesh(lo - Vec3d{off, off, off}, hi + Vec3d{off, off, off}), twoLooks(), model, 0.1, false);
    EXPECT_NEAR(q.crease.mean, 0.2, 1e-6);
    EXPECT_NEAR(q.corner.mean, 0.2 * std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(q.stray.mean, 0.2 * std::sqrt(2.0), 0.01);
    EXPECT_NEAR(q.volumeError, std::pow(1.02, 3) - 1, 1e-6);
    EXPECT_FALSE(q.crossings.has_value());
}

TEST(Quality, CountsOpenEdgesAndCrossings) {
    const ExactModel model = boxModel(lo, hi);
    mesh::Mesh open = boxMesh(lo, hi), crossed = boxMesh(lo, hi);
    open.chunks[0].triangles.resize(10);
    open.chunks[0].origins.resize(10);
    EXPECT_EQ(measureQuality(open, twoLooks(), model, 0.1, false).boundaryEdges, 4u);
    const mesh::Mesh larger = boxMesh({0, 0, 0}, {3, 3, 3}), other = boxMesh(lo, hi);
    for (const Vec3f p : larger.chunks[0].positions) crossed.chunks[0].positions.push_back(p);
    for (const mesh::Triangle t : other.chunks[0].triangles)
        crossed.chunks[0].triangles.push_back({t.x + 8, t.y + 8, t.z + 8});
    crossed.chunks[0].origins.resize(24, 1);
    EXPECT_GT(*measureQuality(crossed, twoLooks(), model, 0.1, true).crossings, 5u);
}

TEST(Samples, TellThinFeaturesFromThickOnes) {
    const auto share = [](Vec3d size, double cell_m) {
        return sampleCreases(boxModel({0, 0, 0}, size), cell_m).thickShare();
    };
    EXPECT_EQ(share({2, 2, 2}, 0.9), 1);
    EXPECT_EQ(share({2, 2, 2}, 1.1), 0) << "the whole box is thinner than two cells";
    // A plate: its long edges bound a thin rim, its short ones are shorter than two cells.
    EXPECT_EQ(share({4, 0.3, 4}, 0.2), 0);
    EXPECT_EQ(share({4, 0.41, 4}, 0.2), 1);
}

TEST(Spreads, AreMeansAndRanks) {
    std::vector<double> values;
    for (int i = 1; i <= 200; ++i) values.push_back(i);
    const Spread s = spreadOf(values);
    EXPECT_EQ(s.mean, 100.5);
    EXPECT_EQ(s.p99, 199);
    EXPECT_EQ(s.most, 200);
    EXPECT_EQ(spreadOf({}).count, 0u);
}

/// Trees written and built by the script.
class Script : public testing::Test {
protected:
    void SetUp() override {
        if (const std::string missing = missingJudge(); !missing.empty()) GTEST_SKIP() << missing;
    }
    uint32_t solid(const char* primitive, Vec3d centre, Vec3d size, OriginId origin = 1, Mat3 axes = {},
                   std::vector<double> arguments = {}) {
        tree.solids.push_back({field::findPrimitive(primitive), std::move(arguments), {centre, axes}, size, origin});
        return node({field::SolidNode::Op::Solid, static_cast<uint32_t>(tree.solids.size() - 1), {}});
    }
    uint32_t node(field::SolidNode n) {
        tree.nodes.push_back(std::move(n));
        return static_cast<uint32_t>(tree.nodes.size() - 1);
    }
    ExactModel built(int sides = 128, Owners owners = Owners::Either) {
        tree.bounds = {{-5, -5, -5}, {5, 5, 5}};
        exporter::ExportInput input;
        const Provenance provenance = twoLooks();
        input.solids = &tree;
        input.provenance = &provenance;
        const auto file = folder / "a.csg.json";
        EXPECT_TRUE(exporter::write(input, file).ok());
        auto model = exactModel(file, sides, owners, folder / "kept");
        EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
        return model.ok() ? *model : ExactModel{};
    }
    std::vector<Segment> borders() { return findBorders(built(), built(128, Owners::First), twoLooks()); }
    using Op = field::SolidNode::Op;
    field::SolidTree tree;
    Scratch folder;
};

TEST_F(Script, DescribesABox) {
    solid("cube", {0, 0, 0}, {2, 3, 4}, 1, Mat3::rotation({1, 2, 3}, 0.7));
    const ExactModel m = built();
    EXPECT_EQ(m.triangles.size(), 12u);
    EXPECT_EQ(m.creases.size(), 12u);
    EXPECT_EQ(m.corners.size(), 8u);
    EXPECT_NEAR(m.volume_m3, 24, 1e-9);
    EXPECT_NEAR(m.crease_m, 36, 1e-4);
    EXPECT_EQ(m.euler, 2);
    for (const Crease& c : m.creases) {
        EXPECT_TRUE(c.convex);
        EXPECT_NEAR(c.degrees, 90, 1e-3);
    }
}

TEST_F(Script, TheFirstOfTwoSolidsOwnsWhatTheyShare) {
    const uint32_t a = solid("cube", {0, 0, 0}, {2, 2, 2}), b = solid("cube", {1, 0, 0}, {2, 2, 2}, 2);
    node({Op::Union, 0, {a, b}});
    EXPECT_EQ(built().triangles.size(), 28u) << "manifold gives the common faces to both";
    EXPECT_EQ(built(128, Owners::First).triangles.size(), 20u);
    EXPECT_NEAR(lengthOf(borders()), 8, 1e-6);
    for (const Segment& s : borders()) EXPECT_NEAR(s.a.x, 1, 1e-6) << "where the first one ends";
}

TEST_F(Script, BordersAreBetweenLooksNotParts) {
    const uint32_t a = solid("cube", {0, 0, 0}, {2, 2, 2}), b = solid("cube", {2, 0, 0}, {2, 2, 2}, 3);
    node({Op::Union, 0, {a, b}});
    EXPECT_TRUE(borders().empty());
}

TEST_F(Script, BordersRunAlongBendsToo) {
    // A post in a plate, and a drum half sunk into its side, turned so that nothing is parallel to an axis.
    const Mat3 axes = Mat3::rotation({1, 2, 3}, 0.7);
    const uint32_t a = solid("cube", {0, 0, 0}, {4, 4, 4}, 1, axes),
                   b = solid("cube", axes * Vec3d{0, 2.25, 0}, {1, 1, 2}, 2, axes),
                   c = solid("cylinder", axes * Vec3d{2, 0, 0}, {2, 3, 2}, 2, axes);
    node({Op::Union, 0, {a, b, c}});
    const double drum = 2 * 3 + 2 * 2;  // two lines along it, and two diameters
    EXPECT_NEAR(lengthOf(borders()), 6 + drum, 2e-3);
}

TEST_F(Script, BordersEndWithinAnEdge) {
    // The second box stands on half of the first one's top, flush with its front: their common edge line is a border
    // where both have a face, and the front's plane is one.
    const uint32_t a = solid("cube", {0, 0, 0}, {4, 2, 4}), b = solid("cube", {1, 2, 1}, {2, 2, 2}, 2);
    node({Op::Union, 0, {a, b}});
    EXPECT_NEAR(lengthOf(borders()), 8, 1e-3);
}

TEST_F(Script, CutsAreConcave) {
    const uint32_t a = solid("cube", {0, 0, 0}, {4, 4, 4}), b = solid("cube", {0, 2, 0}, {2, 2, 2}),
                   c = solid("halfspace", {0, -1, 0}, {1, 1, 1});
    node({Op::Difference, 0, {a, b, c}});
    const ExactModel m = built();
    EXPECT_NEAR(m.volume_m3, 4 * 4 * 3 - 4, 1e-9);
    size_t concave = 0;
    for (const Crease& crease : m.creases) concave += !crease.convex;
    EXPECT_EQ(concave, 8u) << "four edges of the pit's floor, four of its walls";
    EXPECT_EQ(m.corners.size(), 16u);
}

TEST_F(Script, RoundSolidsComeNearTheirClosedForms) {
    struct Form {
        const char* name;
        double volume;
        std::vector<double> arguments{};
    };
    const Vec3d size{2, 3, 4};
    const Form forms[] = {{"cylinder", pi * 2 * 3},
                          {"cone", pi * 2},
                          {"ellipsoid", pi * 4.0 / 3 * 1 * 1.5 * 2},
                          {"pyramid", 8},
                          {"prism", 12},
                          {"wedge", 12},
                          {"torus", 2 * pi * pi * 0.75 * 0.0625 * 2 * 6, {0.25}},
                          {"capsule", pi * 2 * 1 + pi * 4.0 / 3 * 2}};
    for (const Form& f : forms) {
        tree = {};
        solid(f.name, {0, 0, 0}, size, 1, Mat3::rotation({0, 1, 1}, 0.3), f.arguments);
        const ExactModel m = built();
        EXPECT_NEAR(m.volume_m3 / f.volume, 1, 3e-3) << f.name;
        EXPECT_LE(m.volume_m3, f.volume * (1 + 1e-9)) << f.name << " is inscribed";
    }
}

TEST_F(Script, ACylindersRimIsOneChainAndAConesApexACorner) {
    solid("cylinder", {0, 0, 0}, {2, 3, 2});
    const ExactModel drum = built(512);
    EXPECT_NEAR(drum.crease_m, 4 * pi, 1e-3);
    EXPECT_EQ(drum.creases.back().chain, 1u);
    EXPECT_TRUE(drum.corners.empty());
    tree = {};
    solid("cone", {0, 0, 0}, {2, 3, 2});
    const ExactModel hat = built();
    ASSERT_EQ(hat.corners.size(), 1u);
    EXPECT_EQ(hat.corners[0].point, (Vec3d{0, 1.5, 0}));
    EXPECT_EQ(hat.corners[0].creases, 0u);
    EXPECT_EQ(hat.corners[0].thickness_m, 2);
}

TEST_F(Script, SaysWhatIsWrong) {
    const auto file = folder.write("a.csg.json", "{\"format\": \"another\"}");
    const auto model = exactModel(file, 128, Owners::Either, folder / "kept");
    ASSERT_FALSE(model.ok());
    EXPECT_NE(model.error().message.find("is no solid tree of version 1"), std::string::npos) << model.error().message;
}

}  // namespace
}  // namespace sgm::exact
