#include "grammar/lower/shared_plans.h"

#include <algorithm>
#include <bit>

#include "modeler/core/parallel.h"
#include "modeler/core/random.h"

namespace sgm::lower {

SharedPlans::Plan::Plan(const derive::Footprints& footprints, const PlacedPlan& placed)
    : footprint(footprints.inMetres(placed.footprint, placed.half)),
      numbers(footprint, footprints[placed.footprint].formula) {
    if (const auto depth_m = footprints.knownDepth(placed.footprint, placed.half)) numbers.setDepth(*depth_m);
}

namespace {

uint64_t hashOf(const PlacedPlan& placed) {
    return combine(combine(placed.footprint, std::bit_cast<uint64_t>(placed.half.x)),
                   std::bit_cast<uint64_t>(placed.half.z));
}

}  // namespace

uint32_t SharedPlans::find(const PlacedPlan& placed) const {
    return index_.find(hashOf(placed), [&](uint32_t i) { return placed_[i].isSame(placed); });
}

void SharedPlans::prepare(std::span<const PlacedPlan> plans, int threads) {
    const size_t first = placed_.size();
    for (const PlacedPlan& placed : plans) {
        if (const uint32_t known = find(placed); known != field::HashIndex::none) {
            placed_[known].wantsDepth = placed_[known].wantsDepth || placed.wantsDepth;
            continue;
        }
        index_.insert(hashOf(placed), static_cast<uint32_t>(placed_.size()));
        placed_.push_back(placed);
    }
    plans_.resize(placed_.size());
    constexpr size_t together = 16;
    const size_t count = placed_.size() - first;
    parallelFor((count + together - 1) / together, count > together ? threads : 1, nullptr, [&](size_t chunk, int) {
        for (size_t i = first + chunk * together; i < std::min(first + (chunk + 1) * together, placed_.size()); ++i) {
            const auto plan = std::make_shared<const Plan>(*footprints_, placed_[i]);
            plan->numbers.prepare(placed_[i].wantsDepth);
            plans_[i] = plan;
        }
    });
}

std::shared_ptr<const field::PlanNumbers> SharedPlans::numbersOf(uint32_t footprint, Vec3d half) {
    const PlacedPlan placed{footprint, half, false};
    if (!latest_ || !latestPlaced_.isSame(placed)) {
        const uint32_t known = find(placed);
        latest_ = known == field::HashIndex::none ? std::make_shared<const Plan>(*footprints_, placed) : plans_[known];
        latestPlaced_ = placed;
    }
    return {latest_, &latest_->numbers};
}

}  // namespace sgm::lower
