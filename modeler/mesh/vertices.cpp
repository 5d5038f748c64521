#include "modeler/mesh/vertices.h"

#include <algorithm>

#include "modeler/mesh/region.h"

namespace sgm::mesh {
namespace {

/// The field, whose evaluation may be timed.
class TimedField {
public:
    TimedField(const eval::Tape& tape, eval::Workspace& workspace, const VertexSearch& search)
        : tape_(tape), workspace_(workspace), time_(search.fieldTime), exact_(search.exact) {}
    void value(const EdgeArrays& e, size_t n) const {
        const AddTime evaluating(time_);
        eval::evaluate(tape_, {e.x, e.y, e.z, n, true}, e.f, workspace_);
    }
    /// Its derivatives too.
    void gradient(const EdgeArrays& e, size_t n) const {
        const AddTime evaluating(time_);
        eval::evaluateGradient(tape_, {e.x, e.y, e.z, n, true}, e.f, e.dx, e.dy, e.dz, workspace_, exact_);
    }

private:
    const eval::Tape& tape_;
    eval::Workspace& workspace_;
    SumOfTimes* const time_;
    const bool exact_;
};

/// By values alone, and by the derivative once at the end.
uint64_t findByValues(const TimedField& field, const VertexSearch& search, CutEdges& edges) {
    const EdgeLoops& loops = edgeLoops();
    const EdgeArrays& e = edges.arrays;
    for (size_t s = 0; s < search.refineSteps; ++s) {
        field.value(e, edges.size);
        loops.narrow(e, edges.size, s % 2 == 1);
    }
    if (search.normals || search.refineSteps > 0) field.gradient(e, edges.size);
    if (search.refineSteps > 0) loops.settle(e, edges.size);
    return search.refineSteps * edges.size;
}

/// By value and derivative together: most vertices take one evaluation, and only the others go on.
uint64_t findByNewton(const TimedField& field, const VertexSearch& search, std::vector<CutEdges>& scratch,
                      CutEdges& edges) {
    const EdgeLoops& loops = edgeLoops();
    uint64_t evaluations = 0;
    scratch.resize(std::max(scratch.size(), search.refineSteps));
    CutEdges* list = &edges;
    for (size_t s = 0;; ++s) {
        if (s == search.refineSteps && !search.normals) break;
        field.gradient(list->arrays, list->size);
        if (s == search.refineSteps) break;  // where the last step led, only the derivative is asked
        evaluations += list->size;
        if (loops.step(list->arrays, list->size) == 0) break;
        CutEdges& open = scratch[s];
        open.reserve(list->size);
        open.size = loops.pick(list->arrays, list->size, open.arrays);
        list = &open;
    }
    // Each list was picked from the one before.
    while (list != &edges) {
        const CutEdges& from = *list;
        list = list == scratch.data() ? &edges : list - 1;
        loops.putBack(from.arrays, list->size, list->arrays);
    }
    return evaluations;
}

}  // namespace

const EdgeLoops& edgeLoops() {
#if defined(SGM_X86_KERNELS)
    static const EdgeLoops& best = eval::bestIsa() == eval::Isa::Avx512 ? avx512::loops
                                   : eval::bestIsa() == eval::Isa::Avx2 ? avx2::loops
                                                                        : portable::loops;
    return best;
#else
    return portable::loops;
#endif
}

void CutEdges::reserve(size_t n) {
    const size_t room = wholeVectors(n) + edgeVector;
    if (room <= list.size()) return;
    list.resize(room);
    // As evaluateGradient writes them at once: f, dx, dy, dz.
    constexpr float* EdgeArrays::*rows[] = {&EdgeArrays::x,    &EdgeArrays::y,   &EdgeArrays::z,    &EdgeArrays::f,
                                            &EdgeArrays::dx,   &EdgeArrays::dy,  &EdgeArrays::dz,   &EdgeArrays::base,
                                            &EdgeArrays::span, &EdgeArrays::tIn, &EdgeArrays::fIn,  &EdgeArrays::tOut,
                                            &EdgeArrays::fOut, &EdgeArrays::t,   &EdgeArrays::axis, &EdgeArrays::open};
    memory_.resize(room * std::size(rows));
    float* row = memory_.data();
    for (const auto member : rows) arrays.*member = row, row += room;
}

uint64_t findVertices(const eval::Tape& tape, const VertexSearch& search, eval::Workspace& workspace,
                      std::vector<CutEdges>& scratch, CutEdges& edges) {
    if (edges.size == 0) return 0;
    const EdgeLoops& loops = edgeLoops();
    loops.interpolate(edges.arrays, edges.size);
    const TimedField field(tape, workspace, search);
    const uint64_t evaluations =
        search.expensive ? findByValues(field, search, edges) : findByNewton(field, search, scratch, edges);
    edges.flat = search.normals ? loops.normalize(edges.arrays, edges.size) : 0;
    return evaluations;
}

}  // namespace sgm::mesh
