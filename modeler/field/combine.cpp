#include "modeler/field/combine.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "modeler/field/ops.h"

namespace sgm::field {

namespace {

/// The value of the empty solid: larger than any distance, and still finite when a morph multiplies it.
constexpr float farAway = 1e30f;

float maxLipschitz(std::span<const Owned> parts) {
    float l = 0;
    for (const Owned& part : parts) l = std::max(l, part.field.lipschitz);
    return l;
}

float minGrowth(std::span<const Owned> parts) {
    float g = parts.front().field.growth;
    for (const Owned& part : parts) g = std::min(g, part.field.growth);
    return g;
}

/// Builds a min tree top-down by median splits of the parts' boxes on their widest axis (Goldsmith & Salmon 1987 call it
/// an object hierarchy). The order is total, so the tree depends on the parts alone; its depth is ⌈log₂ n⌉.
class Hierarchy {
public:
    explicit Hierarchy(std::span<const Owned> parts) : parts_(parts), order_(parts.size()) {
        centres_.reserve(parts.size());
        for (const Owned& part : parts) centres_.push_back(anchor(part.field.bounds));
        for (uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    }

    Operand build() { return build(0, order_.size()); }

private:
    /// The box's centre; 0 in an axis where it has none (unbounded or empty).
    static Vec3f anchor(const Box3f& box) {
        Vec3f c = box.empty() ? Vec3f{} : box.centre();
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(c[i])) c[i] = 0;
        return c;
    }

    int widestAxis(size_t first, size_t last) const {
        Box3f box;
        for (size_t i = first; i < last; ++i) box = hull(box, centres_[order_[i]]);
        const Vec3f s = box.size();
        return s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2;
    }

    Operand build(size_t first, size_t last) {
        if (last - first == 1) {
            const Owned& part = parts_[order_[first]];
            return {part.field.value.id(), part.origin};
        }
        const size_t middle = first + (last - first) / 2;
        const int axis = widestAxis(first, last);
        std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first), order_.begin() + static_cast<std::ptrdiff_t>(middle),
                         order_.begin() + static_cast<std::ptrdiff_t>(last), [&](uint32_t a, uint32_t b) {
                             const float ca = centres_[a][axis], cb = centres_[b][axis];
                             return ca != cb ? ca < cb : a < b;
                         });
        const Operand halves[] = {build(first, middle), build(middle, last)};
        return {parts_.front().field.value.graph().apply(codeOf<ops::Min>, halves).id(), 0};
    }

    std::span<const Owned> parts_;
    std::vector<uint32_t> order_;
    std::vector<Vec3f> centres_;
};

/// max of two operands that keep their owners.
Num ownedMax(Num a, OriginId ownerOfA, Num b, OriginId ownerOfB) {
    const Operand operands[] = {{a.id(), ownerOfA}, {b.id(), ownerOfB}};
    return a.graph().apply(codeOf<ops::Max>, operands);
}

/// The operand alone, but with its owner: min(f, f) keeps the bits and gives the owner a place.
Num owned(const Owned& part) {
    if (part.origin == 0) return part.field.value;
    const Operand twice[] = {{part.field.value.id(), part.origin}, {part.field.value.id(), part.origin}};
    return part.field.value.graph().apply(codeOf<ops::Min>, twice);
}

}  // namespace

Field nothing(Graph& graph) { return {graph.literal(farAway), {}, 0, 1}; }

Field sum(Graph& graph, std::span<const Owned> parts) {
    if (parts.empty()) return nothing(graph);
    if (parts.size() == 1) return {owned(parts[0]), parts[0].field.bounds, parts[0].field.lipschitz, parts[0].field.growth};
    Box3f bounds;
    for (const Owned& part : parts) bounds = hull(bounds, part.field.bounds);
    return {Num(&graph, Hierarchy(parts).build().node), bounds, maxLipschitz(parts), minGrowth(parts)};
}

Field difference(Owned a, Owned b) {
    return {ownedMax(a.field.value, a.origin, -b.field.value, b.origin), a.field.bounds,
            std::max(a.field.lipschitz, b.field.lipschitz), a.field.growth};
}

// Outside the common box each axis is left by at least one of the two boxes, so the distance to it is at most √2 times the
// larger of the distances to the two. Boxes that don't meet leave nothing to grow from.
Field intersection(Owned a, Owned b) {
    const Box3f common = intersection(a.field.bounds, b.field.bounds);
    const float growth = std::min(a.field.growth, b.field.growth) * 0.70710f;
    return {ownedMax(a.field.value, a.origin, b.field.value, b.origin), common.empty() ? Box3f{} : common,
            std::max(a.field.lipschitz, b.field.lipschitz), common.empty() ? 0 : growth};
}

// Where f < 0 one of the two is negative, and outside both boxes both grow, so f does by the smaller growth at least.
Field morph(Field a, Field b, Num t, double tValue, OriginId origin) {
    const Operand operands[] = {{a.value.id(), origin}, {b.value.id(), origin}, {t.id(), 0}};
    const Num value = t.graph().apply(codeOf<ops::Morph>, operands);
    if (tValue <= 0) return {value, a.bounds, a.lipschitz, a.growth};
    if (tValue >= 1) return {value, b.bounds, b.lipschitz, b.growth};
    const auto s = static_cast<float>(tValue);
    return {value, hull(a.bounds, b.bounds), (1 - s) * a.lipschitz + s * b.lipschitz, std::min(a.growth, b.growth)};
}

}  // namespace sgm::field
