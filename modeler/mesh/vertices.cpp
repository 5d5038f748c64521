#include "modeler/mesh/vertices.h"

#include <algorithm>
#include <cmath>

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

/// Which way along their edges vertices are looked behind.
enum class Way { Outward, Inward };

/// How far behind a vertex the field has to be on the other side of 0, as a share of the edge.
constexpr float seamReach = 0x1.0p-6f;

constexpr float* EdgeArrays::*placeRows[] = {&EdgeArrays::x,    &EdgeArrays::y,    &EdgeArrays::z,
                                             &EdgeArrays::base, &EdgeArrays::span, &EdgeArrays::axis};
constexpr float* EdgeArrays::*foundRows[] = {&EdgeArrays::x,  &EdgeArrays::y,  &EdgeArrays::z,
                                             &EdgeArrays::dx, &EdgeArrays::dy, &EdgeArrays::dz};

/// Copies an edge to `to`, at share `t` of it.
void copyEdge(const EdgeArrays& from, size_t i, const EdgeArrays& to, size_t k, float t) {
    for (const auto row : placeRows) (to.*row)[k] = (from.*row)[i];
    const int axis = static_cast<int>(from.axis[i]);
    float* const moving = axis == 0 ? to.x : axis == 1 ? to.y : to.z;
    moving[k] = from.base[i] + t * from.span[i];
    to.t[k] = t;
}

float shareOf(const EdgeArrays& e, size_t i) {
    const int axis = static_cast<int>(e.axis[i]);
    return ((axis == 0 ? e.x : axis == 1 ? e.y : e.z)[i] - e.base[i]) / e.span[i];
}

/// Looks again for vertices that ended in a seam of two parts, between there and the end of the edge beyond it. Inside
/// a union of parts that touch the field is 0 in their seam, and so it is outside between cutters that do: Newton's
/// steps may end there, but solid, or air, is on both sides.
uint64_t leaveSeams(const TimedField& field, const VertexSearch& search, Way way, std::vector<CutEdges>& scratch,
                    CutEdges& edges) {
    const EdgeArrays& e = edges.arrays;
    const bool outward = way == Way::Outward;
    scratch.resize(std::max(scratch.size(), search.refineSteps + 1));
    CutEdges& behind = scratch.back();
    behind.reserve(edges.size);
    behind.size = edges.size;
    const EdgeArrays& b = behind.arrays;
    std::vector<uint32_t> which;
    for (uint32_t i = 0; i < edges.size; ++i) {
        const float end = (e.tIn[i] < e.tOut[i]) == outward ? 1 : 0, t = shareOf(e, i), way = end - t;
        if (std::abs(way) > seamReach) which.push_back(i);
        copyEdge(e, i, b, i, std::abs(way) > seamReach ? t + std::copysign(seamReach, way) : end);
    }
    field.value(b, behind.size);
    std::erase_if(which, [&](uint32_t i) { return (b.f[i] < 0) != outward; });
    if (which.empty()) return edges.size;
    CutEdges again;
    again.reserve(which.size());
    again.size = which.size();
    const EdgeArrays& a = again.arrays;
    for (size_t k = 0; k < which.size(); ++k)
        copyEdge(e, which[k], a, k, (e.tIn[which[k]] < e.tOut[which[k]]) == outward ? 1.0f : 0.0f);
    field.value(a, again.size);
    for (size_t k = 0; k < which.size(); ++k) {
        const uint32_t i = which[k];
        (outward ? a.tIn : a.tOut)[k] = b.t[i], (outward ? a.fIn : a.fOut)[k] = b.f[i];
        (outward ? a.tOut : a.tIn)[k] = a.t[k], (outward ? a.fOut : a.fIn)[k] = a.f[k];
        const float t = a.tIn[k] + (a.tOut[k] - a.tIn[k]) * (a.fIn[k] / (a.fIn[k] - a.fOut[k]));
        copyEdge(e, i, a, k, std::min(std::max(edgeMargin, t), 1 - edgeMargin));  // the margin where t is no number
    }
    const uint64_t evaluations = findByNewton(field, search, scratch, again);
    for (size_t k = 0; k < which.size(); ++k)
        for (const auto row : foundRows) (e.*row)[which[k]] = (a.*row)[k];
    return edges.size + again.size + evaluations;
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
    uint64_t evaluations =
        search.expensive ? findByValues(field, search, edges) : findByNewton(field, search, scratch, edges);
    // Always, for blocks around an edge have to agree: what of the field is left in a tape can't decide.
    for (const Way way : {Way::Outward, Way::Inward})
        if (search.exact) evaluations += leaveSeams(field, search, way, scratch, edges);
    edges.flat = search.normals ? loops.normalize(edges.arrays, edges.size) : 0;
    return evaluations;
}

}  // namespace sgm::mesh
