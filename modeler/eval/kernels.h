// One step of a tape, compiled for each instruction set.
// Enters: an instruction and register files. Leaves: the instruction's output registers. Assumes 64-byte aligned
// memory. A register file is planar: register r of a value type of P floats is P rows of `stride` floats at r · P ·
// stride. The coordinates, which no instruction writes, are read from where they are: registers 0, 1, 2 stay empty, but
// for ranges.
#pragma once

#include <cstddef>
#include <cstdint>

#include "modeler/eval/tape.h"

namespace sgm::eval {

/// Floats in the longest vector: register rows are multiples of it.
inline constexpr size_t vectorFloats = 16;
/// The most points at a time: no fewer than the 9³ corners of a brick.
inline constexpr size_t maxBlock = 768;
/// Boxes at once.
inline constexpr size_t maxBoxes = 64;
/// Bytes of argument scratch a variadic op needs for each operand: a Dual of the longest vector.
inline constexpr size_t argumentBytes = 4 * vectorFloats * sizeof(float);

/// Where the steps work.
struct StepContext {
    float* registers;
    size_t stride;                ///< floats in a row, a multiple of vectorFloats
    size_t count;                 ///< floats of a row in use, a multiple of vectorFloats
    const float* coordinates[3];  ///< rows of x, y, z; not for ranges
    const float* derivatives[3];  ///< gradients: their planes dx, dy, dz, `stride` apart
    float* result;                ///< where the instruction writes, if not to its register: planes `resultStride` apart
    size_t resultStride;
    const float* constants;
    const Source* sources;
    const float* const* grids;  ///< words of the tape's grids, by number
    void* arguments;            ///< argumentBytes for each operand of the longest instruction
    float* bounds;              ///< ranges: rows of the instruction's operands and reach, where it chooses
};

using Step = void (*)(const Instruction&, const StepContext&);

/// Over n points (a multiple of vectorFloats, all rows aligned): where `values` beats `best`, both rows take this
/// operand's place. Owners are kept as the bits of floats; where `owners` is null, `one` is everybody's.
using ArgMinUpdate = void (*)(const float* values, const float* owners, float one, size_t n, float* best, float* taken);

/// The same of two operands at once, of n points (likewise): the second one's owner where it beats the first. `taken`
/// may be one of `owners`.
using OwnersOfTwo = void (*)(const float* const values[2], const float* const owners[2], const float ones[2], size_t n,
                             float* taken);

/// Copies n ≥ 1 floats to an aligned row, and the last one again up to `count`, a multiple of vectorFloats.
using LoadRow = void (*)(const float* from, size_t n, size_t count, float* row);
/// Copies n floats of an aligned row.
using StoreRow = void (*)(const float* row, size_t n, float* to);

/// Bit i is set where row[i] isn't above most[i], of n ≤ 64 floats (a multiple of vectorFloats, both rows aligned).
using NotAbove = uint64_t (*)(const float* row, const float* most, size_t n);

/// Bit i is set where a[i] + more < b[i] + less, of n ≤ 64 floats (a multiple of vectorFloats, both rows aligned).
using Below = uint64_t (*)(const float* a, float more, const float* b, float less, size_t n);

/// The steps of every op for one instruction set, by OpCode.
struct Kernels {
    const Step* values;
    const Step* gradients;       ///< Dual: rows value, dx, dy, dz
    const Step* pieceGradients;  ///< the same, but of several fields one that counts alone keeps the bits of its own
    const Step* ranges;          ///< Interval: rows lo, hi; ops that choose also write `bounds`
    ArgMinUpdate argMinUpdate, toGreater;
    OwnersOfTwo ofLesser, ofGreater;
    LoadRow load;
    StoreRow store;
    NotAbove notAbove;
    Below below;
};

namespace portable {
Kernels kernels();
}
namespace avx2 {
Kernels kernels();
}
namespace avx512 {
Kernels kernels();
}

}  // namespace sgm::eval
