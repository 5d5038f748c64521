// Solids over footprints as half-spaces: what polyhedra and exact solids are made from.
// Enters: a SolidValue of a row over a footprint, and its scope. Leaves: half-spaces joined by the footprint's formula.
// Assumes sound footprints.
#pragma once

#include <optional>

#include "grammar/derive/shape_tree.h"
#include "modeler/field/convex.h"

namespace sgm::lower {

/// What rises over the edges of a footprint between two heights, about the scope's centre and in its axes. It is the
/// formula with, for an edge, what its planes share.
struct PlanRise {
    double bottom_m = 0, top_m = 0;
    std::vector<field::ConvexPart> sides;  ///< by edge
};

struct PlanPlanes {
    plan::Formula formula;
    PlanRise outer;
    std::optional<PlanRise> hollow;  ///< taken away from `outer`: below a roof that is open, behind a parapet
};

/// The planes of a block, a hip, gable, mansard, gambrel or flat roof; nothing for other rows.
std::optional<PlanPlanes> planesOver(const derive::SolidValue& solid, const derive::Scope& scope,
                                     const derive::Footprints& footprints);

/// A pyramid, dome or bell roof as rises whose union it is; nothing for other rows. Pyramids are exact, round profiles
/// planes that touch them or chords outside of them: by at most 2 % of the depth of the footprint.
std::vector<PlanPlanes> roundPlanesOver(const derive::SolidValue& solid, const derive::Scope& scope,
                                        const derive::Footprints& footprints);

/// A half-space of a scope's axes about its centre, in the object's frame.
field::HalfSpace inObject(field::HalfSpace plane, const derive::Scope& scope);

}  // namespace sgm::lower
