#include "grammar/derive/footprints.h"

#include <bit>

#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

uint64_t hashOf(const plan::Footprint& footprint) {
    uint64_t hash = 0;
    const auto add = [&](const plan::Ring& ring) {
        for (const plan::Vec2 p : ring.points)
            hash = combine(combine(hash, std::bit_cast<uint64_t>(p.x + 0.0)), std::bit_cast<uint64_t>(p.z + 0.0));
        for (const plan::Edge e : ring.edges) hash = combine(hash, e.tag);
    };
    for (const plan::Polygon& polygon : footprint.polygons) {
        add(polygon.outer);
        for (const plan::Ring& court : polygon.courts) add(court);
    }
    return hash;
}

}  // namespace

Result<uint32_t> Footprints::put(const plan::Footprint& footprint, Vec3d half) {
    return put(footprint, half, plan::monotoneFormula);
}

uint32_t Footprints::putSound(const plan::Footprint& footprint, Vec3d half) {
    const auto formulaOf = [](const plan::Footprint& sound) { return Result(plan::formulaOfSound(sound)); };
    return *put(footprint, half, formulaOf);
}

Result<uint32_t> Footprints::put(const plan::Footprint& footprint, Vec3d half,
                                 Result<plan::Formula> (*formulaOf)(const plan::Footprint&)) {
    plan::Footprint shares = plan::placed(footprint, {1 / half.x, 1 / half.z}, {0, 0});
    const uint64_t hash = hashOf(shares);
    const auto [begin, end] = byHash_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
        if (shapes_[at->second]->footprint == shares) return at->second;
    auto formula = formulaOf(footprint);
    if (!formula.ok()) return formula.error();
    shapes_.push_back(std::make_shared<const PlanShape>(PlanShape{std::move(shares), std::move(*formula)}));
    byHash_.emplace(hash, static_cast<uint32_t>(shapes_.size() - 1));
    return static_cast<uint32_t>(shapes_.size() - 1);
}

size_t Footprints::append(const Footprints& other) {
    const size_t first = shapes_.size();
    shapes_.insert(shapes_.end(), other.shapes_.begin(), other.shapes_.end());
    for (const auto& [hash, index] : other.byHash_) byHash_.emplace(hash, static_cast<uint32_t>(first + index));
    for (const auto& [size, depth_m] : other.depths_) depths_.insert({{first + size[0], size[1], size[2]}, depth_m});
    return first;
}

plan::Footprint Footprints::inMetres(uint32_t index, Vec3d half) const {
    return plan::placed(shapes_[index]->footprint, {half.x, half.z}, {0, 0});
}

}  // namespace sgm::derive
