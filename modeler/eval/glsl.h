// The op table as GLSL: one interpreter for every field.
// Enters: nothing but the op table; tapes become words for its buffer. Leaves: GLSL functions and buffer contents.
// Assumes GLSL 4.30 (shader storage buffers); the interpreter's opcode switch is generated from the table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modeler/eval/tape.h"

namespace sgm::eval {

/// GLSL source of `float evaluateField(uint tapeStart, vec3 p)` over a buffer of words, with everything it needs.
/// `maxRegisters` sizes its register file.
std::string interpreterGlsl(uint32_t maxRegisters);

/// Appends a tape's words to `buffer` and returns where it starts.
uint32_t appendTape(const Tape& tape, std::vector<uint32_t>& buffer);

}  // namespace sgm::eval
