// How often tapes ran each operation: what a lower bound of their time is made of.
// Enters: a Workspace told to count (Workspace::tallyInto). Leaves: points by operation. Assumes one thread.
#pragma once

#include <compare>
#include <cstdint>
#include <map>

#include "modeler/field/graph.h"

namespace sgm::eval {

/// An operation as far as its cost depends on it.
struct Operation {
    field::OpCode op;
    uint32_t count;         ///< operands
    uint32_t data;          ///< structural integer (the passes of a KIFS)
    bool gradient = false;  ///< with derivatives
    friend auto operator<=>(const Operation&, const Operation&) = default;
};

/// Points that each operation was asked for; boxes of intervals are not counted.
using Tally = std::map<Operation, uint64_t>;

}  // namespace sgm::eval
