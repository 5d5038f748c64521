// Crisp meshes: closed, oriented, free of crossings, and exact along creases, borders and corners of closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "modeler/field/solids.h"
#include "modeler/mesh/rebuild.h"
#include "modeler/mesh/release.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/blocks.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

const PolygonizeOptions crisp{.surface = Surface::Crisp};

Mesh crispMesh(const Scene& scene, int resolution) {
    const BuiltMesh m = meshOf(scene, resolution, 2, crisp);
    EXPECT_TRUE(m.mesh.ok());
    const MeshFigures f = measure(*m.mesh);
    EXPECT_EQ(f.boundaryEdges, 0u) << resolution;
    EXPECT_EQ(f.nonmanifoldEdges, 0u) << resolution;
    const auto word = validate(*m.mesh);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects) << resolution;
    return *m.mesh;
}

/// How far the field is from 0 in the middle of each triangle, at most, metres.
double mostOff(const Scene& scene, const Mesh& mesh) {
    const eval::Tape tape = scene.tape();
    eval::Workspace w;
    double most = 0;
    std::vector<Vec3f> at;
    for (const Chunk& c : mesh.chunks) at.insert(at.end(), c.positions.begin(), c.positions.end());
    for (const Chunk& c : mesh.chunks)
        for (const Triangle& local : c.triangles) {
            const Triangle t = c.inMesh(local);
            const Vec3f m = (at[t.x] + at[t.y] + at[t.z]) * (1 / 3.0f);
            float f;
            eval::evaluate(tape, {&m.x, &m.y, &m.z, 1}, &f, w);
            most = std::max(most, std::abs(double{f}));
        }
    return most;
}

/// Relative error of a volume. Along the axes a box is exact; turned, a crease that leaves its face between the corners
/// is held back inside it.
double allowedError(double degrees, int resolution) {
    return degrees == 0 ? 1e-6 : resolution < 20 ? 1e-2 : resolution < 60 ? 1.5e-3 : 2.5e-4;
}

TEST(Crisp, ABoxIsExactAlongTheAxesAndCloseWhereTurned) {
    for (const double degrees : {0.0, 10.0, 23.0, 45.0})
        for (const int resolution : {9, 24, 64}) {
            Scene s;
            s.field = block(s.graph, {0.1f, 0.2f, -0.3f}, {1, 0.8f, 0.6f}, degrees);
            const Mesh mesh = crispMesh(s, resolution);
            const float cell = cellFor(s.field.bounds, resolution);
            EXPECT_NEAR(measure(mesh).volume_m3 / (8 * 0.48), 1, allowedError(degrees, resolution))
                << degrees << ' ' << resolution;
            if (degrees == 0) {
                EXPECT_LT(mostOff(s, mesh), 1e-4 * cell) << resolution;
            }
        }
}

TEST(Crisp, ABoxLessABoxIsExactAlongTheAxesAndCloseWhereTurned) {
    for (const double degrees : {0.0, 10.0, 23.0, 45.0})
        for (const int resolution : {24, 64}) {
            Scene s;
            const field::Field host = block(s.graph, {}, {1, 1, 1}, degrees);
            const Mat3 m = Mat3::rotation({1, 0, 0}, degrees * 3.14159265358979 / 180) *
                           Mat3::rotation({0, 1, 0}, 0.7 * degrees * 3.14159265358979 / 180) *
                           Mat3::rotation({0, 0, 1}, 1.3 * degrees * 3.14159265358979 / 180);
            const Vec3f corner = (m * Vec3d{1, 1, 1}).as<float>();
            s.field = field::difference({host, 1}, {block(s.graph, corner, {0.9f, 0.8f, 0.7f}, degrees), 2});
            const Mesh mesh = crispMesh(s, resolution);
            const float cell = cellFor(s.field.bounds, resolution);
            EXPECT_NEAR(measure(mesh).volume_m3 / (8 - 0.9 * 0.8 * 0.7), 1, allowedError(degrees, resolution))
                << degrees << ' ' << resolution;
            if (degrees == 0) {
                EXPECT_LT(mostOff(s, mesh), 1e-4 * cell) << resolution;
            }
        }
}

/// `mesh` merged within a hundredth of a cell, and judged.
Mesh merged(const Mesh& mesh, float cell) {
    auto simple = simplify(mesh, {usualTolerance(cell), 2}, nullptr);
    EXPECT_TRUE(simple.ok());
    const auto word = validate(*simple);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects);
    return *simple;
}

