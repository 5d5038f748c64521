// Field to mesh: closed forms, closedness of anything, determinism, origins, budgets.
#include "modeler/mesh/polygonize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "modeler/core/conventions.h"
#include "modeler/mesh/validate.h"
#include "modeler/mesh/vertices.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"
#include "tests/stop_time.h"

namespace sgm::mesh {
namespace {

void expectClosed(const Mesh& mesh, const char* what, uint64_t which = 0) {
    for (const MeshFigures& f : {measure(mesh), measureWelded(mesh)}) {
        ASSERT_EQ(f.boundaryEdges, 0u) << what << ' ' << which;
        ASSERT_EQ(f.nonmanifoldEdges, 0u) << what << ' ' << which;
        ASSERT_EQ(f.vertices, mesh.vertexCount()) << what << ' ' << which << ": vertices coincide or are unused";
    }
}

/// Errors of volume and area at two resolutions must shrink like the square of the cell.
void expectSecondOrder(const Scene& scene, double volume, double area, int coarse, double leastRatio) {
    double volumeError[2], areaError[2];
    for (int i = 0; i < 2; ++i) {
        const BuiltMesh m = meshOf(scene, coarse << i);
        ASSERT_TRUE(m.mesh.ok());
        expectClosed(*m.mesh, "closed form");
        const MeshFigures f = measure(*m.mesh);
        EXPECT_EQ(f.components, 1u);
        volumeError[i] = std::abs(f.volume_m3 - volume) / volume;
        areaError[i] = std::abs(f.area_m2 - area) / area;
    }
    EXPECT_LT(volumeError[1], 2e-3);
    EXPECT_LT(areaError[1], 1e-2);
    EXPECT_GT(volumeError[0] / volumeError[1], leastRatio);
    EXPECT_GT(areaError[0] / areaError[1], leastRatio * 0.8);
}

TEST(Polygonize, SphereConvergesAtSecondOrder) { expectSecondOrder(ballScene(), 4 * pi / 3, 4 * pi, 40, 3.7); }

TEST(Polygonize, TorusConvergesAtSecondOrder) {
    Scene s;
    s.field = torus(s.graph, 1, 0.35f);
    expectSecondOrder(s, 2 * pi * pi * 0.35 * 0.35, 4 * pi * pi * 0.35, 60, 3.6);
    EXPECT_EQ(measure(*meshOf(s, 60).mesh).euler, 0);
}

TEST(Polygonize, WhatIsFarFromTheSurfaceIsDroppedAndNothingShows) {
    // Without a Lipschitz constant all values have to be told apart.
    for (uint64_t key = 0; key < 6; ++key) {
        Scene s = cloudScene(60, 0.1f, key);
        const field::Field hole = ball(s.graph, {0.5f, 0.5f, 0.5f}, 0.3f),
                           slab = box(s.graph, {0.4f, 0.5f, 0.5f}, {0.1f, 0.7f, 0.1f});
        const field::Owned holes[] = {{hole, 100}, {slab, 101}};
        s.field = field::difference({s.field, 0}, {field::sum(s.graph, holes), 0});
        if (key % 2 == 1) s.field.value = s.field.value * 3.0f, s.field.lipschitz = 3;
        const BuiltMesh known = meshOf(s, 40);
        s.field.lipschitz = std::numeric_limits<float>::infinity();
        const BuiltMesh unknown = meshOf(s, 40);
        ASSERT_TRUE(known.mesh.ok() && unknown.mesh.ok());
        EXPECT_EQ(bytesOf(*known.mesh), bytesOf(*unknown.mesh)) << key;
        size_t length[2] = {};
        for (const bool all : {false, true}) {
            s.field.lipschitz = all ? std::numeric_limits<float>::infinity() : key % 2 == 1 ? 3.0f : 1.0f;
            Counts counts;
            const auto blocks = subdivide(s.tape(), known.grid, 1, nullptr, counts);
            for (const Block& b : *blocks) length[all] += b.tape.size();
        }
        // Through a product nothing is passed down.
        if (key % 2 == 0) {
            EXPECT_LT(2 * length[false], length[true]);
        }
    }
}

TEST(Polygonize, BoxIsExactUpToItsBevelledEdges) {
    // Faces are met exactly; what is lost lies within a cell of the 12 edges, so it goes with cell².
    Scene s;
    s.field = box(s.graph, {0, 0, 0}, {1, 0.7f, 0.4f});
    double error[2];
    for (int i = 0; i < 2; ++i) {
        const BuiltMesh m = meshOf(s, 50 << i);
        expectClosed(*m.mesh, "box");
        error[i] = 8 * 0.7 * 0.4 - measure(*m.mesh).volume_m3;
    }
    EXPECT_GT(error[1], 0);
    EXPECT_LT(error[1], 1e-3);
    EXPECT_GT(error[0] / error[1], 3.0);
}

TEST(Polygonize, VerticesLieOnTheSurfaceAndInsideTheirEdges) {
    const Scene s = ballScene();
    const BuiltMesh m = meshOf(s, 70);
    for (const Chunk& c : m.mesh.value().chunks)
        for (size_t i = 0; i < c.positions.size(); ++i) {
            const Vec3f p = c.positions[i];
            const Vec3d out = p.as<double>() - Vec3d{0.1, -0.2, 0.3};
            int moving = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double at = (double(p[axis]) - m.grid.origin[axis]) / m.grid.cell_m, nearest = std::round(at);
                if (std::abs(at - nearest) < edgeMargin * 0.5) continue;
                ++moving;
                EXPECT_GE(std::abs(at - nearest), edgeMargin * 0.98);
            }
            ASSERT_EQ(moving, 1);
            EXPECT_NEAR(length(out), 1, 1.01 * edgeMargin * m.grid.cell_m);
            EXPECT_GT(dot(normalized(out), c.normals[i].as<double>()), 0.9999);
        }
}

TEST(Polygonize, RefinementBeatsTheLineBetweenSamples) {
    // A cubed distance is far from straight along an edge.
    Scene s;
    const field::NodeRef d = field::length(s.graph.position()) - 1.0f;
    s.field = {d * square(d + 0.5f) * 3.0f, {{-1, -1, -1}, {1, 1, 1}}, 40, 0};
    double worst[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        PolygonizeOptions options;
        options.refineSteps = i ? 3 : 0;
        const BuiltMesh m = meshOf(s, 24, 1, options);
        EXPECT_EQ(m.counts.refinementEvaluations > 0, i == 1);
        for (const Chunk& c : m.mesh.value().chunks)
            for (const Vec3f& p : c.positions)
                worst[i] = std::max(worst[i], std::abs(length(p.as<double>()) - 1) / m.grid.cell_m);
    }
    EXPECT_GT(worst[0], 0.02);
    EXPECT_LT(worst[1], 0.0021);
}

TEST(Polygonize, WithoutRefinementAVertexLiesWhereThePaperPutsIt) {
    // SG-M III-G: densities 0.1 and −0.3 at the ends of an edge put its vertex at 25 % of it.
    Scene s;
    const auto vertexOn = [&](float inside, float outside, float from) {
        // Along x the field is `inside` at `from` and `outside` a cell further, with a bend between that must not show.
        const field::NodeRef t = s.graph.x() - from;
        const field::NodeRef f = t * (outside - inside) + inside + t * (t - 1.0f);
        s.field = {max(max(f, abs(s.graph.y()) - 1.5f), max(abs(s.graph.z()) - 1.5f, -1.0f - t)), {}, 8, 0};
        const BuiltMesh m = meshOf(s.tape(), {{-4, -4, -4}, 1, {8, 8, 8}}, 1, {.refineSteps = 0});
        float x = std::numeric_limits<float>::quiet_NaN();
        for (const Chunk& c : m.mesh.value().chunks)
            for (const Vec3f& p : c.positions)
                if (p.y == 0 && p.z == 0 && p.x > from) x = p.x;
        return x - from;
    };
    EXPECT_FLOAT_EQ(vertexOn(-0.1f, 0.3f, 1), 0.25f);
    EXPECT_FLOAT_EQ(vertexOn(-0.3f, 0.1f, 1), 0.75f);
    EXPECT_FLOAT_EQ(vertexOn(-0.3f, 0.3f, 0), 0.5f);
}

TEST(Polygonize, NormalsOfAFieldWithoutDerivativeComeFromTheFaces) {
    Scene s;
    s.field = {floor(field::length(s.graph.position())) - 0.5f, {{-1, -1, -1}, {1, 1, 1}}, 100, 0};
    const BuiltMesh m = meshOf(s, 64);
    ASSERT_GT(m.mesh.value().triangleCount(), 1000u);
    for (const Chunk& c : m.mesh->chunks)
        for (size_t i = 0; i < c.normals.size(); ++i) {
            EXPECT_NEAR(length(c.normals[i]), 1, 1e-5);
            EXPECT_GT(dot(c.normals[i], normalized(c.positions[i])), 0.8f);
        }
}

TEST(Polygonize, LayerByLayerTheChunksAreTheSame) {
    Scene steps;  // without derivative: normals come from triangles, also from those of other layers
    steps.field = {floor(field::length(steps.graph.position())) - 0.5f, {{-1, -1, -1}, {1, 1, 1}}, 100, 0};
    Scene apart;  // with layers in between where nothing is
    const std::array<field::Field, 2> balls{ball(apart.graph, {0, 0, -3}, 1), ball(apart.graph, {0.5f, 0, 3}, 1)};
    apart.field = {min(balls[0].value, balls[1].value), hull(balls[0].bounds, balls[1].bounds), 1, 1};
    const Scene cloud = cloudScene(60, 0.12f, 5);
    for (const Scene* s : std::initializer_list<const Scene*>{&steps, &apart, &cloud}) {
        const Grid grid = gridFor(s->field.bounds, cellFor(s->field.bounds, 150));
        Counts counts;
        const auto blocks = subdivide(s->tape(), grid, 2, nullptr, counts);
        const Mesh whole = *polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
        Mesh streamed;
        size_t most = 0;
        const Status done = polygonizeInLayers(*blocks, grid, {.threads = 2}, nullptr, counts,
                                               [&](const Mesh& window, const Chunk& chunk) -> Status {
                                                   streamed.chunks.push_back(chunk);
                                                   most = std::max(most, window.chunks.size());
                                                   return Done{};
                                               });
        ASSERT_TRUE(done.ok());
        EXPECT_EQ(bytesOf(streamed), bytesOf(whole));
        EXPECT_LT(most, whole.chunks.size());
    }
}

TEST(Polygonize, ABareMeshIsTheShapeOfAFullOne) {
    Scene steps;  // without derivative
    steps.field = {floor(field::length(steps.graph.position())) - 0.5f, {{-1, -1, -1}, {1, 1, 1}}, 100, 0};
    const Scene one = ballScene();      // one tape and one owner
    const Scene expensive = fractal();  // refined by values
    const Scene cloud = cloudScene(60, 0.12f, 5);
    for (const Scene* s : std::initializer_list<const Scene*>{&steps, &one, &expensive, &cloud})
        for (const int refineSteps : {0, 1, 3}) {
            Mesh full = *meshOf(*s, 90, 2, {.refineSteps = refineSteps}).mesh;
            const Mesh positionsOnly = *meshOf(*s, 90, 2, {.refineSteps = refineSteps, .positionsOnly = true}).mesh;
            EXPECT_TRUE(positionsOnly.hasPositionsOnly());
            EXPECT_FALSE(full.hasPositionsOnly());
            EXPECT_GT(positionsOnly.triangleCount(), 1000u);
            for (Chunk& c : full.chunks) c.normals.clear(), c.origins.clear();
            EXPECT_EQ(bytesOf(positionsOnly), bytesOf(full)) << refineSteps;
            for (const Chunk& c : positionsOnly.chunks) EXPECT_TRUE(c.faceted.empty());
        }
}

TEST(Polygonize, CountsStayBelowTwentySamplesASurfaceCell) {
    const BuiltMesh m = meshOf(cloudScene(60, 0.12f, 5), 200);
    ASSERT_TRUE(m.mesh.ok());
    EXPECT_LT(double(m.counts.pointEvaluations), 20.0 * double(m.counts.surfaceCells));
    EXPECT_GT(m.counts.intervalEvaluations, 64u);
}

TEST(Polygonize, SameBytesAtAnyThreadCount) {
    const Scene s = cloudScene(80, 0.15f, 3);
    const auto one = bytesOf(*meshOf(s, 110, 1).mesh);
    EXPECT_GT(one.size(), 100000u);
    EXPECT_EQ(one, bytesOf(*meshOf(s, 110, 2).mesh));
    EXPECT_EQ(one, bytesOf(*meshOf(s, 110, 5).mesh));
}

TEST(Polygonize, BlocksMeetWithoutCracks) {
    const BuiltMesh m = meshOf(cloudScene(40, 0.2f, 11), 150);
    ASSERT_TRUE(m.mesh.ok());
    EXPECT_GT(m.mesh->chunks.size(), 30u);
    expectClosed(*m.mesh, "cloud");
    for (size_t i = 1; i < m.mesh->chunks.size(); ++i)
        EXPECT_EQ(m.mesh->chunks[i].firstVertex,
                  m.mesh->chunks[i - 1].firstVertex + m.mesh->chunks[i - 1].positions.size());
}

/// Sums of waves far finer than the cells: in effect a random sign at each corner.
Scene noiseScene(uint64_t key, double finest) {
    Scene s;
    field::NodeRef f = s.graph.literal(static_cast<float>(uniform(combine(key, 99), -0.5, 0.5)));
    for (uint64_t wave = 0; wave < 3; ++wave) {
        const auto draw = [&](uint64_t i) {
            return static_cast<float>(uniform(combine(combine(key, wave), i), -finest, finest));
        };
        f = f + sin(s.graph.x() * draw(1) + s.graph.y() * draw(2) + s.graph.z() * draw(3) + draw(4));
    }
    s.field = {f, {{-1, -1, -1}, {1, 1, 1}}, static_cast<float>(6 * finest), 0};
    return s;
}

/// Balls and boxes joined, cut, blended and morphed at random.
Scene solidScene(uint64_t key) {
    Scene s;
    const auto draw = [&](uint64_t i, double lo, double hi) {
        return static_cast<float>(uniform(combine(key, i), lo, hi));
    };
    const auto part = [&](uint64_t i) {
        const Vec3f at{draw(10 * i + 1, -1, 1), draw(10 * i + 2, -1, 1), draw(10 * i + 3, -1, 1)};
        if (draw(10 * i + 4, 0, 1) < 0.5f) return ball(s.graph, at, draw(10 * i + 5, 0.1, 0.8));
        return box(s.graph, at,
                   {draw(10 * i + 5, 0.02, 0.8), draw(10 * i + 6, 0.02, 0.8), draw(10 * i + 7, 0.02, 0.8)});
    };
    s.field = part(1);
    for (uint64_t i = 2; i < 6; ++i) {
        const field::Field other = part(i);
        const auto origin = static_cast<OriginId>(i);
        const field::Owned both[] = {{s.field, 0}, {other, origin}};
        switch (pick(combine(key, 1000 + i), 5)) {
            case 0:
                s.field = field::difference({s.field, 0}, {other, origin});
                break;
            case 1:
                s.field = field::blend(s.graph, both, s.graph.literal(0.2f), 0.2);
                break;
            case 2:
                s.field = field::morph(s.field, other, s.graph.literal(0.4f), 0.4, origin);
                break;
            default:
                s.field = field::sum(s.graph, both);
        }
    }
    return s;
}

TEST(Polygonize, TenThousandRandomFieldsAreClosedAndManifold) {
    uint64_t meshes = 0;
    for (uint64_t i = 0; i < 10000; ++i) {
        BuiltMesh m;
        if (i % 2 == 0) {
            const Scene s = noiseScene(i, i % 4 == 0 ? 300 : 20);
            // The field doesn't keep to its box here: the grid's border has to close it.
            m = meshOf(s.tape(), {{-1, -1, -1}, 0.25f, {8, 8, 7 + int(i % 3)}}, 1);
        } else {
            m = meshOf(solidScene(i), 4 + int(pick(i, 12)), 1);
        }
        ASSERT_TRUE(m.mesh.ok());
        expectClosed(*m.mesh, "field", i);
        meshes += m.mesh->triangleCount() > 0;
    }
    EXPECT_GT(meshes, 9000u);
}

TEST(Polygonize, RandomSignsAcrossBlocksAreClosed) {
    for (uint64_t i = 0; i < 4; ++i) {
        const BuiltMesh m = meshOf(noiseScene(i, 400).tape(), {{-1, -1, -1}, 0.05f, {40, 37, 41}}, 2);
        ASSERT_TRUE(m.mesh.ok());
        EXPECT_GT(m.mesh->triangleCount(), 20000u);
        expectClosed(*m.mesh, "noise", i);
    }
}

TEST(Polygonize, FlatFacesOnSamplesLeaveNoDegenerateTriangles) {
    Scene s;
    s.field = box(s.graph, {0, 0, 0}, {1, 1, 1});
    const BuiltMesh m = meshOf(s.tape(), {{-2, -2, -2}, 0.25f, {16, 16, 16}}, 1);
    ASSERT_TRUE(m.mesh.ok());
    expectClosed(*m.mesh, "box on samples");
    // Only bevels are missing: of one cell at 12 edges, each 2 m long.
    EXPECT_LT(measure(*m.mesh).volume_m3, 8);
    EXPECT_GT(measure(*m.mesh).volume_m3, 8 - 12 * 2 * 0.25 * 0.25 / 2);
}

TEST(Polygonize, EveryTriangleKnowsItsOwner) {
    // Two balls side by side: each triangle away from the seam belongs to the nearer one.
    Scene s;
    const field::Owned parts[] = {{ball(s.graph, {-0.6f, 0, 0}, 1), 7}, {ball(s.graph, {0.6f, 0, 0}, 1), 3}};
    s.field = field::sum(s.graph, parts);
    const BuiltMesh m = meshOf(s, 80);
    std::set<OriginId> seen;
    std::vector<Vec3f> at;
    for (const Chunk& c : m.mesh.value().chunks) at.insert(at.end(), c.positions.begin(), c.positions.end());
    for (const Chunk& c : m.mesh.value().chunks) {
        ASSERT_EQ(c.origins.size(), c.triangles.size());
        for (size_t i = 0; i < c.triangles.size(); ++i) {
            const Triangle t = c.inMesh(c.triangles[i]);
            const int left = (at[t.x].x < 0) + (at[t.y].x < 0) + (at[t.z].x < 0);
            EXPECT_EQ(c.origins[i], left >= 2 ? 7u : 3u);
            seen.insert(c.origins[i]);
        }
    }
    EXPECT_EQ(seen.size(), 2u);
}

TEST(Polygonize, EmptyFieldsGiveEmptyMeshes) {
    Scene s;
    s.field = field::nothing(s.graph);
    EXPECT_EQ(meshOf(s, 64).mesh.value().triangleCount(), 0u);
    EXPECT_EQ(meshOf(s.tape(), {{0, 0, 0}, 1, {64, 64, 64}}).mesh.value().triangleCount(), 0u);
}

TEST(Polygonize, StopsWithinFiftyMilliseconds) {
    const Scene s = cloudScene(3000, 0.05f, 9);
    const eval::Tape tape = s.tape();
    const Grid grid = gridFor(s.field.bounds, cellFor(s.field.bounds, 600));
    const double most_s = boundSeconds(.1);  // on two threads
    const double late_s = leastSecondsToStop(
        most_s, CLOCK_PROCESS_CPUTIME_ID,
        [](const Progress& progress) {
            return std::strcmp(progress.stage(), "sample") == 0 && progress.fraction() >= .02;
        },
        [&](Progress& progress) {
            Counts counts;
            const auto blocks = subdivide(tape, grid, 2, &progress, counts);
            ASSERT_TRUE(blocks.ok());
            const auto mesh = polygonize(*blocks, grid, {}, &progress, counts);
            ASSERT_FALSE(mesh.ok());
            EXPECT_EQ(mesh.error().kind, Error::Kind::Cancelled);
        });
    EXPECT_LT(late_s, most_s);
}

}  // namespace
}  // namespace sgm::mesh
