// The faces of a shape that rules can name: the sides and corners of a block, the slopes, eaves, gables and lines of a
// roof.
// Enters: a scope, its footprint and solid, and what is asked for, or a point of the surface. Leaves: boxes where
// newcomers stand, or one face with its words. Assumes that the scope's index is of that table.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grammar/derive/shape_tree.h"

namespace sgm::derive {

/// A face of a shape: a box about its middle, z outward, x from left to right seen from outside.
struct Face {
    Scope scope;
    Vec3d direction;  ///< zero where the newcomer's centre comes to it
    uint64_t key = 0;
};
/// The faces that `each(…)` means, in the order of the footprint's edges; none where the solid has no such faces.
/// O(edges²) on roofs, O(edges⁴) for their lines.
std::vector<Face> facesOf(const Scope& scope, const Footprints& footprints, const SolidValue* solid,
                          const rules::FaceChoice& choice);
/// Ridges, hips and valleys, which are known of roofs over field::mostRoofLineEdges edges at most.
bool isLine(rules::FaceChoice::Kind kind);

/// A face as rules call it.
struct NamedFace {
    std::string kind;                ///< "side", "top", "bottom", "slope", "eave", "gable"
    std::vector<std::string> words;  ///< of its edge: front, court, the words of its tag
    std::array<Vec3d, 4> corners;    ///< in the object's frame; of slopes as field::RoofFace has them
};
/// The face of a shape's own solid on which a point of the object's frame lies; nothing where the point is no part of a
/// flat face of a block, a cube or a roof.
std::optional<NamedFace> namedFaceAt(const ShapeTree& tree, ShapeId shape, Vec3d point);

}  // namespace sgm::derive
