// The numbers of footprints, shared by the solids that stand over one: a house's walls and its roof.
// Enters: scopes with footprints. Leaves: numbers that fields are made of. Assumes that the table outlives it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "grammar/derive/footprints.h"
#include "modeler/field/hash_index.h"
#include "modeler/field/plan_numbers.h"

namespace sgm::lower {

/// A footprint as it stands in a scope of that half-size.
struct PlacedPlan {
    uint32_t footprint = 0;
    Vec3d half;
    bool wantsDepth = false;  ///< a roof stands over it
    bool isSame(const PlacedPlan& other) const {
        return footprint == other.footprint && half.x == other.half.x && half.z == other.half.z;
    }
};

class SharedPlans {
public:
    explicit SharedPlans(const derive::Footprints& footprints) : footprints_(&footprints) {}
    /// Makes what is going to be asked for, on `threads` threads; O(edges) each, more for a depth that nobody knows.
    void prepare(std::span<const PlacedPlan> plans, int threads);
    /// Of a footprint in metres about the centre of a scope of that half-size. O(edges); O(1) for what was prepared,
    /// and for the latest.
    std::shared_ptr<const field::PlanNumbers> numbersOf(uint32_t footprint, Vec3d half);
    /// Forgets all, for the table may change.
    void clear() { *this = SharedPlans(*footprints_); }

private:
    /// A footprint with what points into it.
    struct Plan {
        plan::Footprint footprint;
        field::PlanNumbers numbers;
        Plan(const derive::Footprints& footprints, const PlacedPlan& placed);
    };
    uint32_t find(const PlacedPlan& placed) const;

    const derive::Footprints* footprints_;
    std::vector<PlacedPlan> placed_;                  ///< those prepared
    std::vector<std::shared_ptr<const Plan>> plans_;  ///< of `placed_`
    field::HashIndex index_;
    PlacedPlan latestPlaced_;
    std::shared_ptr<const Plan> latest_;
};

}  // namespace sgm::lower
