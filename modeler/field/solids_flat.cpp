// Solids bounded by planes, and the roof that morphs between planes and an ellipsoid.
// A maximum of planes is exact inside a convex solid but too small outside its edges; the maximum with the scope's own
// distance changes nothing inside (the solid lies in its scope) and gives a growth of 1 outside.
#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field::solids {

namespace {

/// Signed distance to the plane through (half, −halfY) and (0, halfY), the slanted face over an axis: `across` ≥ 0 is
/// the distance from that axis, `y` the height.
NodeRef slope(NodeRef across, NodeRef y, NodeRef half, NodeRef halfY) {
    const NodeRef rise = 2.0f * halfY;
    return ((across - half) * rise + (y + halfY) * half) / sqrt(square(rise) + square(half));
}

NodeRef pyramidSides(const PrimitiveInput& in) {
    return max(slope(abs(in.p.x), in.p.y, in.half.x, in.half.y), slope(abs(in.p.z), in.p.y, in.half.z, in.half.y));
}

Field insideScope(const PrimitiveInput& in, NodeRef planes) {
    return {max(planes, boxDistance(in.p, in.half)), scopeBox(in), 1, growth(1)};
}

}  // namespace

Box3f scopeBox(const PrimitiveInput& in) {
    const Vec3f h = in.halfValue.as<float>();
    return {-h, h};
}

float growth(double g) { return static_cast<float>(g * (1 - 2e-6)); }

Placed placed(const Point& p) {
    Graph& graph = p.x.graph();
    Placed result{p, {graph.literal(0), graph.literal(0), graph.literal(0)}};
    const auto takeApart = [&graph](NodeRef& n, NodeRef& centre) {
        const Node& node = graph.node(n.id());
        if (node.op != codeOf<ops::Sub>) return;
        const auto operands = graph.operands(n.id());
        const OpCode subtracted = graph.node(operands[1].node).op;
        if (subtracted != codeOf<ops::Slot> && subtracted != codeOf<ops::Literal>) return;
        n = {&graph, operands[0].node};
        centre = {&graph, operands[1].node};
    };
    takeApart(result.p.x, result.centre.x);
    takeApart(result.p.y, result.centre.y);
    takeApart(result.p.z, result.centre.z);
    return result;
}

NodeRef boxDistance(const Point& p, const Point& half) {
    const auto [q, c] = placed(p);
    return boxDistance(q, c, half);
}

NodeRef boxDistance(const Point& p, const Point& c, const Point& half) {
    p.x.graph().literal(0);  // as old as the first box, for operands that commute are ordered by age
    return p.x.graph().apply(codeOf<ops::Box>, {p.x, p.y, p.z, c.x, c.y, c.z, half.x, half.y, half.z});
}

Field cube(const PrimitiveInput& in) { return {boxDistance(in.p, in.half), scopeBox(in), 1, growth(1)}; }

Field pyramid(const PrimitiveInput& in) { return insideScope(in, pyramidSides(in)); }

Field prism(const PrimitiveInput& in) { return insideScope(in, slope(abs(in.p.x), in.p.y, in.half.x, in.half.y)); }

Field wedge(const PrimitiveInput& in) {
    const NodeRef plane = (in.p.x * in.half.y + in.p.y * in.half.x) / sqrt(square(in.half.x) + square(in.half.y));
    return insideScope(in, plane);
}

// Papers guide, section 3 "Architecture": max(lerp(pyramid sides, ellipsoid (w, H, d), a), −y), y from the foot.
// Morphing a closed pyramid instead would curl its base up. The foot is a face of the scope, so the cut is part of the
// box.
Field roof(const PrimitiveInput& in) {
    const NodeRef foot = in.p.y + in.half.y, height = 2.0f * in.half.y;
    const NodeRef dome = (length(Point{in.p.x / in.half.x, foot / height, in.p.z / in.half.z}) - 1.0f) *
                         min(min(in.half.x, in.half.z), height);
    Graph& graph = in.p.x.graph();
    return insideScope(in, graph.apply(codeOf<ops::Morph>, {pyramidSides(in), dome, in.arguments[0].node[0]}));
}

Field halfspace(const PrimitiveInput& in) {
    constexpr float inf = Box3f::limit();
    return {in.p.y, {{-inf, -inf, -inf}, {inf, 0, inf}}, 1, 1};
}

}  // namespace sgm::field::solids
