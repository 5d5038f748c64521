// Roofs over footprints: one profile for all sides, or a pitch, a gable or a half-hip for each.
// Enters: a footprint as a field, heights along its y, angles in radians from the level. Leaves: Fields with |∇f| = 1
// almost everywhere, solid down to their eaves. Assumes pitches in (0, 89°]. Nothing fails: a roof over any sound
// footprint is closed, its eaves run along the outline and every plane belongs to an edge. For rectilinear plans the
// ridges are those of the straight skeleton; for others some stand a little beside it. Planes have labels of their own,
// so that ridges, valleys and eaves of crisp meshes are sharp.
#pragma once

#include <span>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/field/plan_field.h"

namespace sgm::field {

/// Where a roof begins.
struct RoofFoot {
    Quantity eaves;     ///< height at which slopes cross the outline, metres
    Quantity overhang;  ///< metres beyond the outline, ≥ 0; slopes go on down, gables stand that far out
    Quantity fascia;    ///< height of the upright board at the eaves, metres; 0 for a sharp edge
    uint64_t path = 0;  ///< keys the roof's own slots (0: fresh ones); no other solid nor the plan may have it
};

/// A plane that rises inward: through the line `inset` metres inside the edge and `rise` metres above the eaves.
struct Pitch {
    Quantity angle, inset, rise;
};
/// What rises over one edge: the lowest of its planes counts; without any the wall goes up, a gable.
struct RoofSide {
    std::vector<Pitch> pitches;
};

/// The general roof: one side for all edges, or one an edge by number. An edge with a reflex corner can't be a gable
/// and takes the pitches of the first side that has some. Nothing where no side has any.
Field roof(const PlanField& plan, const RoofFoot& foot, std::span<const RoofSide> sides);

/// The same pitch over every edge.
Field hipRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch);
/// A pitch over every edge but `ends` (numbers), where walls go up; plan::gableEnds finds those that carry a ridge.
Field gableRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, std::span<const uint32_t> ends);
/// A gable whose points are hipped from `share` of its height up, 0 … 1 (0 is the hip, 1 the gable), with the same
/// pitch.
Field halfHipRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, std::span<const uint32_t> ends,
                  Quantity share);
/// Steep by `lower` up to `height` metres, then `upper`.
Field mansardRoof(const PlanField& plan, const RoofFoot& foot, Quantity lower, Quantity height, Quantity upper);
/// The same between gables.
Field gambrelRoof(const PlanField& plan, const RoofFoot& foot, Quantity lower, Quantity height, Quantity upper,
                  std::span<const uint32_t> ends);
/// A gable with its own pitch for edges that face `front` (plan direction, within 90°) and the other for the rest.
Field saltboxRoof(const PlanField& plan, const RoofFoot& foot, Quantity frontPitch, Quantity backPitch,
                  plan::Vec2 front, std::span<const uint32_t> ends);
/// Planes from every edge to one point `height` above the eaves over the centre of mass, where every edge faces that
/// point; else the hip roof of that height.
Field pyramidRoof(const PlanField& plan, const RoofFoot& foot, Quantity height);
/// One plane that rises in direction `up` (plan, not zero) from the outline's lowest point; walls go up to it.
Field shedRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, plan::Vec2 up);
/// Two planes that fall to a valley along `valley` (plan direction, not zero) through the middle of the outline, at the
/// height of the fascia above the eaves (0: two wedges that meet in a line).
Field butterflyRoof(const PlanField& plan, const RoofFoot& foot, Quantity pitch, plan::Vec2 valley);
/// A slab of `slab` metres on the eaves' height and, round it, a parapet of that height above the slab and thickness.
Field flatRoof(const PlanField& plan, const RoofFoot& foot, Quantity slab, Quantity parapetHeight,
               Quantity parapetThickness);
/// Quarter ellipses over every edge, `height` high, upright at the eaves and level `run` metres inside; run 0: as far
/// in as the footprint is deep, so that the top is round. Cloister vaults over polygons; courts get them too.
Field domeRoof(const PlanField& plan, const RoofFoot& foot, Quantity height, Quantity run);
/// As the dome, but the lower half is hollow: an S from a level foot to a level top.
Field bellRoof(const PlanField& plan, const RoofFoot& foot, Quantity height, Quantity run);
/// Any outline: points (metres inward of the edge, metres above the eaves), inward ascending; level beyond the last
/// one. Error::Input with the point at fault.
Result<Field> profileRoof(const PlanField& plan, const RoofFoot& foot, std::span<const plan::Vec2> points);

}  // namespace sgm::field
