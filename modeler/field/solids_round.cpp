// Round solids. Cross-sections may be elliptical: (|p/s| − 1)·min s is 1-Lipschitz and exact for a circle.
// Growth: a solid whose exact distance is measured in coordinates v = p/m, times min m, grows by min m / max m at
// least.
#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field::solids {

namespace {

/// √(a² + b²).
NodeRef hypot(NodeRef a, NodeRef b) { return sqrt(square(a) + square(b)); }

/// Distance from the y axis in units of the scope's ellipse: 1 on its rim.
NodeRef radial(const PrimitiveInput& in) { return hypot(in.p.x / in.half.x, in.p.z / in.half.z); }

double roundness(double a, double b) { return std::min(a, b) / std::max(a, b); }

/// The whole scope's cylinder about y; an exact distance when its base is a circle.
NodeRef cylinderDistance(const PrimitiveInput& in) {
    const NodeRef side = (radial(in) - 1.0f) * min(in.half.x, in.half.z), cap = abs(in.p.y) - in.half.y;
    return side.graph().apply(codeOf<ops::Rim>, {side, cap});
}

}  // namespace

// Squeezed onto the ball of the least half-size; the scales are rounded unless they are 1, hence the wider box.
Field ellipsoid(const PrimitiveInput& in) {
    const NodeRef r = min(min(in.half.x, in.half.y), in.half.z);
    const auto [p, c] = placed(in.p);
    const NodeRef value = r.graph().apply(
        codeOf<ops::Ball>, {p.x, p.y, p.z, c.x, c.y, c.z, r / in.half.x, r / in.half.y, r / in.half.z, r});
    const double most = maxComponent(in.halfValue), share = minComponent(in.halfValue) / most;
    return {value, share == 1 ? scopeBox(in) : scopeBox(in).inflated(2e-6f * static_cast<float>(most)), 1,
            growth(share)};
}

// In the scope's ellipse as unit circle the rim is 1 and the tube's radius `tube`; y is scaled so that the tube is as
// high as the scope. The two parts of the inner length have orthogonal gradients of at most 1/min(half x, z) and
// tube/half y.
Field torus(const PrimitiveInput& in) {
    const NodeRef tube = in.arguments[0].node[0];
    const NodeRef across = radial(in) - (1.0f - tube);
    const NodeRef scale = min(min(in.half.x, in.half.z), in.half.y / tube);
    const Vec3d m{in.halfValue.x, in.halfValue.y / in.arguments[0].value[0], in.halfValue.z};
    return {(hypot(across, in.p.y / in.half.y * tube) - tube) * scale,
            scopeBox(in).inflated(2e-6f * static_cast<float>(maxComponent(m))), 1,
            growth(minComponent(m) / maxComponent(m))};
}

Field cylinder(const PrimitiveInput& in) {
    return {cylinderDistance(in), scopeBox(in), 1, growth(roundness(in.halfValue.x, in.halfValue.z))};
}

// The slanted side from the rim of the foot to the apex, exact inside; the cylinder closes the foot and gives the
// growth.
Field cone(const PrimitiveInput& in) {
    const NodeRef radius = min(in.half.x, in.half.z), rise = 2.0f * in.half.y;
    const NodeRef side = ((radial(in) - 1.0f) * rise * radius + (in.p.y + in.half.y) * radius) / hypot(rise, radius);
    return {max(side, cylinderDistance(in)), scopeBox(in), 1, growth(roundness(in.halfValue.x, in.halfValue.z))};
}

// Half balls of the least half-size r on a segment along y; x and z are squeezed onto r, which only shortens distances.
Field capsule(const PrimitiveInput& in) {
    const NodeRef r = min(min(in.half.x, in.half.y), in.half.z);
    const NodeRef along = max(abs(in.p.y) - (in.half.y - r), 0.0f);
    const NodeRef value = length(Point{in.p.x / in.half.x * r, along, in.p.z / in.half.z * r}) - r;
    const Vec3d h = in.halfValue;
    return {value, scopeBox(in).inflated(2e-6f * static_cast<float>(maxComponent(h))), 1,
            growth(minComponent(h) / std::max(h.x, h.z))};
}

}  // namespace sgm::field::solids
