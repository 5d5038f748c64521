// Where something can grow on a roof over a footprint: its slopes, eaves, gables and its highest point, and the lines
// where slopes meet.
// Enters: a roof of the primitive table, its footprint and numbers. Leaves: places in metres. Assumes a sound footprint
// about the scope's centre. Slopes meet where the formula's leaves do, as those of the roof itself.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "modeler/field/plan_solids.h"

namespace sgm::field {

/// A box on a roof, upright, about the middle of a face.
struct RoofFace {
    enum class Kind : uint8_t {
        Slope,  ///< the middle of what rises over an edge; of broken roofs its lower part
        Eave,   ///< the middle of the board under a slope
        Gable,  ///< the wall over an edge that has no slope
        Apex    ///< the highest point
    };
    Kind kind = Kind::Slope;
    uint32_t edge = 0;    ///< as in edgesOf(); 0 of an apex
    plan::Vec2 at;        ///< in the plan
    plan::Vec2 outward;   ///< unit; of an apex +z
    double height_m = 0;  ///< above the roof's foot
    double width_m = 0;   ///< along the edge; of a slope where its middle is
    double rise_m = 0;    ///< from its lower to its upper end
    double run_m = 0;     ///< the same in plan
    /// x, height and z of its four corners, the lower two first: of slopes where they end beside the middle, two alike
    /// where the face ends in a point; of an apex all in it.
    std::array<Vec3d, 4> corners;
};

/// Whether faces of the row are known: a roof over a footprint.
bool isRoof(const Primitive& row);
/// The faces of a roof in the order of its edges, the apex last; curved roofs have an apex alone, flat ones none, and
/// a shed roof one slope. `height_m` is of the scope, for rows that fill it. `arguments` need their values alone.
/// O(n²).
std::vector<RoofFace> roofFaces(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                std::span<const Argument> arguments, double height_m);

/// The slope, eave or gable on which a point of the roof's surface lies, `above_m` over its foot: where the surface of
/// the slopes runs higher, what stands upright below it. Nothing on curved and flat roofs. O(n²).
std::optional<RoofFace> roofFaceAt(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                   std::span<const Argument> arguments, double height_m, plan::Vec2 at, double above_m);

/// A line where two slopes meet.
struct RoofLine {
    enum class Kind : uint8_t {
        Ridge,  ///< level; both slopes fall away from it
        Hip,    ///< rising; both fall away from it
        Valley  ///< both rise from it
    };
    Kind kind = Kind::Ridge;
    uint32_t edges[2] = {0, 0};  ///< over which the slopes rise, the lesser first; as in edgesOf()
    plan::Vec2 at;               ///< its middle in the plan
    plan::Vec2 along;            ///< unit, uphill in the plan; of a ridge either way
    double height_m = 0;         ///< of its middle above the roof's foot
    double rise_m = 0;           ///< from end to end
    double run_m = 0;            ///< the same in plan
};

/// Roofs over more edges than these have no lines: every pair of slopes is looked at.
inline constexpr size_t mostRoofLineEdges = 128;
/// The ridges, hips and valleys of a roof of planes, by pairs of edges, up to its eaves and gables; of broken roofs
/// those of the lower slopes. Curved roofs, pyramids and shed roofs have none. O(n⁴) at most.
std::vector<RoofLine> roofLines(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                std::span<const Argument> arguments);

}  // namespace sgm::field
