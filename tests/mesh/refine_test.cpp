// Halved cells in a mesh: what they show, and that nothing gapes around them.
#include "modeler/mesh/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/field/solids.h"
#include "modeler/mesh/components.h"
#include "modeler/mesh/fine_cells.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

const PolygonizeOptions crisp{.surface = Surface::Crisp};

field::Field block(field::Graph& g, Vec3f centre, Vec3f half, double degrees = 0) {
    const double a = degrees * M_PI / 180;
    const auto c = static_cast<float>(std::cos(a)), s = static_cast<float>(std::sin(a));
    const field::Point p = shifted(g, centre);
    const field::Point turned{p.x * g.literal(c) + p.z * g.literal(s), p.y, p.z * g.literal(c) - p.x * g.literal(s)};
    const float reach = std::max(length(half), .1f);
    const Box3f around{centre - Vec3f{reach, reach, reach}, centre + Vec3f{reach, reach, reach}};
    return {field::solids::boxDistance(turned, {g.slot(half.x), g.slot(half.y), g.slot(half.z)}), around, 1, 0.5f};
}

/// All cells that a box meets, and those around them.
CellSet cellsIn(const Grid& grid, const Box3f& box) {
    CellSet cells;
    const Vec3i lo = cellAt(grid, box.lo.as<double>()), hi = cellAt(grid, box.hi.as<double>());
    for (int z = lo.z - 1; z <= hi.z + 1; ++z)
        for (int y = lo.y - 1; y <= hi.y + 1; ++y)
            for (int x = lo.x - 1; x <= hi.x + 1; ++x) cells.insert({x, y, z});
    return cells;
}

/// A mesh of `cells` of the grid, with some of them halved.
struct Refined {
    Mesh mesh;
    Grid grid;
    CellSet cells;
};
Refined refined(const Scene& scene, int resolution, const Box3f& box, int halvings, int threads = 2) {
    const eval::Tape tape = scene.tape();
    BuiltMesh coarse = meshOf(scene, resolution, threads, crisp);
    EXPECT_TRUE(coarse.mesh.ok());
    Refined made{std::move(*coarse.mesh), coarse.grid, {}};
    auto fine =
        refineCells(made.mesh, tape, made.grid, cellsIn(made.grid, box), {halvings, ~size_t{0}, threads}, nullptr);
    EXPECT_TRUE(fine.ok());
    if (!fine.ok() || !fine->made) return made;
    EXPECT_FALSE(fine->isBounded);
    made.mesh = std::move(fine->made->mesh), made.cells = std::move(fine->made->cells);
    const auto word = validate(made.mesh);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects) << resolution << ' ' << halvings;
    return made;
}

/// A block on which a fin stands that is thinner than a cell.
Scene finned(double degrees) {
    Scene s;
    s.field =
        field::sum(s.graph, std::vector<field::Owned>{{block(s.graph, {}, {1, .5f, 1}, degrees), 1},
                                                      {block(s.graph, {0, .75f, 0}, {.6f, .3f, .02f}, degrees), 2}});
    return s;
}
constexpr double finnedVolume = 4 * .5 * 2 + 1.2 * .04 * .55;
const Box3f fin{{-.7f, .4f, -.7f}, {.7f, 1.1f, .7f}};

TEST(Refine, AFinThinnerThanACellIsLostInCellsAsTheyAre) {
    EXPECT_GT(std::abs(measure(*meshOf(finned(0), 20, 2, crisp).mesh).volume_m3 - finnedVolume), .02);
}

TEST(Refine, AFinThinnerThanACellIsThere) {
    for (const double degrees : {0.0, 12.0, 45.0})
        for (const int resolution : {20, 33}) {
            const Scene scene = finned(degrees);
            const Refined fine = refined(scene, resolution, fin, 3);
            EXPECT_FALSE(fine.cells.empty());
            EXPECT_NEAR(measure(fine.mesh).volume_m3, finnedVolume, 2e-3) << degrees << ' ' << resolution;
        }
}

TEST(Refine, ABallHalfOfWhichIsFinerStaysClosed) {
    for (const int halvings : {1, 2, 3}) {
        const Scene scene = ballScene();
        const Refined made = refined(scene, 24, {{-2, -2, -2}, {.1f, 2, 2}}, halvings);
        EXPECT_FALSE(made.cells.empty());
        const eval::Tape tape = scene.tape();
        eval::Workspace w;
        for (const Vec3f& p : made.mesh.chunks.at(0).positions) {
            float f;
            eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &f, w);
            EXPECT_LT(std::abs(f), 2e-3f * made.grid.cell_m) << halvings;
        }
        for (const Triangle& t : made.mesh.chunks[0].triangles) {
            const Vec3f n = made.mesh.chunks[0].normals[t.x];
            EXPECT_GT(dot(n, made.mesh.chunks[0].positions[t.x] - Vec3f{.1f, -.2f, .3f}), .99f);
        }
    }
}

