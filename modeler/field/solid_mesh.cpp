#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field::solids {

// The maximum with the box keeps interpolated corners inside the scope and gives growth 1.
Field mesh(const PrimitiveInput& in) {
    Graph& graph = in.p.x.graph();
    const SampledGridPtr& grid = in.arguments[0].grid;
    const Vec3f half = grid->bounds().size() * 0.5f, middle = grid->bounds().centre();
    const Point scale{in.half.x / half.x, in.half.y / half.y, in.half.z / half.z};
    const NodeRef place[] = {in.p.x / scale.x + middle.x, in.p.y / scale.y + middle.y, in.p.z / scale.z + middle.z};
    const Operand operands[] = {{place[0].id(), 0}, {place[1].id(), 0}, {place[2].id(), 0}};
    const NodeRef distance = graph.apply(codeOf<ops::Sampled>, operands, graph.grid(grid));
    const NodeRef scaled = distance * min(min(scale.x, scale.y), scale.z);
    return {max(scaled, boxDistance(in.p, in.half)), scopeBox(in), grid->lipschitz(), growth(1)};
}

}  // namespace sgm::field::solids
