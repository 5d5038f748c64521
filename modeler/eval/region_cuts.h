// A long union cut to regions: which of its parts matter where, without a trace of the whole tape.
// Enters: a tape whose value is a union, up to 64 boxes. Leaves: for each box a tape of the parts that count there.
// Besides those tapes it takes memory by part, and not by instruction as evaluateRanges does, which keeps some 120
// bytes of each: what a town consists of is a union of parts that are short.
#pragma once

#include <array>
#include <vector>

#include "modeler/eval/evaluate.h"

namespace sgm::eval {

class RegionCuts {
public:
    /// Two passes over the tape for all boxes together.
    RegionCuts(const Tape& tape, BoxBatch regions, Workspace& workspace);

    /// True where the tape's value is no union: then nothing is cut.
    bool empty() const { return minima_.empty(); }
    /// That very tape without the parts that can't matter in a region; parts themselves stay as they are. Inside the
    /// region it has the same values, owners, labels and derivatives as the whole one. Not for an empty one.
    Tape cut(const Tape& tape, size_t region, Workspace& workspace) const;

private:
    /// The minima of the union, as UnionParts has them: those that nobody else reads.
    void findMinima(const Tape& tape);
    void classify(const Tape& tape, BoxBatch regions, Workspace& workspace);

    std::vector<uint32_t> minima_;               ///< their instructions, ascending
    std::vector<std::array<uint64_t, 2>> left_;  ///< of each minimum's operands: regions that they are left in, by bit
};

/// Longer tapes have no trace made of all of their instructions, at some 120 bytes each, where there is another way.
inline constexpr size_t mostTraced = 1 << 13;

/// The tape without what can't matter in a box: there it has the same values, owners, labels and derivatives. A long
/// union is first cut by its parts; where that leaves it long, parts stay as they are.
Tape shortenTo(const Tape& tape, const Box3f& box, Workspace& workspace);

}  // namespace sgm::eval
