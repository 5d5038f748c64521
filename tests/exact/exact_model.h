// What exact constructive solid geometry makes of a solid tree: triangles, creases, corners, borders.
// Enters: a .csg.json file. Leaves: figures and features, computed by tests/exact/exact.mjs (npm's manifold-3d) and
// kept in a folder, by content. Assumes the repository's root as the working folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "modeler/core/provenance.h"
#include "modeler/core/result.h"
#include "tests/exact/spatial.h"

namespace sgm::exact {

/// A straight piece of an edge whose faces turn by more than 10 degrees.
struct Crease {
    Segment segment;
    uint32_t chain = 0;  ///< pieces of one chain, from corner to corner, follow each other
    double degrees = 0;
    bool convex = false;
    Vec3d normals[2];  ///< unit, outward
};

/// A vertex where creases meet at an angle, or an apex.
struct Corner {
    Vec3d point;
    uint32_t creases = 0;
    double thickness_m = 0;  ///< least extent of the thinnest solid that meets there
};

struct ExactModel {
    int sides = 0;  ///< of round solids, inscribed
    double volume_m3 = 0, area_m2 = 0, crease_m = 0;
    int64_t euler = 0;  ///< V − E + F
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<Vec3d> points;
    std::vector<Corners> triangles;  ///< after the planar merge; the lists below have one entry for each
    std::vector<Vec3d> normals;      ///< of its plane: unit, outward, of slivers as well
    std::vector<OriginId> origins;   ///< where solids share a surface, of either
    std::vector<uint32_t> round;     ///< 1 where it is of a round solid, else 0
};

/// "" where node and manifold-3d are installed, else what to install.
std::string missingJudge();

/// Which of the solids that share a surface owns it.
enum class Owners {
    Either,  ///< the clean model
    First,   ///< the one that stands first in the tree; with films inside the solid, good for looking up owners alone
};

/// The exact model with round solids of `sides` sides, a multiple of 4. Files are kept in `folder` under a name made of
/// the tree's and the script's content. Error::Input with the script's own words where it fails.
Result<ExactModel> exactModel(const std::filesystem::path& csgJson, int sides, Owners owners,
                              const std::filesystem::path& folder);

/// Where two looks (colour, roughness, metal) meet on the surface of `model`, by the owners of `first`, the model of
/// the same tree and sides with Owners::First. Ends of borders along edges are found to 1e-4 m; what is shorter than 5
/// cm and ends within an edge may be missed.
std::vector<Segment> findBorders(const ExactModel& model, const ExactModel& first, const Provenance& provenance);

double lengthOf(const std::vector<Segment>& segments);

/// Materials that look alike have one number: the index of the first of them.
std::vector<uint32_t> looksOf(const Provenance& provenance);

}  // namespace sgm::exact
