// What of a value matters, and how the rows of the op table pass that on to their operands.
// Enters: what the consumers of an instruction's result tell apart, and what is known of its operands over a region.
// Leaves: what of the operands matters. Assumes that the op rounds to nearest: what is passed on is widened by that.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace sgm::field {

/// What the consumers of a value tell apart: any two numbers above `most` are the same to them, and any two below
/// `least`.
struct RelevantRange {
    float least = -std::numeric_limits<float>::infinity();
    float most = std::numeric_limits<float>::infinity();
    friend bool operator==(const RelevantRange&, const RelevantRange&) = default;
};

/// What is known of an operand over a region: a number, or the ends that the row keeps (KeptEnd); the others are NaN.
struct OperandRange {
    float lo = std::numeric_limits<float>::quiet_NaN(), hi = std::numeric_limits<float>::quiet_NaN();
    bool isNumber = false;
};

/// An end of an operand's bounds that is kept for `passOn`.
struct KeptEnd {
    uint32_t operand;
    bool high;
};

/// Of an instruction's first three operands; of others everything matters.
using RelevantOperands = std::array<RelevantRange, 3>;

/// `relevant` with both ends sent through `move`, and a little wider: the operation rounds numbers as large as `by`.
template <class Move>
RelevantRange moved(RelevantRange relevant, float by, Move&& move) {
    const auto slack = [&](float end) { return 1e-6f * (std::abs(end) + std::abs(by)); };
    const float least = move(relevant.least), most = move(relevant.most);
    const RelevantRange all;
    return {least - slack(least) <= most ? least - slack(least) : all.least,
            most + slack(most) >= least ? most + slack(most) : all.most};
}

/// Of a value beside the number operand `number`: the other one's range, both ends sent through `move`.
template <class Move>
RelevantOperands besideNumber(uint32_t number, RelevantRange relevant, float by, Move&& move) {
    RelevantOperands passed;
    passed[1 - number] = moved(relevant, by, move);
    return passed;
}

}  // namespace sgm::field
