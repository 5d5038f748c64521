#include "modeler/eval/evaluate.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "modeler/eval/chosen_paths.h"
#include "modeler/eval/owners.h"

namespace sgm::eval {
namespace {

static_assert(pointPadding == vectorFloats);

Kernels kernelsFor(Isa isa) {
#if defined(SGM_X86_KERNELS)
    if (isa == Isa::Avx512 && bestIsa() == Isa::Avx512) return avx512::kernels();
    if (isa != Isa::Portable && bestIsa() != Isa::Portable) return avx2::kernels();
#else
    static_cast<void>(isa);
#endif
    return portable::kernels();
}

void count(const Tape& tape, size_t n, EvaluationKind asked, Tally* tally) {
    if (!tally) return;
    for (const Instruction& in : tape.code()) (*tally)[{in.op, in.count, in.data, asked}] += n;
}

/// Up to so many regions a trace has rows without room for whole vectors, an eighth of the memory or less: long tapes
/// are asked about few.
constexpr size_t fewRegions = 4;

/// Rows of bounds of one instruction: how many its kernel or keepRange writes.
size_t boundRowsOf(const Instruction& in) {
    return (field::traits(in.op).chooses ? in.count + 1 : 0) + (needsRange(in) ? 2 : 0);
}

/// Copies the two rows that `needsRange` speaks of, see UseDefChains::boundRows.
void keepRange(const Tape& tape, const Instruction& in, const StepContext& c) {
    const field::OpTraits& row = field::traits(in.op);
    for (uint32_t end = 0; end < 2; ++end) {
        float* const to = c.bounds + end * c.stride;
        const auto [operand, high] = row.keptEnds[end];
        const Source source = row.arity == field::ops::variadic ? tape.sources()[in.a + operand]
                              : operand == 0                    ? in.a
                                                                : in.b;
        if (isConstant(source))
            std::fill_n(to, c.count, tape.constants()[indexOf(source)]);
        else
            std::copy_n(rowOf(c, source, 2, high ? 1 : 0), c.count, to);
    }
}

}  // namespace

Isa bestIsa() {
#if defined(SGM_X86_KERNELS)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return Isa::Avx512;
    if (__builtin_cpu_supports("avx2")) return Isa::Avx2;
#endif
    return Isa::Portable;
}

Workspace::Workspace(Isa isa) : impl_(std::make_unique<Impl>()) { impl_->kernels = kernelsFor(isa); }
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
void Workspace::tallyInto(Tally* tally) { impl_->tally = tally; }

void Workspace::Impl::setUpRegions(StepContext& c, const Tape& tape, const BoxBatch& regions) {
    c.count = roundedUp(regions.n);
    setUp(c, tape, 2, c.count);
    for (uint32_t axis = 0; axis < 3; ++axis) {
        float *lo = rowOf(c, axis, 2, 0), *hi = rowOf(c, axis, 2, 1);
        for (size_t i = 0; i < regions.n; ++i) {
            lo[i] = regions.boxes[i].lo[static_cast<int>(axis)];
            hi[i] = regions.boxes[i].hi[static_cast<int>(axis)];
        }
        std::fill(lo + regions.n, lo + c.count, lo[regions.n - 1]);
        std::fill(hi + regions.n, hi + c.count, hi[regions.n - 1]);
    }
}

void Workspace::Impl::setUpGradients(StepContext& c, const Tape& tape, size_t n) {
    size_t which = 0;
    while (gradientStrides[which] < n) ++which;
    setUp(c, tape, 4, gradientStrides[which]);
    AlignedFloats& kept = derivatives_[which];
    constexpr size_t rows = 5, one = 2;
    const bool fresh = kept.empty();
    float* const first = kept.get(rows * c.stride);
    if (fresh) {
        std::fill_n(first, rows * c.stride, 0.0f);
        std::fill_n(first + one * c.stride, c.stride, 1.0f);
    }
    for (size_t axis = 0; axis < 3; ++axis) c.derivatives[axis] = first + (one - axis) * c.stride;
}

void evaluate(const Tape& tape, Points points, float* out, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    count(tape, points.n, EvaluationKind::Value, w.tally);
    const bool atOnce = points.padded && endsInResult(tape);
    runBlocks(tape, points, w.kernels.values, 1, w, atOnce ? ResultRows{out, 0} : ResultRows{}, nothingBefore,
              [&](const StepContext& c, size_t first, size_t n) {
                  if (!atOnce) storeResult(tape, c, w.kernels.store, 1, 0, out + first, n);
              });
}

void evaluateGradient(const Tape& tape, Points points, float* value, float* dx, float* dy, float* dz,
                      Workspace& workspace, bool exact) {
    Workspace::Impl& w = workspace.impl();
    count(tape, points.n, EvaluationKind::Gradient, w.tally);
    float* const out[] = {value, dx, dy, dz};
    const auto apart = static_cast<size_t>(dx - value);
    const bool atOnce = points.padded && endsInResult(tape) && dx > value && dy == dx + apart && dz == dy + apart &&
                        apart % pointPadding == 0;
    runBlocks(tape, points, exact ? w.kernels.pieceGradients : w.kernels.gradients, 4, w,
              atOnce ? ResultRows{value, apart} : ResultRows{}, nothingBefore,
              [&](const StepContext& c, size_t first, size_t n) {
                  for (size_t plane = 0; plane < 4 && !atOnce; ++plane)
                      storeResult(tape, c, w.kernels.store, 4, plane, out[plane] + first, n);
              });
}

void evaluateOrigin(const Tape& tape, Points points, OriginId* out, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    count(tape, points.n, EvaluationKind::Value, w.tally);
    OwnerPass pass(tape, w);
    runBlocks(
        tape, points, w.kernels.values, 1, w, {}, [&](const Instruction& in, const StepContext& c) { pass(in, c); },
        [&](const StepContext&, size_t first, size_t n) { pass.store(out + first, n); });
}

namespace {

/// Instructions from which on it pays to find out first which ones matter to a few points.
constexpr size_t longTape = 64;

/// evaluateLabels and, with 4 planes, evaluatePieces; `done(context, names, first, n)` for each block.
template <class DoneBlock>
void followPaths(const Tape& tape, const Points& points, Workspace::Impl& w, size_t planes, const Step* steps,
                 DoneBlock&& done) {
    ChosenPaths paths(tape, w, planes, steps);
    for (size_t first = 0; first < points.n; first += pathPoints) {
        const size_t n = std::min(pathPoints, points.n - first);
        done(paths.run({points.x + first, points.y + first, points.z + first, n}), paths.names(), first, n);
    }
}

}  // namespace

void evaluateLabels(const Tape& tape, Points points, uint32_t* labels, OriginId* origins, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    count(tape, points.n, EvaluationKind::Value, w.tally);
    if (tape.size() >= longTape)
        return followPaths(tape, points, w, 1, w.kernels.values,
                           [&](const StepContext&, const LabelPass& names, size_t first, size_t n) {
                               names.store(labels + first, origins + first, n);
                           });
    LabelPass pass(tape, w, 1);
    runBlocks(
        tape, points, w.kernels.values, 1, w, {}, [&](const Instruction& in, const StepContext& c) { pass(in, c); },
        [&](const StepContext&, size_t first, size_t n) { pass.store(labels + first, origins + first, n); });
}

void evaluatePieces(const Tape& tape, Points points, const PieceSamples& out, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    count(tape, points.n, EvaluationKind::Gradient, w.tally);
    const auto store = [&](const StepContext& c, const LabelPass& names, size_t first, size_t n) {
        float* const rows[] = {out.value, out.dx, out.dy, out.dz};
        for (size_t plane = 0; plane < 4; ++plane)
            storeResult(tape, c, w.kernels.store, 4, plane, rows[plane] + first, n);
        names.store(out.labels + first, out.origins + first, n);
    };
    followPaths(tape, points, w, 4, w.kernels.pieceGradients, store);
}

RangeTrace::RangeTrace(std::shared_ptr<Pool> pool) : pool_(std::move(pool)) {
    if (pool_->free.empty()) {
        impl_ = std::make_unique<Impl>();
        return;
    }
    impl_ = std::move(pool_->free.back());
    pool_->free.pop_back();
}
RangeTrace::~RangeTrace() {
    if (impl_) pool_->free.push_back(std::move(impl_));
}
RangeTrace::RangeTrace(RangeTrace&&) noexcept = default;
RangeTrace& RangeTrace::operator=(RangeTrace&& other) noexcept {
    std::swap(pool_, other.pool_);
    std::swap(impl_, other.impl_);
    return *this;
}

RangeTrace evaluateRanges(const Tape& tape, BoxBatch regions, FloatInterval* out, Workspace& workspace,
                          std::span<const uint32_t> free) {
    assert(regions.n >= 1 && regions.n <= maxBoxes);
    Workspace::Impl& w = workspace.impl();
    count(tape, regions.n, EvaluationKind::Range, w.tally);
    StepContext c;
    w.setUpRegions(c, tape, regions);
    RangeTrace trace(w.traces);
    RangeTrace::Impl& t = trace.impl();
    t.chains.build(tape);
    t.parts.build(tape, t.chains);
    const bool areFew = regions.n <= fewRegions;
    t.regions = regions.n, t.stride = areFew ? regions.n : c.stride;
    float* const bounds = t.row(0);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < tape.size(); ++i) {
        const Instruction& in = tape.code()[i];
        float* const kept = bounds + t.chains.bounds(i) * t.stride;
        const size_t rows = areFew ? boundRowsOf(in) : 0;
        c.bounds = areFew ? w.bounds.get(std::max<size_t>(rows, 1) * c.stride) : kept;
        if (needsRange(in)) keepRange(tape, in, c);
        w.kernels.ranges[static_cast<size_t>(in.op)](in, c);
        for (size_t r = 0; r < rows; ++r) std::copy_n(c.bounds + r * c.stride, t.stride, kept + r * t.stride);
        if (free.empty() || free.front() != i) continue;
        free = free.subspan(1);
        std::fill_n(rowOf(c, in.out, 2, 0), c.count, -infinity);
        std::fill_n(rowOf(c, in.out, 2, 1), c.count, infinity);
    }
    for (size_t i = 0; i < regions.n; ++i) {
        const bool constant = isConstant(tape.result());
        const float number = constant ? tape.constants()[indexOf(tape.result())] : 0.0f;
        const FloatInterval r = constant
                                    ? FloatInterval{number, number}
                                    : FloatInterval{rowOf(c, tape.result(), 2, 0)[i], rowOf(c, tape.result(), 2, 1)[i]};
        out[i] = r.lo <= r.hi ? r : FloatInterval{-infinity, infinity};
    }
    return trace;
}

}  // namespace sgm::eval