/// Near a corner that lies beyond its cell a few vertices may stay behind; then three faces are not quite planar.
TEST(Crisp, ATurnedBoxHasTwelveTrianglesAsARule) {
    int exact = 0, all = 0;
    for (const double degrees : {0.0, 3.0, 10.0, 23.0, 37.0, 45.0, 71.0})
        for (const int resolution : {9, 24, 50, 96}) {
            Scene s;
            s.field = block(s.graph, {0.1f, 0.2f, -0.3f}, {1, 0.8f, 0.6f}, degrees);
            const Mesh mesh = merged(crispMesh(s, resolution), cellFor(s.field.bounds, resolution));
            ++all, exact += mesh.triangleCount() == 12 && mesh.vertexCount() == 8;
            EXPECT_LE(mesh.triangleCount(), degrees == 0 ? 12u : 200u) << degrees << ' ' << resolution;
            EXPECT_NEAR(measure(mesh).volume_m3 / (8 * 0.48), 1, 2e-4) << degrees << ' ' << resolution;
        }
    EXPECT_GE(exact, 3 * all / 4);
}

TEST(Crisp, VerticesKeptInTheirCellsAreReleased) {
    Scene s;
    s.field = block(s.graph, {}, {1, 0.9f, 0.8f}, 17);
    const Mesh raw = crispMesh(s, 40);
    size_t confined = 0;
    for (const Chunk& c : raw.chunks) {
        for (size_t i = 1; i < c.confined.size(); ++i) EXPECT_LT(c.confined[i - 1].vertex, c.confined[i].vertex);
        for (const ConfinedVertex& v : c.confined) {
            ASSERT_LT(v.vertex, c.positions.size());
            EXPECT_LE(length(c.positions[v.vertex] - v.place), 2.5f * cellFor(s.field.bounds, 40));
        }
        confined += c.confined.size();
    }
    EXPECT_GT(confined, 20u);
    const double before = mostOff(s, raw);
    FlatMesh flat = flatten(raw, 2);
    EXPECT_GE(releaseConfined(raw, flat, 2, nullptr), confined);
    Mesh released = raw;
    for (size_t i = 0; i < released.chunks.size(); ++i)
        for (uint32_t v = 0; v < flat.parts[i].vertices; ++v)
            released.chunks[i].positions[v] = flat.positions[flat.parts[i].firstVertex + v];
    EXPECT_LT(mostOff(s, released), 0.02 * before);
    const auto word = validate(released);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects);
}

/// Ends of the edges between two origins, each edge once.
std::vector<std::pair<Vec3f, Vec3f>> borderEdges(const Mesh& mesh) {
    std::vector<Vec3f> at;
    for (const Chunk& c : mesh.chunks) at.insert(at.end(), c.positions.begin(), c.positions.end());
    std::map<std::pair<uint32_t, uint32_t>, OriginId> half;
    for (const Chunk& c : mesh.chunks)
        for (size_t t = 0; t < c.triangles.size(); ++t) {
            const Triangle tri = c.inMesh(c.triangles[t]);
            for (int k = 0; k < 3; ++k) half[{tri[k], tri[(k + 1) % 3]}] = c.origins[t];
        }
    std::vector<std::pair<Vec3f, Vec3f>> edges;
    for (const auto& [edge, origin] : half)
        if (edge.first < edge.second && half.at({edge.second, edge.first}) != origin)
            edges.emplace_back(at[edge.first], at[edge.second]);
    return edges;
}

double borderLength(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [from, to] : borderEdges(mesh)) sum += length(from - to);
    return sum;
}

