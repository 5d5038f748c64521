// A formula for searches that evaluate it box after box. For this folder's sources alone.
// Enters: a formula and functions for its leaves. Leaves: bounds over boxes, and values. Assumes that each node but the
// last is an operand of one other, as monotoneFormula makes them.
#pragma once

#include <array>

#include "modeler/plan/formula.h"

namespace sgm::plan {

/// Two rectangles and their centres, for the formula's lower bounds over the former and its values at the latter: four
/// numbers side by side.
struct BoxPair {
    static constexpr size_t lanes = 4;
    using Lanes = std::array<double, lanes>;
    /// By whether a leaf falls along the axis: where it is lowest, and the centre.
    std::array<Lanes, 2> x, z;

    BoxPair(const Box2& a, const Box2& b) {
        const Vec2 atA = a.centre(), atB = b.centre();
        x = {Lanes{a.lo.x, b.lo.x, atA.x, atB.x}, Lanes{a.hi.x, b.hi.x, atA.x, atB.x}};
        z = {Lanes{a.lo.z, b.lo.z, atA.z, atB.z}, Lanes{a.hi.z, b.hi.z, atA.z, atB.z}};
    }
};

/// Maxima of maxima, and minima of minima, are one group of leaves each: the convex outline has one, of all its edges.
/// Values have the formula's own bits, but for the sign of a zero.
class GroupedFormula {
public:
    /// O(n).
    GroupedFormula(const Formula& formula, std::span<const Linear> leaves);
    /// The lower bounds over both boxes, then the values at both centres. O(n).
    BoxPair::Lanes evaluate(const BoxPair& boxes);

private:
    struct Leaf {
        Linear function;
        uint32_t x, z;  ///< whether it falls along the axis
    };
    /// Leaves begin … begin + count − 1, and the groups whose parent this is.
    struct Group {
        bool isMax = true;
        uint32_t parent = 0, begin = 0, count = 0;
    };
    std::vector<Group> groups_;  ///< each after its parent
    std::vector<Leaf> leaves_;
    std::vector<BoxPair::Lanes> values_;  ///< by group
};

}  // namespace sgm::plan
