// Field to tape. Nothing recurses: node ids are in topological order (operands first), so passes are loops over ids.
#include <algorithm>
#include <bit>
#include <unordered_map>

#include "modeler/eval/tape_builder.h"
#include "modeler/field/ops.h"

namespace sgm::eval {
namespace {

using field::codeOf;
using field::Graph;
using field::Node;
using field::NodeId;
namespace ops = field::ops;

/// What a node turned out to be: a number, another node, or an instruction.
struct Fate {
    enum Kind : uint8_t { Unreached, Constant, Same, Instruction } kind = Unreached;
    NodeId same = 0;    ///< Same
    float value = 0;    ///< Constant
    uint32_t need = 0;  ///< registers to compute it (Sethi & Ullman 1970), for Instruction
};

/// Numbers of a tape, each once.
class Constants {
public:
    Source source(float value) {
        const auto [at, isNew] =
            index_.try_emplace(std::bit_cast<uint32_t>(value), static_cast<uint32_t>(values_.size()));
        if (isNew) values_.push_back(value);
        return at->second | constantBit;
    }
    std::vector<float> take() { return std::move(values_); }

private:
    std::vector<float> values_;
    std::unordered_map<uint32_t, uint32_t> index_;
};

float foldedValue(const Graph& graph, const Node& n, std::span<const float> args) {
    return field::visitOp(n.op, [&]<class Row>() -> float {
        if constexpr (Row::arity == 1)
            return Row::apply(args[0]);
        else if constexpr (Row::arity == 2)
            return Row::apply(args[0], args[1]);
        else if constexpr (field::traitsOf<Row>().readsGrid)
            return Row::apply(args, graph.grids()[n.data]->words().data());
        else if constexpr (Row::arity == ops::variadic)
            return Row::apply(args, n.data);
        else
            return 0.0f;
    });
}

class Compiler {
public:
    Compiler(const Graph& graph, NodeId root, std::span<const float> constants)
        : graph_(graph), root_(root), slots_(constants), fates_(size_t{root} + 1) {}

    Tape run(float lipschitz) {
        reach();
        for (NodeId id = 0; id <= root_; ++id)
            if (fates_[id].kind != Fate::Unreached) decide(id);
        order();
        return write(lipschitz);
    }

private:
    void reach() {
        fates_[root_].kind = Fate::Instruction;
        for (NodeId id = root_ + 1; id-- > 0;)
            if (fates_[id].kind != Fate::Unreached)
                for (const field::Operand& o : graph_.operands(id)) {
                    fates_[o.node].kind = Fate::Instruction;
                    owned_ = owned_ || o.origin != 0;
                }
    }

    /// The node that stands for `id`.
    NodeId standIn(NodeId id) const { return fates_[id].kind == Fate::Same ? fates_[id].same : id; }
    const Fate& fateOf(NodeId id) const { return fates_[standIn(id)]; }
    bool isInput(NodeId id) const { return graph_.node(id).op == codeOf<ops::Input>; }

    void decide(NodeId id) {
        const Node& n = graph_.node(id);
        Fate& fate = fates_[id];
        const auto constant = [&](float v) { fate = {Fate::Constant, 0, v, 0}; };
        if (n.op == codeOf<ops::Literal>) return constant(std::bit_cast<float>(n.data));
        if (n.op == codeOf<ops::Slot>) return constant(slots_[n.data]);
        if (n.op == codeOf<ops::Input>) return;
        const auto operands = graph_.operands(id);
        args_.clear();
        for (const field::Operand& o : operands)
            if (fateOf(o.node).kind == Fate::Constant) args_.push_back(fateOf(o.node).value);
        if (args_.size() == operands.size()) return constant(foldedValue(graph_, n, args_));
        if (args_.size() == 1 && operands.size() == 2) {
            const bool second = fateOf(operands[1].node).kind == Fate::Constant;
            if ((second || field::traits(n.op).commutative) && field::keepsFirst(n.op, args_[0])) {
                fate = {Fate::Same, standIn(operands[second ? 0 : 1].node), 0, 0};
                return;
            }
        }
        fate.need = need(heavyFirst(id));
    }