TEST(Crisp, BordersOfMaterialsAreStraight) {
    for (const double degrees : {0.0, 23.0})
        for (const int resolution : {24, 64, 128}) {
            Scene s;
            const Mat3 m = Mat3::rotation({1, 0, 0}, degrees * 3.14159265358979 / 180) *
                           Mat3::rotation({0, 1, 0}, 0.7 * degrees * 3.14159265358979 / 180) *
                           Mat3::rotation({0, 0, 1}, 1.3 * degrees * 3.14159265358979 / 180);
            const Vec3f beside = (m * Vec3d{1, 0, 0}).as<float>();
            const field::Owned both[] = {{block(s.graph, {}, {1, 1, 1}, degrees), 1},
                                         {block(s.graph, beside, {1, 1, 1}, degrees), 2}};
            s.field = field::sum(s.graph, both);
            const Mesh mesh = crispMesh(s, resolution);
            EXPECT_NEAR(borderLength(mesh) / 8, 1,
                        degrees == 0      ? 1e-5
                        : resolution < 60 ? 0.04
                                          : 0.02)
                << degrees << ' ' << resolution;
            EXPECT_NEAR(measure(mesh).volume_m3 / 12, 1, allowedError(degrees, resolution))
                << degrees << ' ' << resolution;
        }
}

TEST(Crisp, BordersInAPlaneLieOnTheWallBetweenTwoParts) {
    for (const int resolution : {24, 64}) {
        Scene s;
        const double degrees = 17;
        const field::Point p = turned(s.graph, {}, degrees);
        const field::NodeRef side = p.x - s.graph.literal(0.25f), whole = block(s.graph, {}, {1, 1, 1}, degrees).value;
        const auto part = [&](const field::NodeRef& cut) {
            return field::Field{max(whole, cut), {{-1.8f, -1.8f, -1.8f}, {1.8f, 1.8f, 1.8f}}, 1, 0.5f};
        };
        const field::Owned both[] = {{part(side), 1}, {part(-side), 2}};
        s.field = field::sum(s.graph, both);
        const Mesh mesh = crispMesh(s, resolution);
        const double a = degrees * 3.14159265358979 / 180;
        const Vec3d along =
            (Mat3::rotation({1, 0, 0}, a) * Mat3::rotation({0, 1, 0}, 0.7 * a) * Mat3::rotation({0, 0, 1}, 1.3 * a)) *
            Vec3d{1, 0, 0};
        std::vector<double> off;  // of both ends
        for (const auto& [from, to] : borderEdges(mesh))
            for (const Vec3f end : {from, to}) off.push_back(std::abs(dot(end.as<double>(), along) - 0.25));
        ASSERT_GT(off.size(), 40u);
        const auto median = off.begin() + static_cast<ptrdiff_t>(off.size() / 2);
        std::nth_element(off.begin(), median, off.end());
        EXPECT_LT(*median, 2e-5 * (3.6 / resolution)) << resolution;
        // At a rim the border is looked for a 128th of a cell beside that, unless the rim leaves the cell.
        const auto isOff = [&](double distance) { return distance > .01 * (3.6 / resolution); };
        EXPECT_LE(std::count_if(off.begin(), off.end(), isOff), resolution < 60 ? 4 : 0) << resolution;
    }
}

TEST(Crisp, BordersOfAWideFieldLieOnTheWallTooWhereTiesReachFar) {
    for (const double degrees : {8.0, 31.0, 75.0}) {
        Scene s;
        const double a = degrees * 3.14159265358979 / 180;
        const Vec3f along = Vec3d{std::cos(a), 0, std::sin(a)}.as<float>();
        const field::NodeRef side = s.graph.x() * along.x + s.graph.z() * along.z - 3.1f,
                             whole = block(s.graph, {}, {41, 9, 39}).value;
        const float reach = 4096;  // values within 1/128 m of each other tie
        const Box3f bounds{{-reach, -reach, -reach}, {reach, reach, reach}};
        const field::Owned both[] = {{{max(whole, side), bounds, 1, 0.5f}, 1},
                                     {{max(whole, -side), bounds, 1, 0.5f}, 2}};
        s.field = field::sum(s.graph, both);
        const Grid grid{{-48, -48, -48}, 2, {48, 48, 48}};
        Counts counts;
        const auto blocks = subdivide(s.tape(), grid, 1, nullptr, counts);
        ASSERT_TRUE(blocks.ok());
        const auto mesh = polygonize(*blocks, grid, crisp, nullptr, counts);
        ASSERT_TRUE(mesh.ok());
        size_t ends = 0, off = 0;  // off are those beside a vertex of the grid that ties itself, and corners at rims
        for (const auto& [from, to] : borderEdges(*mesh))
            for (const Vec3f end : {from, to}) {
                ++ends;
                off += std::abs(double{end.x} * along.x + double{end.z} * along.z - 3.1) > 1e-4;
            }
        EXPECT_GT(ends, 100u) << degrees;
        EXPECT_LT(off, ends / 4) << degrees;
    }
}

