// The parts of a union: what the topmost minima of a tape, those that nobody else reads, choose from, and which of them
// are left in which region. As a flat list they are told apart for all regions at once; going down the tree of minima
// region by region is a chain of loads and of branches that nobody foresees.
// Enters: a tape with its links and the bounds of evaluateRanges. Leaves: the minima that are left in a region, with
// their operands. Assumes one a thread, whose memory is used again.
#pragma once

#include <array>
#include <vector>

#include "modeler/eval/kernels.h"
#include "modeler/eval/use_def_chains.h"

namespace sgm::eval {

class UnionParts {
public:
    /// Values as in UseDefChains.
    struct Part {
        Source value;
        OriginId origin;  ///< the first word on its owner on the way from the result, whose own isn't heard; 0 for none
        uint32_t bound;   ///< its row of lower ends, see UseDefChains::bounds
        uint32_t minimum;  ///< the lowest of the tree that has it and the part before
    };
    /// What a minimum of the tree has left in a region. Where it is another minimum, its parts speak of their owners.
    struct Operands {
        Source value[2];
        OriginId origin[2];
    };

    /// Lists the parts of a tape that `chains` follows: none where its value isn't a minimum.
    void build(const Tape& tape, const UseDefChains& chains);
    bool empty() const { return parts_.empty(); }
    /// Whether a value is a minimum of the tree.
    bool isMinimum(uint32_t value) const { return minima_[value] != 0; }
    /// Whether one of them lists the owners of its operands.
    bool listed() const { return listed_; }
    /// The row of the reach of all.
    uint32_t pruneBound() const { return pruneBound_; }

    /// Tells for each of the first n regions which parts aren't above all that counts there, by `bounds`, rows of
    /// `stride` floats, and what is told apart of the result.
    /// A part that may tie with the least, see Tape::tieMargin, isn't above it.
    void classify(const float* bounds, size_t stride, size_t n, RelevantRange relevant, float tieMargin,
                  NotAbove notAbove);
    /// True once `classify` was called for this care and the last tape.
    bool isClassified(RelevantRange relevant) const { return classified_ && relevant == relevant_; }
    /// Goes to a region, by what `classify` said. False where nothing is left, for then any part will do, and where an
    /// operand is unknown: a NaN takes sides by its place in the tree.
    bool enter(size_t region);
    /// In the region: the value of all, a part or a minimum, and the owner of a single part.
    Source value() const { return value_; }
    OriginId origin() const { return origin_; }
    /// In the region: what a minimum that is needed there has left.
    const Operands& operands(uint32_t minimum) const { return operands_[minimum]; }

private:
    std::vector<Part> parts_, stack_;
    std::vector<uint8_t> minima_;  // by value
    uint32_t pruneBound_ = 0;
    bool listed_ = false, classified_ = false;
    RelevantRange relevant_;
    std::vector<uint64_t> regions_;  // of each part
    std::vector<uint32_t> left_;     // parts by region, ascending
    std::array<uint32_t, maxBoxes + 1> starts_;

    Source value_ = 0;
    OriginId origin_ = 0;
    std::vector<Operands> operands_;  // by value
    std::vector<uint32_t> open_;
};

}  // namespace sgm::eval
