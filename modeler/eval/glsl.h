// The op table as GLSL: one interpreter for every field.
// Enters: nothing but the op table; tapes become texels for its buffer. Leaves: GLSL functions and buffer contents.
// Assumes GLSL 4.30 and a buffer texture of RGBA32UI texels called `tapes` (on software GL a third faster than a
// storage buffer), with the same words one by one as `tapeWords` (R32UI); the interpreter's opcode switch is generated
// from the table.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

#include "modeler/eval/tape.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

/// A set of op codes.
using OpSet = std::bitset<field::opCount>;
/// Every op of the table.
inline OpSet allOps() { return OpSet().set(); }
/// The ops of a tape; all its shortened forms use a subset of them and Copy.
OpSet opsOf(const Tape& tape);

/// GLSL source of `float evaluateField(uint tapeStart, vec3 p)` over the texels of `tapes`, with everything it needs.
/// `maxRegisters` sizes its register file. It interprets the ops in `ops`: a driver without branches (llvmpipe) pays
/// for all of them at every instruction, so a short list is faster.
std::string interpreterGlsl(uint32_t maxRegisters, const OpSet& ops = allOps());

/// Appends a tape to `buffer`, four words a texel, and returns the texel where it starts. The first tape of a buffer
/// brings its grids along; all of a buffer have the same, as the shortened forms of one tape do.
uint32_t appendTape(const Tape& tape, std::vector<uint32_t>& buffer);

}  // namespace sgm::eval