/// The cells end amid the fin: more are taken until what stays shows the same as they do.
TEST(Refine, CellsGrowAlongWhatTheyCut) {
    const Box3f half{{-.7f, .4f, -.1f}, {0, 1.1f, .1f}};
    const Refined made = refined(finned(0), 20, half, 3);
    size_t beyond = 0;
    for (const Vec3i cell : made.cells.list()) beyond += made.grid.corner(cell.x, cell.y, cell.z).x > .2f;
    EXPECT_GT(beyond, 10u);
    EXPECT_NEAR(measure(made.mesh).volume_m3, finnedVolume, 2e-3);
}

TEST(Refine, AgainWithSmallerCellsInside) {
    Refined made = refined(finned(0), 20, fin, 1);
    const auto fine = refineCells(made.mesh, finned(0).tape(), made.grid, cellsIn(made.grid, fin), {3}, nullptr);
    ASSERT_TRUE(fine.ok() && fine->made);
    const auto word = validate(fine->made->mesh);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects);
    EXPECT_NEAR(measure(fine->made->mesh).volume_m3, finnedVolume, 2e-3);
}

TEST(Refine, GivesTheSameBytesAtAnyThreadCount) {
    EXPECT_EQ(bytesOf(refined(finned(12), 20, fin, 2, 1).mesh), bytesOf(refined(finned(12), 20, fin, 2, 3).mesh));
}

TEST(Refine, DoesNothingBeyondItsBoundOfTriangles) {
    const BuiltMesh coarse = meshOf(finned(0), 20, 2, crisp);
    const size_t bound = coarse.mesh->triangleCount() + 4;  // halving a cell adds eight at least
    const auto fine =
        refineCells(*coarse.mesh, finned(0).tape(), coarse.grid, cellsIn(coarse.grid, fin), {3, bound}, nullptr);
    ASSERT_TRUE(fine.ok());
    EXPECT_FALSE(fine->made);
    EXPECT_TRUE(fine->isBounded);
}

TEST(Refine, HalvesTheFirstCellsThatItsBoundAllows) {
    const CellSet wanted = cellsIn(meshOf(finned(0), 20, 2, crisp).grid, fin);
    const BuiltMesh coarse = meshOf(finned(0), 20, 2, crisp);
    const size_t bound = coarse.mesh->triangleCount() + 100;
    const auto fine = refineCells(*coarse.mesh, finned(0).tape(), coarse.grid, wanted, {3, bound}, nullptr);
    ASSERT_TRUE(fine.ok() && fine->made);
    EXPECT_TRUE(fine->isBounded);
    const auto all = std::count_if(wanted.list().begin(), wanted.list().end(),
                                   [&](Vec3i cell) { return fine->made->cells.contains(cell); });
    EXPECT_GT(all, 0);
    EXPECT_LT(static_cast<size_t>(all), wanted.size());
    const auto judged = validate(fine->made->mesh);
    EXPECT_TRUE(judged.ok() && judged->closed && !judged->selfIntersects);
}

TEST(Refine, IsCancelled) {
    const BuiltMesh coarse = meshOf(finned(0), 20, 2, crisp);
    Progress progress;
    progress.cancel();
    const auto fine =
        refineCells(*coarse.mesh, finned(0).tape(), coarse.grid, cellsIn(coarse.grid, fin), {2}, &progress);
    ASSERT_FALSE(fine.ok());
    EXPECT_EQ(fine.error().kind, Error::Kind::Cancelled);
}

