// What `compile` knows of a graph's nodes on the way, kept for when their numbers change.
// Enters: a graph, a node, numbers. Leaves: a tape. Assumes the graph outlives it, with the same nodes. Nothing
// recurses: node ids are in topological order (operands first), so passes are loops over ids. The entry points are
// tape.h, for a tape once, and recompiler.h, for one that follows its numbers.
#pragma once

#include <bit>
#include <optional>

#include "modeler/core/random.h"
#include "modeler/eval/tape_builder.h"
#include "modeler/field/hash_index.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

using field::NodeId;

/// What a node turned out to be: a number, another node, or an instruction.
struct NodeClass {
    enum Kind : uint32_t { Unreached, Constant, Same, Instruction };
    uint32_t kind : 2 = Unreached;
    uint32_t need : 30 = 0;  ///< registers to compute it (Sethi & Ullman 1970), for Instruction
    /// Of Constant the number's bits, of Same the node, of Instruction the value's key in TapeBuilder.
    uint32_t what = 0;

    float value() const { return std::bit_cast<float>(what); }
};

/// UniformParams of a tape, each once: told by their bits, or by the node they come from, so that one may change alone.
class Constants {
public:
    explicit Constants(bool byNode) : byNode_(byNode) {}
    Source source(NodeId node, float value) {
        const uint32_t key = byNode_ ? node : std::bit_cast<uint32_t>(value);
        const uint32_t known = find(key);
        if (known != TapeBuilder::none) return known | constantBit;
        const auto place = static_cast<uint32_t>(values_.size());
        index_.insert(mix(key), place);
        keys_.push_back(key);
        values_.push_back(value);
        return place | constantBit;
    }
    /// Fetches what `source` reads into the cache.
    void prefetch(NodeId node, float value) const {
        index_.prefetch(mix(byNode_ ? node : std::bit_cast<uint32_t>(value)));
    }
    /// The number's place in the table, by node; none for a node that no instruction reads.
    uint32_t placeOf(NodeId node) const { return find(node); }
    std::vector<float> take() { return std::move(values_); }

private:
    static_assert(TapeBuilder::none == field::HashIndex::none);
    uint32_t find(uint32_t key) const {
        return index_.find(mix(key), [&](uint32_t place) { return keys_[place] == key; });
    }

    const bool byNode_;
    std::vector<float> values_;
    PageVector<uint32_t> keys_;  ///< by place
    field::HashIndex index_;
};

class Compiler {
public:
    Compiler(const field::Graph& graph, NodeId root, std::span<const float> constants, bool byNode, int threads = 0)
        : graph_(graph),
          threads_(threads),
          root_(root),
          slots_(constants),
          nodeClasses_(size_t{root} + 1, NodeClass{}),
          constants_(byNode) {}

    Tape run(const field::Field& field);

    // For when numbers change.
    NodeId root() const { return root_; }
    const NodeClass& nodeClass(NodeId id) const { return nodeClasses_[id]; }
    /// The node's number, from those of its operands; only for a node that is one.
    float number(NodeId id);
    void setNumber(NodeId id, float value) { nodeClasses_[id].what = std::bit_cast<uint32_t>(value); }
    void bind(std::span<const float> constants) { slots_ = constants; }
    /// The operand whose value is the node's own, since the other one is a number that changes nothing, as 1 in a
    /// product.
    std::optional<NodeId> passesOn(NodeId id) const;
    /// What a tape says of the field as a whole.
    TapeBuilder::Scale scaleOf(const field::Field& field) const;
    /// As of Constants.
    uint32_t placeOf(NodeId id) const { return constants_.placeOf(id); }

private:
    void reach();
    void decide(NodeId id);
    std::span<const NodeId> byRegisterNeed(NodeId id);
    uint32_t need(std::span<const NodeId> heavy) const;
    void order();
    void hashNodes();
    void namePieces();
    Tape write(TapeBuilder::Scale scale);
    TapeBuilder::Use useOf(const field::Operand& o);

    /// The node that stands for `id`.
    NodeId standIn(NodeId id) const { return nodeClasses_[id].kind == NodeClass::Same ? nodeClasses_[id].what : id; }
    const NodeClass& fateOf(NodeId id) const { return nodeClasses_[standIn(id)]; }
    bool isInput(NodeId id) const { return graph_.node(id).op == field::codeOf<field::ops::Input>; }

    const field::Graph& graph_;
    const int threads_;
    const NodeId root_;
    std::span<const float> slots_;
    PageVector<NodeClass> nodeClasses_;
    std::vector<float> args_;
    std::vector<NodeId> sorted_;
    PageVector<NodeId> ordered_;
    PageVector<uint64_t> hashes_;  ///< by node, of all that it consists of
    PageVector<uint32_t> pieces_;  ///< by node, see Instruction::piece
    Constants constants_;
    bool owned_ = false;  ///< someone owns something
};

}  // namespace sgm::eval
