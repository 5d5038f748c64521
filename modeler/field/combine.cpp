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

/// `box` grown so that it holds every point with f < level, which growth puts within level/growth of it.
Box3f levelBox(const Box3f& box, double level, float growth) {
    if (box.empty() || level <= 0) return box;
    if (growth <= 0) return Box3f::everything();
    return box.inflated(static_cast<float>(level / growth * (1 + 1e-6)));
}

/// A balanced min tree in the parts' order.
Operand minTree(std::span<const Owned> parts) {
    if (parts.size() == 1) return {parts[0].field.value.id(), parts[0].origin};
    const Operand low = minTree(parts.first(parts.size() / 2)), high = minTree(parts.subspan(parts.size() / 2));
    const Operand halves[] = {low, high};
    return {parts[0].field.value.graph().apply(codeOf<ops::Min>, halves).id(), 0};
}

/// What both boxes share; an axis in which they don't meet shrinks to the middle of the gap. In each axis a point is at
/// most as far from the result as from the farther box, so in space at most √2 times the larger of the two distances.
Box3f commonBox(const Box3f& a, const Box3f& b) {
    if (a.empty() || b.empty()) return {};
    Box3f common = intersection(a, b);
    for (int i = 0; i < 3; ++i)
        if (common.lo[i] > common.hi[i]) common.lo[i] = common.hi[i] = (common.lo[i] + common.hi[i]) * 0.5f;
    return common;
}

/// max of two operands that keep their owners.
NodeRef ownedMax(NodeRef a, OriginId ownerOfA, NodeRef b, OriginId ownerOfB) {
    const Operand operands[] = {{a.id(), ownerOfA}, {b.id(), ownerOfB}};
    return a.graph().apply(codeOf<ops::Max>, operands);
}

/// The operand alone, but with its owner: min(f, f) keeps the bits and gives the owner a place.
NodeRef owned(const Owned& part) {
    if (part.origin == 0) return part.field.value;
    const Operand twice[] = {{part.field.value.id(), part.origin}, {part.field.value.id(), part.origin}};
    return part.field.value.graph().apply(codeOf<ops::Min>, twice);
}

/// Appends a part to a blend's operands; a blend of the same radius gives its own, so that grouping can't change the
/// shape.
void spliceBlend(const Graph& graph, const Owned& part, std::vector<Operand>& operands) {
    const NodeId id = part.field.value.id();
    const auto inner = graph.operands(id);
    if (graph.node(id).op != codeOf<ops::Blend> || inner[0].node != operands[0].node) {
        operands.push_back({id, part.origin});
        return;
    }
    for (const Operand& o : inner.subspan(1)) operands.push_back({o.node, part.origin ? part.origin : o.origin});
}

}  // namespace

Field nothing(Graph& graph) { return {graph.literal(farAway), {}, 0, 1}; }

Field sum(Graph& graph, std::span<const Owned> parts) {
    if (parts.empty()) return nothing(graph);
    if (parts.size() == 1)
        return {owned(parts[0]), parts[0].field.bounds, parts[0].field.lipschitz, parts[0].field.growth};
    return summed(NodeRef(&graph, minTree(parts).node), parts);
}

Field summed(NodeRef value, std::span<const Owned> parts) {
    Box3f bounds;
    for (const Owned& part : parts) bounds = hull(bounds, part.field.bounds);
    return {value, bounds, maxLipschitz(parts), minGrowth(parts)};
}

Field difference(Owned a, Owned b) {
    return {ownedMax(a.field.value, a.origin, -b.field.value, b.origin), a.field.bounds,
            std::max(a.field.lipschitz, b.field.lipschitz), a.field.growth};
}

Field difference(Owned a, std::span<const Owned> cuts, NodeRef radius, double radiusValue) {
    std::vector<Owned> operands{{{-a.field.value, a.field.bounds, a.field.lipschitz, a.field.growth}, a.origin}};
    operands.insert(operands.end(), cuts.begin(), cuts.end());
    return {-blend(radius.graph(), operands, radius, radiusValue).value, a.field.bounds,
            std::max(a.field.lipschitz, maxLipschitz(cuts)), a.field.growth};
}

Field intersection(Owned a, Owned b) {
    const float growth = std::min(a.field.growth, b.field.growth) * 0.70710f;
    return {ownedMax(a.field.value, a.origin, b.field.value, b.origin), commonBox(a.field.bounds, b.field.bounds),
            std::max(a.field.lipschitz, b.field.lipschitz), growth};
}

// Where f < 0 one of the two is negative, and outside both boxes both grow, so f does by the smaller growth at least.
Field morph(Field a, Field b, NodeRef t, double tValue, OriginId origin) {
    const Operand operands[] = {{a.value.id(), origin}, {b.value.id(), origin}, {t.id(), 0}};
    const NodeRef value = t.graph().apply(codeOf<ops::Morph>, operands);
    if (tValue <= 0) return {value, a.bounds, a.lipschitz, a.growth};
    if (tValue >= 1) return {value, b.bounds, b.lipschitz, b.growth};
    const auto s = static_cast<float>(tValue);
    return {value, hull(a.bounds, b.bounds), (1 - s) * a.lipschitz + s * b.lipschitz, std::min(a.growth, b.growth)};
}

// The smooth union lowers the minimum by k − c' ≤ k(1 − 1/√n), with equality where all n are equal.
Field blend(Graph& graph, std::span<const Owned> parts, NodeRef radius, double radiusValue) {
    if (parts.size() < 2) return sum(graph, parts);
    std::vector<Operand> operands{{radius.id(), 0}};
    for (const Owned& part : parts) spliceBlend(graph, part, operands);
    const NodeRef value = graph.apply(codeOf<ops::Blend>, operands);

    const double deepest = radiusValue * (1 - 1 / std::sqrt(static_cast<double>(operands.size() - 1)));
    Box3f bounds;
    for (const Owned& part : parts) bounds = hull(bounds, levelBox(part.field.bounds, deepest, part.field.growth));
    return {value, bounds, maxLipschitz(parts), minGrowth(parts)};
}

Field displace(Field f, Point p, Noise noise, NodeRef amplitude, double amplitudeValue, NodeRef frequency,
               double frequencyValue, int octaves, uint32_t seed) {
    const int count = std::clamp(octaves, 1, ops::Noise::maxOctaves);
    const float steepness = ops::Noise::lipschitz(count);
    const NodeRef height = p.x.graph().apply(codeOf<ops::Noise>, {p.x * frequency, p.y * frequency, p.z * frequency},
                                             ops::Noise::pack(noise == Noise::Fbm, count, seed));
    const NodeRef divisor = 1.0f + abs(amplitude * frequency) * steepness;
    const auto slope = static_cast<float>(std::abs(amplitudeValue * frequencyValue)) * steepness;
    return {(f.value - amplitude * height) / divisor, levelBox(f.bounds, std::abs(amplitudeValue), f.growth),
            (f.lipschitz + slope) / (1 + slope), f.growth / (1 + slope) * (1 - 1e-6f)};
}

}  // namespace sgm::field
