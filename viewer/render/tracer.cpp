#include "viewer/render/tracer.h"

#include "viewer/render/gpu.h"

namespace sgm::render {

TracedBy tracerHere(TracedBy by) {
    if (by != TracedBy::Best) return by;
    return softwareGl() ? TracedBy::Processor : TracedBy::Gpu;
}

int cellDepth(TracedBy by) { return tracerHere(by) == TracedBy::Gpu ? CellTree::surfaceDepth : CellTree::depth; }

TraceCost& TraceCost::operator+=(const TraceCost& other) {
    hits += other.hits;
    light += other.light;
    instructions += other.instructions;
    return *this;
}

}  // namespace sgm::render
