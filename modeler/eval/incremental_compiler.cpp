#include "modeler/eval/incremental_compiler.h"

#include <algorithm>
#include <functional>
#include <queue>

#include "modeler/eval/compiler.h"

namespace sgm::eval {

struct IncrementalCompiler::State {
    State(const field::Graph& graph, const field::Field& field)
        : constants(graph.constants().begin(), graph.constants().end()),
          compiler(graph, field.value.id(), constants),
          tape(compiler.run(field)) {}

    /// Lists who reads a number, and which node is which slot.
    void index(const field::Graph& graph);

    std::vector<float> constants;  ///< the slots that the tape was bound to
    Compiler compiler;
    Tape tape;
    std::vector<NodeId> slotNodes;      ///< by slot; the root's successor for one that isn't reached
    std::vector<uint32_t> firstReader;  ///< by node, in `readers`; empty before `index`
    std::vector<NodeId> readers;
};

void IncrementalCompiler::State::index(const field::Graph& graph) {
    const NodeId end = compiler.root() + 1;
    slotNodes.assign(constants.size(), end);
    firstReader.assign(end + size_t{1}, 0);
    const auto forReads = [&](auto f) {
        for (NodeId id = 0; id < end; ++id)
            if (compiler.nodeClass(id).kind != NodeClass::Unreached)
                for (const field::Operand& o : graph.operands(id))
                    if (compiler.nodeClass(o.node).kind == NodeClass::Constant) f(o.node, id);
    };
    forReads([&](NodeId number, NodeId) { ++firstReader[number + 1]; });
    for (NodeId id = 0; id < end; ++id) {
        firstReader[id + 1] += firstReader[id];
        if (compiler.nodeClass(id).kind != NodeClass::Unreached && graph.node(id).op == field::codeOf<field::ops::Slot>)
            slotNodes[graph.node(id).data] = id;
    }
    readers.resize(firstReader[end]);
    std::vector<uint32_t> at(firstReader.begin(), firstReader.end() - 1);
    forReads([&](NodeId number, NodeId reader) { readers[at[number]++] = reader; });
}

IncrementalCompiler::IncrementalCompiler() = default;
IncrementalCompiler::~IncrementalCompiler() = default;
IncrementalCompiler::IncrementalCompiler(IncrementalCompiler&&) noexcept = default;
IncrementalCompiler& IncrementalCompiler::operator=(IncrementalCompiler&&) noexcept = default;

const Tape& IncrementalCompiler::tape() const { return state_->tape; }

void IncrementalCompiler::startOver(const field::Graph& graph, const field::Field& field) {
    whole_ = true;
    state_ = std::make_unique<State>(graph, field);
}

/// Sends changed slots through the numbers that are made of them, up to the instructions that read them.
bool IncrementalCompiler::rebind(const field::Graph& graph, const field::Field& field) {
    if (field.value.id() != state_->compiler.root() || graph.constants().size() != state_->constants.size())
        return false;
    if (state_->firstReader.empty()) state_->index(graph);
    Compiler& compiler = state_->compiler;
    std::priority_queue<NodeId, std::vector<NodeId>, std::greater<>> dirty;  // operands first
    const auto now = graph.constants();
    for (size_t slot = 0; slot < now.size(); ++slot) {
        if (std::bit_cast<uint32_t>(now[slot]) == std::bit_cast<uint32_t>(state_->constants[slot])) continue;
        state_->constants[slot] = now[slot];
        if (state_->slotNodes[slot] <= compiler.root()) dirty.push(state_->slotNodes[slot]);
    }
    std::shared_ptr<std::vector<float>> table;
    changed_ = {state_->tape.sharedConstants(), {}};
    for (NodeId last = compiler.root() + 1; !dirty.empty();) {
        const NodeId id = dirty.top();
        dirty.pop();
        if (id == last) continue;
        last = id;
        const float value = compiler.number(id);
        if (std::bit_cast<uint32_t>(value) == compiler.nodeClass(id).what) continue;
        compiler.setNumber(id, value);
        if (const auto place = compiler.placeOf(id)) {
            if (!table) table = std::make_shared<std::vector<float>>(*changed_.before);
            (*table)[*place] = value;
            changed_.places.push_back(*place);
        }
        for (uint32_t r = state_->firstReader[id]; r < state_->firstReader[id + 1]; ++r) {
            const NodeId reader = state_->readers[r];
            const NodeClass& nodeClass = compiler.nodeClass(reader);
            if (nodeClass.kind == NodeClass::Constant)
                dirty.push(reader);
            else if (compiler.passesOn(reader).has_value() != (nodeClass.kind == NodeClass::Same))
                return false;
        }
    }
    std::sort(changed_.places.begin(), changed_.places.end());
    TapeBuilder::rebind(state_->tape, table ? table : changed_.before, compiler.scaleOf(field));
    return true;
}

void IncrementalCompiler::follow(const field::Graph& graph, const field::Field& field) {
    if (!state_ || !rebind(graph, field)) return startOver(graph, field);
    whole_ = false;
}

}  // namespace sgm::eval
