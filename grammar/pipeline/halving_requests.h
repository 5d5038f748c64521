// Which cells of a mesh are to be halved for which parts, and what that takes.
// Enters: cells around parts, a mesh. Leaves: guesses of triangles. Assumes cells of the mesh's grid.
#pragma once

#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/mesh/cell_set.h"
#include "modeler/mesh/mesh.h"

namespace sgm::pipeline {

inline constexpr int mostHalvingsOfCells = 3;

/// Cells that are to be halved for a part.
struct HalvingRequest {
    /// Around the part, at its eaves, or beside a face.
    using Place = std::tuple<OriginId, bool, int>;
    Place place;
    std::vector<Vec3i> cells;
    double wholeTriangles = 0;  ///< of the part in cells that aren't halved; 0 of walls
};
/// By how often cells are to be halved.
using RequestsByHalvings = std::array<std::vector<HalvingRequest>, mostHalvingsOfCells + 1>;

/// The cells of all requests, each once, in the requests' order.
mesh::CellSet cellsOf(std::span<const HalvingRequest> asked);

/// Takes cells from requests that others want to be halved more often, and leaves out what is empty then.
void leaveOutFiner(RequestsByHalvings& asked);

/// About how many triangles more the mesh has where each request's cells are halved so often, without those of requests
/// before it. Nothing where all together take no more than `budget` at any rate. O(n) in the mesh.
std::vector<size_t> guessGrowth(std::span<const HalvingRequest> asked, const mesh::Mesh& mesh, const mesh::Grid& grid,
                                int halvings, size_t budget);

/// About how many triangles the cells that show some of the surface come to have, by how often they are halved.
using GrowthByHalvings = std::array<size_t, mostHalvingsOfCells + 1>;
/// The growth of what is asked for; each cell is in one list alone. O(n) in the mesh.
GrowthByHalvings growthBy(const RequestsByHalvings& asked, const mesh::Mesh& mesh, const mesh::Grid& grid);

/// The growth by so many times the requests, whose cells lie by chance among those of a mesh of `triangles`.
GrowthByHalvings multiplied(GrowthByHalvings growth, int times, size_t triangles);

/// How often all cells of a mesh of `triangles`, instead of those that are asked for, are halved with profit, at most
/// `most` times and to no more than `mostTriangles`: as a whole a mesh is made in a fourth of the time.
int halvingsOfAll(const GrowthByHalvings& growth, size_t triangles, int most, size_t mostTriangles);

}  // namespace sgm::pipeline
