// A tape over many points: blocks of points small enough that their registers stay in cache.
// Enters: points in the caller's buffers. Leaves: each block's registers, seen by the caller. Assumes aligned scratch.
#pragma once

#include <algorithm>

#include "modeler/eval/workspace.h"

namespace sgm::eval {

/// Floats of registers that stay in a first-level cache.
inline constexpr size_t cacheFloats = 32 * 1024 / sizeof(float);

inline size_t roundedUp(size_t n) { return (n + vectorFloats - 1) / vectorFloats * vectorFloats; }

/// How many of n points at a time, so that the registers stay in cache.
inline size_t blockSize(const Tape& tape, size_t planes, size_t n) {
    const size_t rows = tape.registerCount() * planes, all = std::min(roundedUp(n), maxBlock);
    if (rows * all <= cacheFloats) return all;  // without a division, for most tapes are short
    return std::clamp(cacheFloats / rows / vectorFloats * vectorFloats, vectorFloats, all);
}

/// Row `plane` of a register that instructions write, or of any in ranges.
inline float* rowOf(const StepContext& c, uint32_t reg, size_t planes, size_t plane) {
    return c.registers + (reg * planes + plane) * c.stride;
}

/// Row `plane` of what an operand or the result reads, values (1 plane) or gradients (4).
inline const float* placeOf(const StepContext& c, uint32_t reg, size_t planes, size_t plane) {
    if (reg >= 3) return rowOf(c, reg, planes, plane);
    return plane == 0 ? c.coordinates[reg] : c.derivatives[reg] + (plane - 1) * c.stride;
}

/// Copies a plane of the result to `out`.
inline void storeResult(const Tape& tape, const StepContext& c, StoreRow store, size_t planes, size_t plane, float* out,
                        size_t n) {
    if (isConstant(tape.result()))
        std::fill_n(out, n, plane == 0 ? tape.constants()[indexOf(tape.result())] : 0.0f);
    else
        store(placeOf(c, tape.result(), planes, plane), n, out);
}

/// Where the result's planes go at once, if anywhere: aligned rows, with room for whole vectors.
struct ResultRows {
    float* first = nullptr;
    size_t stride = 0;
};

/// Whether the last instruction may write them.
inline bool endsInResult(const Tape& tape) {
    return tape.size() > 0 && !isConstant(tape.result()) && tape.code().back().out == tape.result();
}

/// Runs a tape over points in blocks; `before(in, context)` sees each instruction's operands, `done` each block's
/// registers. `result` only where the tape endsInResult: it isn't in the registers then.
template <class Before, class DoneBlock>
void runBlocks(const Tape& tape, const Points& points, const Step* steps, size_t planes, Workspace::Impl& w,
               ResultRows result, Before&& before, DoneBlock&& done) {
    const size_t block = blockSize(tape, planes, points.n);
    StepContext c;
    if (planes == 1)
        w.setUp(c, tape, planes, block);
    else
        w.setUpGradients(c, tape, block);
    float* const copies = points.padded ? nullptr : w.points.get(3 * block);
    c.resultStride = result.stride;
    const Instruction* const last = result.first ? &tape.code().back() : nullptr;
    for (size_t first = 0; first < points.n; first += block) {
        const size_t n = std::min(block, points.n - first);
        c.count = roundedUp(n);
        const float* const from[] = {points.x + first, points.y + first, points.z + first};
        for (size_t axis = 0; axis < 3; ++axis) {
            if (copies) w.kernels.load(from[axis], n, c.count, copies + axis * block);
            c.coordinates[axis] = copies ? copies + axis * block : from[axis];
        }
        for (const Instruction& in : tape.code()) {
            before(in, c);
            c.result = &in == last ? result.first + first : nullptr;
            steps[static_cast<size_t>(in.op)](in, c);
        }
        done(c, first, n);
    }
}

inline constexpr auto nothingBefore = [](const Instruction&, const StepContext&) {};

}  // namespace sgm::eval
