#include "modeler/eval/region_cuts.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "modeler/eval/blocks.h"
#include "modeler/eval/workspace.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

/// Calls read(source) for each operand of an instruction.
template <class Read>
void forOperands(const Tape& tape, const Instruction& in, Read read) {
    if (field::traits(in.op).arity == field::ops::variadic) {
        for (uint32_t k = in.a; k < in.a + in.count; ++k) read(tape.sources()[k]);
    } else {
        read(in.a);
        if (in.count > 1) read(in.b);
    }
}

/// Ranges of a tape over boxes, instruction by instruction: nothing is kept but what registers hold.
class RangePass {
public:
    RangePass(const Tape& tape, BoxBatch regions, Workspace::Impl& w)
        : tape_(tape), w_(w), isOne_(tape.registerCount(), false) {
        w.setUpRegions(c_, tape, regions);
        c_.bounds = w.bounds.get((size_t{std::max(tape.longest(), 2u)} + 1) * c_.stride);
    }
    /// The least or, with plane 1, the greatest value of an operand in each region.
    const float* ends(Source s, size_t plane) {
        if (!isConstant(s)) return rowOf(c_, s, 2, plane);
        number_.fill(tape_.constants()[indexOf(s)]);
        return number_.data();
    }
    size_t stride() const { return c_.stride; }
    /// Runs it to the end; calls visit(instruction, number of the minimum) before each of some minima.
    template <class Visit>
    void run(std::span<const uint32_t> minima, Visit visit) {
        size_t next = 0;
        for (size_t i = 0; i < tape_.size(); ++i) {
            const Instruction& in = tape_.code()[i];
            const bool isOne = next < minima.size() && minima[next] == i;
            if (isOne) visit(in, next++);
            w_.kernels.ranges[static_cast<size_t>(in.op)](in, c_);
            isOne_[in.out] = isOne;
        }
    }
    /// Whether an operand is another one of those minima.
    bool isMinimum(Source s) const { return !isConstant(s) && isOne_[s]; }

private:
    const Tape& tape_;
    Workspace::Impl& w_;
    StepContext c_;
    std::vector<bool> isOne_;  ///< by register: it holds one of the minima
    alignas(vectorFloats * sizeof(float)) std::array<float, maxBoxes> number_;
};

}  // namespace

RegionCuts::RegionCuts(const Tape& tape, BoxBatch regions, Workspace& workspace) {
    assert(regions.n >= 1 && regions.n <= maxBoxes);
    findMinima(tape);
    if (!empty()) classify(tape, regions, workspace);
}

void RegionCuts::findMinima(const Tape& tape) {
    if (isConstant(tape.result())) return;
    /// Of the value that a register holds, by what is read of it further on.
    struct Readers {
        uint32_t count = 0;
        bool isInUnion = false;  ///< a minimum of the union is one of them
    };
    std::vector<Readers> readers(tape.registerCount());
    readers[tape.result()].isInUnion = true;
    for (size_t i = tape.size(); i-- > 0;) {
        const Instruction& in = tape.code()[i];
        const Readers of = std::exchange(readers[in.out], {});
        const bool isInUnion = eval::isMinimum(in) && of.isInUnion && of.count <= 1;
        if (isInUnion) minima_.push_back(static_cast<uint32_t>(i));
        forOperands(tape, in, [&](Source s) {
            if (isConstant(s)) return;
            ++readers[s].count;
            readers[s].isInUnion |= isInUnion;
        });
    }
    std::reverse(minima_.begin(), minima_.end());
}

void RegionCuts::classify(const Tape& tape, BoxBatch regions, Workspace& workspace) {
    Workspace::Impl& w = workspace.impl();
    // The least of what the parts reach at most. Where one is unknown all stay: a NaN takes sides by its place.
    alignas(vectorFloats * sizeof(float)) std::array<float, maxBoxes> most;
    most.fill(std::numeric_limits<float>::infinity());
    uint64_t unknown = 0;
    RangePass reaches(tape, regions, w);
    reaches.run(minima_, [&](const Instruction& in, size_t) {
        for (const Source s : {in.a, in.b}) {
            if (reaches.isMinimum(s)) continue;
            for (size_t r = 0; r < regions.n; ++r) {
                const float lo = reaches.ends(s, 0)[r], hi = reaches.ends(s, 1)[r];
                unknown |= uint64_t{!(lo <= hi)} << r;
                most[r] = std::min(most[r], hi);
            }
        }
    });
    for (float& end : most) end += tape.tieMargin();

    left_.resize(minima_.size());
    std::vector<uint64_t> leftIn(tape.registerCount(), 0);  // of minima
    RangePass parts(tape, regions, w);
    parts.run(minima_, [&](const Instruction& in, size_t minimum) {
        const auto left = [&](Source s) {
            if (parts.isMinimum(s)) return leftIn[s];
            return w.kernels.notAbove(parts.ends(s, 0), most.data(), parts.stride()) | unknown;
        };
        left_[minimum] = {left(in.a), left(in.b)};
        leftIn[in.out] = left_[minimum][0] | left_[minimum][1];
    });
}

Tape RegionCuts::cut(const Tape& tape, size_t region, Workspace& workspace) const {
    TapeBuilder& b = workspace.impl().builder;
    // Going backward, a register stands for the one value that it holds then.
    b.begin(tape.registerCount());
    for (uint32_t axis = 0; axis < 3; ++axis) b.bindInput(axis, axis);
    b.result({tape.result(), tape.origins()[0]});
    size_t next = minima_.size();
    for (size_t i = tape.size(); i-- > 0;) {
        const Instruction& in = tape.code()[i];
        const bool isInUnion = next > 0 && minima_[next - 1] == i;
        if (isInUnion) --next;
        if (!b.isLive(in.out)) continue;
        const OriginId* const origins = in.origins ? tape.origins().data() + in.origins - 1 : nullptr;
        const Source two[] = {in.a, in.b};
        const Source* const operands =
            field::traits(in.op).arity == field::ops::variadic ? tape.sources().data() + in.a : two;
        const auto isLeft = [&](size_t k) { return !isInUnion || (left_[next][k] >> region & 1) != 0; };
        if (isLeft(0) && isLeft(1)) {
            b.define(in.out, in, operands, origins);
        } else {
            const size_t k = isLeft(0) ? 0 : 1;
            b.alias(in.out, {operands[k], origins ? origins[k] : 0});
        }
    }
    Tape result;
    b.finish(tape.sharedConstants(), tape.grids(), TapeBuilder::scaleOf(tape), result);
    return result;
}

Tape shortenTo(const Tape& tape, const Box3f& box, Workspace& workspace) {
    const auto byTrace = [&](const Tape& whole, Workspace& scratch) {
        FloatInterval range;
        const RangeTrace trace = evaluateRanges(whole, {&box, 1}, &range, scratch);
        return shorten(whole, trace, 0, scratch);
    };
    if (tape.size() <= mostTraced) return byTrace(tape, workspace);
    const RegionCuts cuts(tape, {&box, 1}, workspace);
    if (cuts.empty()) {
        Workspace own;  // what the trace takes is gone afterwards
        return byTrace(tape, own);
    }
    Tape parts = cuts.cut(tape, 0, workspace);
    return parts.size() > mostTraced ? std::move(parts) : byTrace(parts, workspace);
}

}  // namespace sgm::eval
