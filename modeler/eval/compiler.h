// What `compile` knows of a graph's nodes on the way, kept for when their numbers change.
// Enters: a graph, a node, numbers. Leaves: a tape. Assumes the graph outlives it, with the same nodes. Nothing
// recurses: node ids are in topological order (operands first), so passes are loops over ids. The entry points are
// tape.h, for a tape once, and incremental_compiler.h, for one that follows its numbers.
#pragma once

#include <bit>
#include <optional>

#include "modeler/eval/tape_builder.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

using field::NodeId;

/// What a node turned out to be: a number, another node, or an instruction.
struct NodeClass {
    enum Kind : uint32_t { Unreached, Constant, Same, Instruction };
    uint32_t kind : 2 = Unreached;
    /// Of Instruction: how many operands are instructions that need registers; 2 for two alone, 3 for more.
    uint32_t heavy : 2 = 0;
    /// Of Instruction the registers to compute it (Sethi & Ullman 1970); of Constant 1 + its place in the tape's table,
    /// 0 where no instruction reads it.
    uint32_t need : 28 = 0;
    /// Of Constant the number's bits, of Same the node, of Instruction the value's key in TapeBuilder; before it has
    /// one the first of its heavy operands, the node itself where none is.
    uint32_t what = 0;

    float value() const { return std::bit_cast<float>(what); }
};

class Compiler {
public:
    Compiler(const field::Graph& graph, NodeId root, std::span<const float> constants)
        : graph_(graph), root_(root), slots_(constants), nodeClasses_(size_t{root} + 1, NodeClass{}) {}

    Tape run(const field::Field& field, int threads = 0);

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
    /// The number's place in the tape's table; none where no instruction reads it.
    std::optional<uint32_t> placeOf(NodeId id) const {
        const uint32_t place = nodeClasses_[id].need;
        return place == 0 ? std::nullopt : std::optional(place - 1);
    }

private:
    void reach();
    void decide(NodeId id);
    void decidePair(NodeId id, NodeId a, NodeId b);
    void decideInstruction(NodeId id);
    void setInstruction(NodeId id, std::span<const NodeId> heavy);
    bool isHeavy(NodeId id) const {
        return nodeClasses_[id].kind == NodeClass::Instruction && nodeClasses_[id].need > 0;
    }
    bool isHeavier(NodeId a, NodeId b) const;
    std::span<const NodeId> byRegisterNeed(NodeId id, std::vector<NodeId>& sorted) const;
    uint32_t need(std::span<const NodeId> heavy) const;
    TapeBuilder::Scale order(const field::Field& field, int threads);
    PageVector<NodeId> inOrder(std::span<const NodeId> values) const;
    void hashNodes();
    void namePieces();
    Tape write(TapeBuilder::Scale scale);
    TapeBuilder::Use useOf(const field::Operand& o);
    Source constantAt(NodeId id);
    void fetch(NodeId id) const;

    /// The node that stands for `id`.
    NodeId standIn(NodeId id) const { return nodeClasses_[id].kind == NodeClass::Same ? nodeClasses_[id].what : id; }
    const NodeClass& fateOf(NodeId id) const { return nodeClasses_[standIn(id)]; }
    bool isInput(NodeId id) const { return graph_.node(id).op == field::codeOf<field::ops::Input>; }

    const field::Graph& graph_;
    const NodeId root_;
    std::span<const float> slots_;
    PageVector<NodeClass> nodeClasses_;
    struct {
        std::vector<float> numbers;
        std::vector<NodeId> sorted;
    } scratch_;
    std::vector<NodeId> inputs_;  ///< those reached
    PageVector<NodeId> seconds_;  ///< by node with two or more heavy operands: the second
    size_t instructions_ = 0;     ///< nodes that are one; not all are read
    PageVector<NodeId> ordered_;
    PageVector<uint64_t> hashes_;  ///< by node, of all that it consists of
    PageVector<uint32_t> pieces_;  ///< by node, see Instruction::piece
    std::vector<float> table_;     ///< the tape's constants, each once by the node that it comes from
    TapeBuilder builder_;
    bool owned_ = false;  ///< someone owns something
};

}  // namespace sgm::eval
