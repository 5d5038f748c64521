#include "modeler/field/drape.h"

#include <cmath>

#include "modeler/field/ops.h"

namespace sgm::field {
namespace {

/// The rectangle of the heights' plan around a box of the model.
Box3f inFrame(const Box3f& box, const Frame& frame) {
    Box3f out;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p{static_cast<double>(corner & 1 ? box.hi.x : box.lo.x),
                      static_cast<double>(corner & 2 ? box.hi.y : box.lo.y),
                      static_cast<double>(corner & 4 ? box.hi.z : box.lo.z)};
        out = hull(out, (frame.rotation.transposed() * (p - frame.centre)).as<float>());
    }
    return out.inflated(1e-3f);
}

}  // namespace

Field drape(const Field& f, const SampledGridPtr& heights, const Frame& frame, uint64_t path) {
    if (f.bounds.empty()) return f;
    Graph& graph = f.value.graph();
    const Point p = graph.position(), local = toLocal(p, frame, path);
    const NodeRef height = graph.apply(codeOf<ops::Heights>, {local.x, local.z}, graph.grid(heights));
    const float s = steepnessOf(*heights), norm = (s + std::sqrt(s * s + 4)) * 0.5f * 1.00001f;
    Field out = f;
    out.value = substitute(f.value, {p.x, p.y - height, p.z}) * (1 / norm);
    out.growth = f.growth / (norm * norm) * 0.99999f;
    if (f.bounds.finite()) {
        const Box3f plan = inFrame(f.bounds, frame);
        const HeightRange range = heightsOver(*heights, plan.lo.x, plan.lo.z, plan.hi.x, plan.hi.z);
        // The bounds hold what the field's own rounding leaves at its places, lifted.
        const float slack = 1e-5f * (std::abs(range.least) + std::abs(range.greatest) + std::abs(f.bounds.lo.y) +
                                     std::abs(f.bounds.hi.y));
        out.bounds.lo.y += range.least - slack, out.bounds.hi.y += range.greatest + slack;
    }
    return out;
}

}  // namespace sgm::field
