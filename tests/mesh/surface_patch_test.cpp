// Parts of a surface, exchanged: what stays is as it was, bit for bit.
#include "modeler/mesh/surface_patch.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "modeler/mesh/cell_seams.h"
#include "modeler/mesh/one_chunk.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

/// A crisp mesh of one chunk, with normals of corners along its creases.
struct OneChunk {
    Chunk chunk;
    Grid grid;
};
OneChunk surface() {
    const BuiltMesh built = meshOf(cloudScene(12, .3f, 5), 24, 2, {.surface = Surface::Crisp});
    OneChunk made{joinChunks(*built.mesh), built.grid};
    dropUnusedVertices(made.chunk);
    EXPECT_FALSE(made.chunk.cornerNormals.empty());
    return made;
}

std::vector<unsigned char> bytesOfChunk(const Chunk& chunk) {
    Mesh mesh;
    mesh.chunks.push_back(chunk);
    return bytesOf(mesh);
}

std::vector<uint32_t> everyThird(const Chunk& whole, uint32_t first) {
    std::vector<uint32_t> some;
    for (uint32_t t = first; t < whole.triangles.size(); t += 3) some.push_back(t);
    return some;
}

TEST(SurfacePatch, PutBackAsItIsChangesNothing) {
    const Chunk whole = surface().chunk;
    for (const uint32_t first : {0u, 1u, 2u}) {
        const SurfacePatch patch(whole, everyThird(whole, first));
        ReplacedPatch same{patch.surface, {}};
        for (uint32_t t = 0; t < patch.triangles.size(); ++t) same.triangleOf.push_back(t);
        EXPECT_EQ(bytesOfChunk(withReplaced(whole, patch, same)), bytesOfChunk(whole)) << first;
    }
}

TEST(SurfacePatch, LeavesOutVerticesThatHaveNoTriangleAnyMore) {
    const Chunk whole = surface().chunk;
    std::vector<uint32_t> kept, all;
    for (uint32_t t = 0; t < whole.triangles.size(); ++t) {
        all.push_back(t);
        if (t % 5 == 0) kept.push_back(t);
    }
    const SurfacePatch patch(whole, all), rest(whole, kept);
    ReplacedPatch few{patch.surface, kept};
    few.surface.triangles.clear(), few.surface.origins.clear(), few.surface.labels.clear();
    few.surface.cornerNormals.clear();
    visitTriangles(patch.surface, [&](uint32_t t, std::span<const CornerNormal> normals) {
        if (t % 5 != 0) return;
        const auto triangle = static_cast<uint32_t>(few.surface.triangles.size());
        few.surface.triangles.push_back(patch.surface.triangles[t]);
        few.surface.origins.push_back(patch.surface.origins[t]);
        few.surface.labels.push_back(patch.surface.labels[t]);
        for (const CornerNormal& n : normals)
            few.surface.cornerNormals.push_back({3 * triangle + n.corner % 3, n.normal});
    });
    EXPECT_EQ(bytesOfChunk(withReplaced(whole, patch, few)), bytesOfChunk(rest.surface));
}

TEST(SurfacePatch, NewTrianglesAndVerticesComeLast) {
    const Chunk whole = surface().chunk;
    const SurfacePatch patch(whole, everyThird(whole, 1));
    ReplacedPatch more{patch.surface, {}};
    for (uint32_t t = 0; t < patch.triangles.size(); ++t) more.triangleOf.push_back(t);
    const auto added = static_cast<uint32_t>(more.surface.positions.size());
    more.surface.positions.push_back({9, 9, 9}), more.surface.normals.push_back({0, 1, 0});
    more.surface.triangles.push_back({0, 1, added});
    more.surface.origins.push_back(7), more.surface.labels.push_back(8);
    const Chunk made = withReplaced(whole, patch, more);
    ASSERT_EQ(made.positions.size(), whole.positions.size() + 1);
    ASSERT_EQ(made.triangles.size(), whole.triangles.size() + 1);
    EXPECT_EQ(made.triangles.back(),
              (Triangle{patch.vertices[0], patch.vertices[1], static_cast<uint32_t>(whole.positions.size())}));
    EXPECT_EQ(made.origins.back(), 7u);
    EXPECT_EQ(made.labels.back(), 8u);
}

TEST(SurfaceInCells, SortsTrianglesAsTheyAreAskedFor) {
    const OneChunk made = surface();
    std::map<std::tuple<int, int, int>, std::vector<uint32_t>> expected;
    for (auto t = static_cast<uint32_t>(made.chunk.triangles.size()); t-- > 0;) {
        const Vec3i cell = cellOf(made.grid, made.chunk.positions, made.chunk.triangles[t]);
        expected[{cell.z, cell.y, cell.x}].push_back(t);
    }
    SurfaceInCells cells(made.chunk, made.grid);
    cells.follow();
    for (int z = 0; z < made.grid.cells.z; ++z)
        for (int y = 0; y < made.grid.cells.y; ++y)
            for (int x = 0; x < made.grid.cells.x; ++x) {
                std::vector<uint32_t> found;
                cells.visit({x, y, z}, [&](uint32_t t) { found.push_back(t); });
                const auto known = expected.find({z, y, x});
                EXPECT_EQ(found, known == expected.end() ? std::vector<uint32_t>{} : known->second);
                EXPECT_EQ(cells.isEmpty({x, y, z}), found.empty());
            }
}

}  // namespace
}  // namespace sgm::mesh
