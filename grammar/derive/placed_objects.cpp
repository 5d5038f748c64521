#include "grammar/derive/placed_objects.h"

#include <bit>

#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

uint64_t hashOf(double v) { return std::bit_cast<uint64_t>(v + 0.0); }  // −0 is 0

uint64_t hashOf(const rules::Value& value) {
    uint64_t h = combine(static_cast<uint64_t>(value.kind), hashText(value.text));
    for (const double n : value.n) h = combine(h, hashOf(n));
    return h;
}

uint64_t hashOf(const Lot& lot) {
    uint64_t h = combine(combine(hashOf(lot.size_m.x), hashOf(lot.size_m.y)), hashOf(lot.size_m.z));
    for (const plan::Polygon& polygon : lot.footprint.polygons)
        for (const plan::Vec2 p : polygon.outer.points) h = combine(combine(h, hashOf(p.x)), hashOf(p.z));
    return h;
}

}  // namespace

uint64_t PlacedObject::hash(bool withSeed) const {
    uint64_t h = combine(start, withSeed ? seed : 0);
    for (const rules::Value& value : params) h = combine(h, hashOf(value));
    return lot ? combine(h, hashOf(*lot)) : h;
}

uint32_t PlacedObjects::put(PlacedObject object) {
    const uint64_t hash = object.hash();
    const auto [begin, end] = byHash_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
        if (all_[at->second] == object) return at->second;
    const auto index = static_cast<uint32_t>(all_.size());
    all_.push_back(std::move(object));
    byHash_.emplace(hash, index);
    return index;
}

}  // namespace sgm::derive
