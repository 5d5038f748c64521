// The signed distance to a closed mesh, as samples (Bridson, "Fluid Simulation for Computer Graphics", 2008: exact near
// the triangles, then the nearest triangle handed on from node to node; signs by counting crossings along rows).
// Enters: triangles anywhere, of any size. Leaves: a SampledGrid about the middle of their box, in their unit unless
// that is far too small or large for single precision. Assumes finite coordinates.
#pragma once

#include <filesystem>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/field/sampled_grid.h"
#include "modeler/mesh/mesh.h"
#include "modeler/mesh/triangle_soup.h"

namespace sgm::mesh {

/// Samples along the longest side.
inline constexpr int distanceCells = 128;

/// Negative where the mesh winds around a node: shells within shells, turned inside out, are hollows, and shells that
/// overlap are one solid. Error::Input when the mesh is open (with the place of a hole), flat, or inside out;
/// Error::Budget when its triangles lie over each other so often that it would take minutes.
Result<field::SampledGridPtr> toDistances(TriangleSoup soup, int cells = distanceCells,
                                          const Progress* progress = nullptr);
/// The same of a mesh of ours.
Result<field::SampledGridPtr> toDistances(const Mesh& mesh, int cells = distanceCells);

/// The distances to the mesh in a file (read.h). Messages begin with the file's name; `named` gets the paths of other
/// files that were opened for it.
Result<field::SampledGridPtr> readDistances(const std::filesystem::path& path, const Progress* progress = nullptr,
                                            std::vector<std::filesystem::path>* named = nullptr);

}  // namespace sgm::mesh
