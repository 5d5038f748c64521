#include "grammar/pipeline/triangles_of_cells.h"

#include "grammar/lower/mesh_positions.h"

namespace sgm::pipeline {

double trianglesOfPart(const lower::ThinPart& part, double cell_m) {
    constexpr double cellsPerArea = 1.5;  // that a slanted plate meets, where it meets one along the grid
    constexpr double eachCell = 2;
    // Places of walls are found from both sides.
    const double sides = part.isWall() ? 1 : 2;
    double area_m2 = 0;  // from one side
    for (const derive::Scope& place : part.places)
        area_m2 += place.size.x * place.size.y * place.size.z / minComponent(place.size);
    return sides * eachCell * cellsPerArea * area_m2 / (cell_m * cell_m);
}

std::vector<uint32_t> countTriangles(const mesh::Mesh& mesh, const mesh::Grid& grid, const mesh::CellSet& cells) {
    mesh::CellNumbers numbers;
    for (uint32_t i = 0; i < cells.size(); ++i) numbers[cells.list()[i]] = i;
    std::vector<uint32_t> counts(cells.size());
    const std::vector<const Vec3f*> positions = lower::positionsOf(mesh);
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const mesh::Triangle& own : chunk.triangles) {
            const mesh::Triangle t = chunk.inMesh(own);
            const Vec3d sum =
                positions[t.x]->as<double>() + positions[t.y]->as<double>() + positions[t.z]->as<double>();
            const Vec3i cell = mesh::cellAt(grid, sum / 3.0);
            if (cells.contains(cell)) ++counts[numbers.find(cell)];
        }
    return counts;
}

}  // namespace sgm::pipeline
