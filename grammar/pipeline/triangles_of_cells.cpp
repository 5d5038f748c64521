#include "grammar/pipeline/triangles_of_cells.h"

#include "grammar/lower/mesh_positions.h"

namespace sgm::pipeline {

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