    /// Operands that are instructions, those that need most registers first: the order that keeps fewest of them busy.
    std::span<const NodeId> heavyFirst(NodeId id) {
        sorted_.clear();
        for (const field::Operand& o : graph_.operands(id))
            if (fateOf(o.node).kind == Fate::Instruction && !isInput(standIn(o.node)))
                sorted_.push_back(standIn(o.node));
        const auto heavier = [&](NodeId a, NodeId b) {
            return fates_[a].need != fates_[b].need ? fates_[a].need > fates_[b].need : a < b;
        };
        std::sort(sorted_.begin(), sorted_.end(), heavier);
        return sorted_;
    }
    uint32_t need(std::span<const NodeId> heavy) const {
        uint32_t most = 1;
        for (size_t i = 0; i < heavy.size(); ++i)
            most = std::max(most, fates_[heavy[i]].need + static_cast<uint32_t>(i));
        return most;
    }

    /// Post-order over what is left, on a stack of our own.
    void order() {
        if (fateOf(root_).kind != Fate::Instruction || isInput(standIn(root_))) return;
        std::vector<bool> done(fates_.size());
        std::vector<std::pair<NodeId, bool>> stack{{standIn(root_), false}};
        while (!stack.empty()) {
            const auto [id, ready] = stack.back();
            stack.pop_back();
            if (done[id]) continue;
            if (ready) {
                done[id] = true;
                ordered_.push_back(id);
                continue;
            }
            stack.push_back({id, true});
            const auto heavy = heavyFirst(id);
            for (size_t i = heavy.size(); i-- > 0;)
                if (!done[heavy[i]]) stack.push_back({heavy[i], false});
        }
    }

    TapeBuilder::Use useOf(const field::Operand& o) {
        const Fate& f = fateOf(o.node);
        return {f.kind == Fate::Constant ? constants_.source(f.value) : standIn(o.node), o.origin};
    }

    Tape write(float lipschitz) {
        TapeBuilder builder;
        builder.begin(fates_.size());
        for (NodeId id = 0; id <= root_; ++id)
            if (fates_[id].kind != Fate::Unreached && isInput(id)) builder.bindInput(id, graph_.node(id).data);
        builder.result(useOf({root_, 0}));
        std::vector<TapeBuilder::Use> uses;
        for (size_t i = ordered_.size(); i-- > 0;) {
            const Node& n = graph_.node(ordered_[i]);
            uses.clear();
            for (const field::Operand& o : graph_.operands(ordered_[i])) uses.push_back(useOf(o));
            // min(f, f) is a place for f's owner.
            if (field::traits(n.op).selects && uses[0].source == uses[1].source && uses[0].origin == uses[1].origin) {
                builder.alias(ordered_[i], uses[0]);
                continue;
            }
            const bool listed = owned_ && field::traits(n.op).owner != ops::Owner::First;
            builder.define(ordered_[i], n.op, n.data, uses.data(), uses.size(), listed);
        }
        Tape tape;
        const auto grids = graph_.grids().empty() ? nullptr : std::make_shared<const Grids>(graph_.grids());
        builder.finish(std::make_shared<const std::vector<float>>(constants_.take()), grids, lipschitz, tape);
        return tape;
    }

    const Graph& graph_;
    const NodeId root_;
    const std::span<const float> slots_;
    std::vector<Fate> fates_;
    std::vector<float> args_;
    std::vector<NodeId> sorted_, ordered_;
    Constants constants_;
    bool owned_ = false;  ///< someone owns something
};

}  // namespace

Grids::Grids(std::vector<field::SampledGridPtr> all) : list(std::move(all)) {
    for (const field::SampledGridPtr& grid : list) words.push_back(grid->words().data());
}

Tape compile(const field::Graph& graph, const field::Field& field, std::span<const float> constants) {
    return Compiler(graph, field.value.id(), constants).run(field.lipschitz);
}

}  // namespace sgm::eval