TEST(Crisp, BordersOfThreePartsInOnePlaneMeetInACorner) {
    for (int place = 0; place < 8; ++place) {
        Scene s;
        const Vec3f moved = Vec3f{0.013f, 0.029f, 0.041f} * static_cast<float>(place);
        const field::Owned parts[] = {{block(s.graph, moved + Vec3f{0, -1, 0}, {2, 1, 1}), 1},
                                      {block(s.graph, moved + Vec3f{-0.5f, 1, 0}, {0.5f, 1, 1}), 2},
                                      {block(s.graph, moved + Vec3f{0.5f, 1, 0}, {0.5f, 1, 1}), 3}};
        s.field = field::sum(s.graph, parts);
        const int resolution = 24;
        const Mesh mesh = crispMesh(s, resolution);
        for (const float side : {-1.0f, 1.0f}) {
            double nearest = 1;
            for (const Chunk& c : mesh.chunks)
                for (const Vec3f& p : c.positions)
                    nearest = std::min(nearest, double{length(p - moved - Vec3f{0, 0, side})});
            EXPECT_LT(nearest, 0.002 * 4 / resolution) << place << ' ' << side;
        }
        EXPECT_NEAR(borderLength(mesh), 14, 1e-3) << place;  // 8 at the foot, 6 between the upper ones
    }
}

TEST(Crisp, ACylinderHasRoundRims) {
    Scene s;
    const field::Point p = turned(s.graph, {}, 17);
    const field::NodeRef side = sqrt(square(p.x) + square(p.z)) - 1.0f, cap = abs(p.y) - 1.0f;
    s.field = {
        s.graph.apply(field::codeOf<field::ops::Rim>, {side, cap}), {{-1.5f, -1.5f, -1.5f}, {1.5f, 1.5f, 1.5f}}, 1, 1};
    for (const int resolution : {24, 64}) crispMesh(s, resolution);
}

TEST(Crisp, ARodHalfSunkInAWallMeetsItAlongStraightLines) {
    const float radius = 0.2f, sunk = 0.06f;
    const double a = 27 * 3.14159265358979 / 180;
    for (int place = 0; place < 8; ++place) {
        Scene s;
        const auto moved = static_cast<float>(0.02 * place);
        const field::Point p = shifted(s.graph, {moved, 2 * moved, 3 * moved});
        const field::NodeRef across = p.x * static_cast<float>(std::cos(a)) - p.y * static_cast<float>(std::sin(a));
        const field::NodeRef rod = sqrt(square(across) + square(p.z - (0.3f - sunk))) - radius;
        const Box3f bounds{{-1.6f, -1.6f, -0.6f}, {1.6f, 1.6f, 1.2f}};
        const field::Field wall = block(s.graph, {moved, 2 * moved, 3 * moved}, {1.2f, 1.2f, 0.3f});
        const field::Owned both[] = {{wall, 1}, {{max(rod, abs(p.y) - 1.1f), bounds, 1, 0.5f}, 2}};
        s.field = field::sum(s.graph, both);
        const int resolution = 36;  // the rod is five cells thick, what stands out two cells high
        const Mesh mesh = crispMesh(s, resolution);
        size_t along = 0;
        for (const auto& [from, to] : borderEdges(mesh))
            for (const Vec3f end : {from, to}) {
                const Vec3d at = (end - Vec3f{moved, 2 * moved, 3 * moved}).as<double>();
                if (std::abs(at.z - 0.3) > 1e-4 || std::abs(at.y) > 0.9) continue;
                const double u = at.x * std::cos(a) - at.y * std::sin(a), w = at.z - (0.3 - sunk);
                EXPECT_NEAR(std::sqrt(u * u + w * w), radius, 0.01 * 3.2 / resolution) << place;
                ++along;
            }
        EXPECT_GT(along, 40u) << place;
    }
}

