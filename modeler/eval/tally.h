// How often tapes ran each operation: what a lower bound of their time is made of.
// Enters: a Workspace told to count (Workspace::tallyInto). Leaves: points and boxes by operation. Assumes one thread.
#pragma once

#include <compare>
#include <cstdint>
#include <map>

#include "modeler/field/graph.h"

namespace sgm::eval {

/// What of an operation is asked for: numbers at points, with derivatives, or enclosures over boxes.
enum class EvaluationKind : uint8_t { Value, Gradient, Range };

/// An operation as far as its cost depends on it.
struct Operation {
    field::OpCode op;
    uint32_t count;  ///< operands
    uint32_t data;   ///< structural integer (the passes of a KIFS)
    EvaluationKind asked = EvaluationKind::Value;
    friend auto operator<=>(const Operation&, const Operation&) = default;
};

/// Points, or boxes, that each operation was asked for.
using Tally = std::map<Operation, uint64_t>;

}  // namespace sgm::eval
