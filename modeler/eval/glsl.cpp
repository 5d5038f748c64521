#include "modeler/eval/glsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "modeler/eval/values_glsl.h"

namespace sgm::eval {

namespace {

using field::OpCode;

// An instruction is one texel:
//   x  op in bits 0–7, flags, output register in bits 16–31
//   y  first operand: a register, or the float itself; of a listed op the word of its first operand
//   z  second operand; of a listed op the number of operands
//   w  the op's structural integer
// A listed operand is a word, a float or a register in the low half of a NaN that no constant is; lists begin with a
// texel. Before the first tape of a buffer lie its grids, the words of each from a texel on; `data` of an op that reads
// one is that texel. A tape starts with a texel (end of code, result is a float, result, 0).
constexpr uint32_t aIsFloat = 1u << 8, bIsFloat = 1u << 9, isHeavy = 1u << 10;
constexpr uint32_t registerNan = 0x7fc00000u, otherNan = 0x7fe00000u;

/// Ops with long bodies are kept apart: the interpreter visits them once each, not at every instruction.
bool heavy(OpCode op) {
    constexpr uint32_t longCost = 20;
    const auto& row = field::traits(op);
    return row.arity == field::ops::variadic || row.cost(static_cast<uint32_t>(row.arity), 0) >= longCost;
}

/// Body of the switch case for an op of one or two operands; it sets `value` from `a` and `b`.
std::string caseBody(OpCode op) {
    return field::visitOp(op, []<class Row>() -> std::string {
        GlslBody body;
        const GlslText a("a", &body), b("b", &body);
        const auto assign = [&](const GlslText& value) {
            return fmt::format("{}value = {};", body.text, value.expression);
        };
        if constexpr (Row::arity == 1)
            return assign(Row::apply(a));
        else if constexpr (Row::arity == 2)
            return assign(Row::apply(a, b));
        else if constexpr (Row::arity == field::ops::variadic)
            return fmt::format("value = op_{}(q.y, q.z, q.w);", Row::name);
        else
            return {};
    });
}

/// The numbers that an op's text names.
std::string constants(const field::OpTraits& row) {
    std::string text;
    for (const auto& [name, number] : row.glslNumbers) text += fmt::format("const uint {} = {}u;\n", name, number);
    return text;
}

std::string functions(const OpSet& ops) {
    std::string text;
    for (size_t i = 0; i < field::opCount; ++i) {
        const auto& row = field::traits(OpCode{static_cast<uint16_t>(i)});
        if (ops[i] && row.arity == field::ops::variadic)
            text += fmt::format("float op_{}(uint first, uint count, uint data) {{\n{}{}\n}}\n", row.name,
                                constants(row), row.glsl);
    }
    return text;
}

std::string cases(const OpSet& ops, bool heavyOnes) {
    std::string text;
    for (size_t i = 0; i < field::opCount; ++i) {
        const OpCode op{static_cast<uint16_t>(i)};
        if (ops[i] && field::traits(op).arity != field::ops::leaf && heavy(op) == heavyOnes)
            text += fmt::format("        case {}u: {{ {} break; }}  // {}\n", i, caseBody(op), field::traits(op).name);
    }
    return text;
}

/// One step of a kind: loads its operands, switches, stores.
std::string step(const std::string& caseText) {
    return "      float a = (q.x & 256u) != 0u ? uintBitsToFloat(q.y) : registers[q.y & registerMask];\n"
           "      float b = (q.x & 512u) != 0u ? uintBitsToFloat(q.z) : registers[q.z & registerMask];\n"
           "      float value = a;\n"
           "      switch (q.x & 255u) {\n" +
           caseText +
           "      default: break;\n      }\n"
           "      registers[q.x >> 16] = value;\n";
}

void append(std::vector<uint32_t>& buffer, uint32_t x, uint32_t y, uint32_t z, uint32_t w) {
    buffer.insert(buffer.end(), {x, y, z, w});
}

/// A source as a word: the register, or the bits of the constant.
uint32_t wordOf(const Tape& tape, Source source) {
    return isConstant(source) ? std::bit_cast<uint32_t>(tape.constants()[indexOf(source)]) : indexOf(source);
}

/// The same in a list.
uint32_t listedWordOf(const Tape& tape, Source source) {
    const uint32_t word = wordOf(tape, source);
    if (!isConstant(source)) return registerNan | word;
    return (word & 0x7fffffffu) > 0x7f800000u ? otherNan : word;
}

/// The texel of grid `number` when the grids lie at the buffer's start.
uint32_t texelOfGrid(const Grids& grids, uint32_t number) {
    size_t texel = 0;
    for (uint32_t i = 0; i < number; ++i) texel += (grids.list[i]->words().size() + 3) / 4;
    return static_cast<uint32_t>(texel);
}

void appendGrids(const Grids& grids, std::vector<uint32_t>& buffer) {
    for (const auto& grid : grids.list) {
        for (const float word : grid->words()) buffer.push_back(std::bit_cast<uint32_t>(word));
        buffer.resize((buffer.size() + 3) / 4 * 4);
    }
}

}  // namespace

OpSet opsOf(const Tape& tape) {
    OpSet ops;
    ops.set(static_cast<size_t>(field::codeOf<field::ops::Copy>));
    for (const Instruction& i : tape.code()) ops.set(static_cast<size_t>(i.op));
    return ops;
}

std::string interpreterGlsl(uint32_t maxRegisters, const OpSet& ops) {
    // A power of two, so that an operand word that isn't a register can be masked into range.
    const uint32_t registers = std::bit_ceil(std::max(maxRegisters, 4u));
    const std::string longCases = cases(ops, true);
    std::string text = fmt::format(R"(uniform usamplerBuffer tapes, tapeWords;
const uint registerMask = {}u;
float registers[{}];
float arg(uint at) {{
  uint w = texelFetch(tapeWords, int(at)).x;
  return (w >> 16) == {}u ? registers[w & 65535u & registerMask] : uintBitsToFloat(w);
}}
vec3 arg3(uint at) {{ return vec3(arg(at), arg(at + 1u), arg(at + 2u)); }}
float word(uint texel, uint i) {{ return uintBitsToFloat(texelFetch(tapeWords, int(texel * 4u + i)).x); }}
)",
                                   registers - 1, registers, registerNan >> 16);
    text += functions(ops) + R"(float evaluateField(uint tapeStart, vec3 p) {
  uvec4 head = texelFetch(tapes, int(tapeStart));
  registers[0] = p.x; registers[1] = p.y; registers[2] = p.z;
  uint at = tapeStart + 1u;
  while (at < head.x) {
    uvec4 q = uvec4(0u);
    while (at < head.x) {  // short ops, up to the next long one
      q = texelFetch(tapes, int(at));
      if ((q.x & 1024u) != 0u) break;
)" + step(cases(ops, false)) +
            "      ++at;\n    }\n";
    if (!longCases.empty()) text += "    if (at < head.x) {\n" + step(longCases) + "      ++at;\n    }\n";
    return text + "  }\n  return head.y != 0u ? uintBitsToFloat(head.z) : registers[head.z & registerMask];\n}\n";
}

uint32_t appendTape(const Tape& tape, std::vector<uint32_t>& buffer) {
    if (buffer.empty() && tape.grids()) appendGrids(*tape.grids(), buffer);
    const auto start = static_cast<uint32_t>(buffer.size() / 4);
    const auto end = start + 1 + static_cast<uint32_t>(tape.size());
    append(buffer, end, isConstant(tape.result()), wordOf(tape, tape.result()), 0);
    std::vector<uint32_t> lists;
    for (const Instruction& i : tape.code()) {
        const uint32_t x = static_cast<uint32_t>(i.op) | i.out << 16 | (heavy(i.op) ? isHeavy : 0);
        if (field::traits(i.op).arity != field::ops::variadic) {
            const uint32_t flags = (isConstant(i.a) ? aIsFloat : 0) | (isConstant(i.b) ? bIsFloat : 0);
            append(buffer, x | flags, wordOf(tape, i.a), wordOf(tape, i.b), i.data);
            continue;
        }
        append(buffer, x, end * 4 + static_cast<uint32_t>(lists.size()), i.count,
               field::traits(i.op).readsGrid ? texelOfGrid(*tape.grids(), i.data) : i.data);
        for (uint32_t k = 0; k < i.count; ++k) lists.push_back(listedWordOf(tape, tape.sources()[i.a + k]));
        lists.resize((lists.size() + 3) / 4 * 4);
    }
    buffer.insert(buffer.end(), lists.begin(), lists.end());
    return start;
}

}  // namespace sgm::eval
