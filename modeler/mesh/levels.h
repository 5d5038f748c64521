// Levels of detail: coarser meshes that stand for a model from afar.
// Enters: a mesh, and what meshes its field at larger cells. Leaves: meshes with fewer triangles. Assumes what
// mesh::simplify does.
#pragma once

#include <functional>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// A coarser mesh and how far it may be looked at from.
struct LevelOfDetail {
    Mesh mesh;
    double tolerance_m = 0;  ///< how far simplification may have moved its surface
    float cell_m = 0;        ///< of the cells it was meshed at, where these are larger than the finest mesh's; else 0
    double coverage = 1;     ///< of a picture's height: it stands for the model where that takes up to this share
};

/// How many levels there may be, the finest included.
inline constexpr int mostLevels = 8;

/// The share of a picture's height that a model takes at most where level `level`, from 1 on, stands for it: a half, a
/// quarter, an eighth, …
double levelCoverage(int level);

/// How far level `level`, from 1 on, may be off in a model of that longest side: a pixel of a picture of 1,080 lines in
/// which the model takes levelCoverage(level) of the height. It doubles from level to level.
double levelTolerance(double longestSide_m, int level);

struct LevelOptions {
    int count = 0;     ///< of levels beside the finest
    int threads = 1;   ///< 0: all the machine has; the result is the same for any number
    float cell_m = 0;  ///< of the finest mesh
    /// Meshes the field at cells of that size; null where there is none.
    std::function<Result<Mesh>(float cell_m)> meshAt = {};
};

/// Makes levels 1 … `count` of a mesh. Each is what has the fewest triangles: the level before it, simplified further;
/// the finest mesh, simplified to the level's tolerance; or, once cells of twice the tolerance are larger than the
/// finest mesh's, the field at such cells, simplified to half the tolerance. So parts of less than two pixels may
/// vanish, which simplification alone never takes. The errors of mesh::simplify and `meshAt`.
Result<std::vector<LevelOfDetail>> makeLevels(const Mesh& finest, const LevelOptions& options, Progress* progress);

}  // namespace sgm::mesh
