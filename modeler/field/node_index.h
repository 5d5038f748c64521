// Which node has which contents: what makes equal structure one node.
// Enters: nodes in their order, each with its newest operand. Leaves: whether one may be there already, and which.
// Assumes that operands come before what is made of them. A node whose newest operand nothing of its kind has used yet
// can't be there; where many such follow each other, none of them is entered before something has to be looked for, and
// not even then while it costs less to go through all nodes since the newest operand.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modeler/field/hash_index.h"

namespace sgm::field {

/// Row index in the op table (modeler/field/ops.h); `codeOf<Add>` names one.
enum class OpCode : uint16_t {};
using NodeId = uint32_t;

class NodeIndex {
public:
    NodeIndex() { waiting_.fill(HashIndex::none); }

    /// Calls enter(id) for nodes that wait, where one of them may have an operand of that kind as its newest one; then
    /// the node that `same` recognises among those of this hash, or none.
    template <class Enter, class Same>
    NodeId find(NodeId newest, OpCode kind, uint64_t hash, NodeId end, Enter&& enter, Same&& same) {
        const size_t at = placeOf(kind);
        if (seen_[at] <= newest || !isUsed(newest)) return HashIndex::none;
        if (newest >= waiting_[at]) {
            if (passed_ + (end - newest) <= end - entered_) {
                passed_ += end - newest;
                for (NodeId id = newest + 1; id < end; ++id)
                    if (same(id)) return id;
                return HashIndex::none;
            }
            for (; entered_ < end; ++entered_) enter(entered_);
            waiting_.fill(HashIndex::none);
            passed_ = 0;
        }
        return index_.find(hash, same);
    }
    /// Notes that a node was appended whose newest operand is this.
    void note(NodeId newest, OpCode kind) {
        const size_t at = placeOf(kind), word = newest / 64;
        seen_[at] = std::max(seen_[at], newest + 1);
        waiting_[at] = std::min(waiting_[at], newest);
        if (word >= used_.size()) used_.resize(word + 1);
        used_[word] |= uint64_t{1} << newest % 64;
    }
    /// Of a node without operands.
    template <class Same>
    NodeId findLeaf(uint64_t hash, Same&& same) const {
        return index_.find(hash, same);
    }
    void insert(uint64_t hash, NodeId id) { index_.insert(hash, id); }

private:
    static constexpr size_t kinds = 64;  ///< ops may share one
    bool isUsed(NodeId newest) const {
        return newest / 64 < used_.size() && (used_[newest / 64] >> newest % 64 & 1) != 0;
    }
    static size_t placeOf(OpCode kind) { return static_cast<size_t>(kind) % kinds; }

    HashIndex index_;
    NodeId entered_ = 0;                 ///< those from here on wait
    size_t passed_ = 0;                  ///< nodes that were gone through since some were entered
    std::array<NodeId, kinds> seen_{};   ///< by kind: no node has a newest operand of it from here on
    std::vector<uint64_t> used_;         ///< by node, a bit: it is the newest operand of one
    std::array<NodeId, kinds> waiting_;  ///< by kind: the first newest operand among nodes that wait
};

}  // namespace sgm::field