/// The triangles of a surface by the places of their corners, in an order that hangs on nothing else.
std::vector<std::array<float, 9>> trianglesByPlace(const Chunk& surface) {
    std::vector<std::array<float, 9>> all;
    for (const Triangle& t : surface.triangles) {
        const std::array<Vec3f, 3> p{surface.positions[t.x], surface.positions[t.y], surface.positions[t.z]};
        all.push_back({p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z});
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Cells come in several steps, each of which meshes bricks that share vertices with those before.
TEST(FineCells, AreTheSameSurfaceHoweverManyAreAddedAtATime) {
    for (const int halvings : {1, 2, 3})
        for (const double degrees : {0.0, 12.0}) {
            const Scene scene = finned(degrees);
            const eval::Tape tape = scene.tape();
            const Grid grid = gridFor(scene.field.bounds, cellFor(scene.field.bounds, 20));
            const std::vector<Vec3i> cells = cellsIn(grid, {{-2, -2, -2}, {2, 2, 2}}).list();
            FineCells whole(tape, grid, halvings, 2, nullptr), inSteps(tape, grid, halvings, 2, nullptr);
            ASSERT_TRUE(whole.add(cells));
            for (size_t step = 0; step < 7; ++step) {
                std::vector<Vec3i> some;
                for (size_t i = step; i < cells.size(); i += 7) some.push_back(cells[i]);
                ASSERT_TRUE(inSteps.add(some));
            }
            EXPECT_EQ(trianglesByPlace(inSteps.surface()), trianglesByPlace(whole.surface()));
            Mesh mesh;
            mesh.chunks.push_back(inSteps.surface());
            const auto word = validate(mesh);
            EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects)
                << halvings << ' ' << degrees;
        }
}

TEST(FineCells, MeshNoMoreThanTheCellsAndThoseAcrossBlocks) {
    const Scene scene = ballScene();
    const eval::Tape tape = scene.tape();
    const Grid grid = gridFor(scene.field.bounds, cellFor(scene.field.bounds, 24));
    FineCells fine(tape, grid, 1, 2, nullptr);
    const std::vector<Vec3i> cells = cellsIn(grid, {{-2, -2, -2}, {2, 2, 2}}).list();
    for (const Vec3i cell : cells) {
        if (cell.x % 16 == 0 || cell.x % 16 == 15 || cell.y % 16 != 8) continue;
        ASSERT_TRUE(fine.add({&cell, 1}));
    }
    ASSERT_FALSE(fine.surface().triangles.empty());
    for (const Triangle& t : fine.surface().triangles) EXPECT_EQ(cellOf(grid, fine.surface().positions, t).y % 16, 8);
}

TEST(FineCells, HaveTheCornersOfTheGridBitByBit) {
    const Grid grid = gridFor({{-7.3f, 1.1f, 1e4f}, {11.7f, 23.9f, 1.0003e4f}}, .1234567f);
    for (const int halvings : {1, 2, 3}) {
        const Grid fine = halved(grid, halvings);
        const int parts = 1 << halvings;
        for (int i = 0; i <= maxComponent(grid.cells); ++i)
            EXPECT_EQ(grid.corner(i, i, i), fine.corner(i * parts, i * parts, i * parts)) << i;
    }
}

TEST(CellSet, KnowsItsCellsAndTheirComponents) {
    CellSet cells, others;
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(cells.insert({i, i, i}));
    EXPECT_FALSE(cells.insert({2, 2, 2}));
    EXPECT_TRUE(cells.insert({9, 0, 0}));
    EXPECT_TRUE(cells.contains({4, 4, 4}));
    EXPECT_FALSE(cells.contains({4, 4, 3}));
    others.insert({5, 5, 4});
    EXPECT_EQ(componentsWithout(cells, others).list(), (std::vector<Vec3i>{{9, 0, 0}}));
    EXPECT_EQ(componentsWithout(cells, {}).size(), 6u);
}

TEST(CellNumbers, KeepTheNumberOfEachCell) {
    CellNumbers numbers;
    for (int i = 0; i < 3000; ++i) {
        EXPECT_EQ(numbers.find({i, -1, 7}), CellNumbers::none);
        numbers[{i, -1, 7}] = static_cast<uint32_t>(i);
    }
    for (int i = 0; i < 3000; ++i) EXPECT_EQ(numbers.find({i, -1, 7}), static_cast<uint32_t>(i));
}

TEST(CellAt, IsTheCellThatHoldsThePoint) {
    const Grid grid = gridFor({{-7.3f, 1.1f, 2.f}, {11.7f, 23.9f, 8.f}}, .1234567f);
    for (int i = 0; i < grid.cells.x; ++i) {
        const Vec3f low = grid.corner(i, 0, 0);
        EXPECT_EQ(cellAt(grid, low.as<double>()).x, i);
        EXPECT_EQ(cellAt(grid, {std::nextafter(static_cast<double>(grid.corner(i + 1, 0, 0).x), -1e9), 2, 3}).x, i);
    }
}

}  // namespace
}  // namespace sgm::mesh
