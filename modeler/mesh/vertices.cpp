#include "modeler/mesh/vertices.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// The loops for the widest vectors this processor has.
const EdgeLoops& edgeLoops() {
#if defined(SGM_X86_KERNELS)
    if (eval::bestIsa() == eval::Isa::Avx512) return avx512::loops;
    if (eval::bestIsa() == eval::Isa::Avx2) return avx2::loops;
#endif
    return portable::loops;
}

EdgeArrays arraysOf(CutEdges& e) {
    return {e.base.data(), e.span.data(), e.slope.data(), e.tIn.data(), e.fIn.data(),
            e.tOut.data(), e.fOut.data(), e.t.data(),     e.f.data(),   e.place.data()};
}

/// Calls visit(axis, begin, end) for the entries along each axis.
template <class Visit>
void forEachAxis(const CutEdges& e, Visit&& visit) {
    for (int axis = 0; axis < 3; ++axis) visit(axis, e.axisBegin[axis], e.axisBegin[axis + 1]);
}

/// Goes where the loops have found each vertex.
void moveToPlace(CutEdges& e) {
    float* const moving[3] = {e.x.data(), e.y.data(), e.z.data()};
    forEachAxis(e, [&](int axis, size_t begin, size_t end) {
        std::copy(e.place.data() + begin, e.place.data() + end, moving[axis] + begin);
    });
}

/// The field's value, its derivatives, and among them the one along the edge.
void evaluate(const eval::Tape& tape, CutEdges& e, eval::Workspace& workspace) {
    eval::evaluateGradient(tape, {e.x.data(), e.y.data(), e.z.data(), e.size()}, e.f.data(), e.dx.data(), e.dy.data(),
                           e.dz.data(), workspace);
    const float* const derivatives[3] = {e.dx.data(), e.dy.data(), e.dz.data()};
    forEachAxis(e, [&](int axis, size_t begin, size_t end) {
        std::copy(derivatives[axis] + begin, derivatives[axis] + end, e.slope.data() + begin);
    });
}

/// The `count` entries that a step left open; their slots say which they were.
void pickOpen(const EdgeLoops& loops, const CutEdges& from, size_t count, CutEdges& to) {
    to.reserve(count + 1);
    size_t n = 0;
    forEachAxis(from, [&](int axis, size_t begin, size_t end) {
        to.axisBegin[axis] = n;
        n += loops.listOpen(from.f.data(), begin, end, to.slot.data() + n);
    });
    to.axisBegin[3] = n;
    constexpr PageVector<float> CutEdges::*picked[] = {&CutEdges::x,    &CutEdges::y,   &CutEdges::z,   &CutEdges::base,
                                                       &CutEdges::span, &CutEdges::t,   &CutEdges::tIn, &CutEdges::fIn,
                                                       &CutEdges::tOut, &CutEdges::fOut};
    for (const auto list : picked) loops.pick((from.*list).data(), to.slot.data(), n, (to.*list).data());
}

/// Hands positions and derivatives back to where the entries were picked from.
void putBack(const EdgeLoops& loops, const CutEdges& from, CutEdges& to) {
    constexpr PageVector<float> CutEdges::*found[] = {&CutEdges::x,  &CutEdges::y,  &CutEdges::z,
                                                      &CutEdges::dx, &CutEdges::dy, &CutEdges::dz};
    for (const auto list : found) loops.putBack((from.*list).data(), from.slot.data(), from.size(), (to.*list).data());
}

}  // namespace

void CutEdges::reserve(size_t n) {
    if (n <= slot.size()) return;
    for (PageVector<float>* v :
         {&x, &y, &z, &dx, &dy, &dz, &base, &span, &slope, &tIn, &fIn, &tOut, &fOut, &t, &f, &place})
        v->resize(n);
    slot.resize(n);
}

uint64_t findVertices(const eval::Tape& tape, size_t refineSteps, eval::Workspace& workspace,
                      std::vector<CutEdges>& scratch, CutEdges& edges) {
    if (edges.size() == 0) return 0;
    const EdgeLoops& loops = edgeLoops();
    loops.interpolate(arraysOf(edges), edges.size());
    moveToPlace(edges);
    uint64_t evaluations = 0;
    scratch.resize(std::max(scratch.size(), refineSteps));
    CutEdges* list = &edges;
    for (size_t s = 0;; ++s) {
        evaluate(tape, *list, workspace);
        if (s == refineSteps) break;  // where the last step led, only the derivative is asked
        evaluations += list->size();
        const size_t open = loops.step(arraysOf(*list), list->size());
        moveToPlace(*list);
        if (open == 0) break;
        pickOpen(loops, *list, open, scratch[s]);
        list = &scratch[s];
    }
    // Each list was picked from the one before.
    while (list != &edges) {
        CutEdges& from = *list;
        list = list == scratch.data() ? &edges : list - 1;
        putBack(loops, from, *list);
    }
    edges.flat = loops.normalize(edges.dx.data(), edges.dy.data(), edges.dz.data(), edges.size());
    return evaluations;
}

}  // namespace sgm::mesh