TEST(Crisp, RandomBoxesAreClosedAndDontCross) {
    for (uint64_t key = 0; key < 150; ++key) {
        Scene s;
        std::vector<field::Owned> parts;
        uint64_t draw = mix(key + 77);
        const auto real = [&](double lo, double hi) { return static_cast<float>(uniform(draw = mix(draw), lo, hi)); };
        const bool aligned = key % 2 == 0;
        const size_t count = 2 + key % 5;
        for (size_t i = 0; i < count; ++i) {
            const Vec3f centre{real(-1, 1), real(-1, 1), real(-1, 1)}, half{real(.2, .8), real(.2, .8), real(.2, .8)};
            parts.push_back({block(s.graph, centre, half, aligned ? 0 : real(0, 90)), static_cast<OriginId>(i + 1)});
        }
        s.field = field::sum(s.graph, parts);
        if (key % 3 == 0)
            s.field = field::difference({s.field, 0},
                                        {block(s.graph, {real(-1, 1), 0, 0}, {.5f, .4f, .3f}, real(0, 90)), 99});
        const BuiltMesh m = meshOf(s, 32, 2, crisp);
        ASSERT_TRUE(m.mesh.ok());
        const MeshFigures f = measure(*m.mesh);
        EXPECT_EQ(f.boundaryEdges, 0u) << key;
        EXPECT_EQ(f.nonmanifoldEdges, 0u) << key;
        const auto word = validate(*m.mesh);
        EXPECT_TRUE(word.ok() && word->closed && word->outward) << key;
        EXPECT_FALSE(word->selfIntersects) << key;
    }
}

/// A house on its lot, turned about the vertical axis; their floors lie in one plane.
Scene lot(Vec3f centre, double radians) {
    Scene s;
    const auto c = static_cast<float>(std::cos(radians)), d = static_cast<float>(std::sin(radians));
    const auto part = [&](Vec3f half, OriginId owner) {
        const field::Point p = shifted(s.graph, centre + Vec3f{0, half.y, 0});
        const field::Point turned{p.x * s.graph.literal(c) + p.z * s.graph.literal(d), p.y,
                                  p.z * s.graph.literal(c) - p.x * s.graph.literal(d)};
        const Vec3f reach{half.x + half.z, half.y, half.x + half.z};
        const Vec3f at = centre + Vec3f{0, half.y, 0};
        return field::Owned{
            {field::solids::boxDistance(turned, {s.graph.slot(half.x), s.graph.slot(half.y), s.graph.slot(half.z)}),
             {at - reach, at + reach},
             1,
             0.5f},
            owner};
    };
    s.field = field::sum(s.graph, std::vector<field::Owned>{part({12, .125f, 9}, 1), part({9, 1.5f, 6}, 2)});
    return s;
}

/// Floats are .12 mm apart there: points of creases are rounded onto the sides of faces.
TEST(Crisp, NothingCrossesFarFromTheOrigin) {
    for (int i = 1; i <= 12; ++i) crispMesh(lot({1130.3f, -.25f, -2030.7f}, 0.07 * i), 140);
}

TEST(Crisp, RebuildingGivesTheBytesOfAFullBuild) {
    Rebuild rebuild(crisp);
    const Grid grid = gridFor({{-3, -2, -2}, {3, 2, 2}}, 0.06f);
    for (const float x : {0.0f, 0.3f, 0.35f, 0.0f}) {
        Scene s;
        std::vector<field::Owned> parts{{block(s.graph, {-1.5f, 0, 0}, {1, 0.8f, 0.6f}, 20), 1},
                                        {block(s.graph, {1.2f + x, 0, 0}, {0.7f, 0.5f, 0.9f}, 35), 2}};
        s.field = field::sum(s.graph, parts);
        s.field.bounds = {{-3, -2, -2}, {3, 2, 2}};
        Counts counts;
        const auto again = rebuild.update(s.tape(), grid, nullptr, counts);
        ASSERT_TRUE(again.ok());
        EXPECT_EQ(bytesOf(**again), bytesOf(*meshOf(s.tape(), grid, 2, crisp).mesh)) << x;
    }
    EXPECT_GT(rebuild.blocksKept(), 0u);
}

TEST(Crisp, ThreadsChangeNothing) {
    Scene s = cloudScene(40, 0.1f, 3);
    s.field = field::difference({s.field, 0}, {block(s.graph, {0.5f, 0.5f, 0.5f}, {0.3f, 0.4f, 0.2f}, 30), 99});
    EXPECT_EQ(bytesOf(*meshOf(s, 70, 1, crisp).mesh), bytesOf(*meshOf(s, 70, 2, crisp).mesh));
}

}  // namespace
}  // namespace sgm::mesh
