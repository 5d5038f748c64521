// Field to tape.
#include "modeler/eval/compiler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/core/random.h"

namespace sgm::eval {
namespace {

using field::codeOf;
using field::Graph;
using field::Node;
namespace ops = field::ops;

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

}  // namespace

Tape Compiler::run(const field::Field& field, int wanted) {
    // What tells values apart hangs on the graph, what orders them on numbers: two threads can share the passes.
    constexpr NodeId many = 1 << 14;
    const int threads = root_ >= many ? wanted : 1;
    seconds_.resize(nodeClasses_.size());
    parallelFor(2, threads, nullptr, [&](size_t task, int) {
        if (task == 1) return hashNodes();
        reach();
        for (NodeId id = 0; id <= root_; ++id)
            if (nodeClasses_[id].kind != NodeClass::Unreached) decide(id);
    });
    return write(order(field, threads));
}

void Compiler::reach() {
    nodeClasses_[root_].kind = NodeClass::Instruction;
    for (NodeId id = root_ + 1; id-- > 0;)
        if (nodeClasses_[id].kind != NodeClass::Unreached)
            for (const field::Operand& o : graph_.operands(id)) {
                nodeClasses_[o.node].kind = NodeClass::Instruction;
                owned_ = owned_ || o.origin != 0;
            }
}

float Compiler::number(NodeId id) {
    const Node& n = graph_.node(id);
    if (n.op == codeOf<ops::Literal>) return std::bit_cast<float>(n.data);
    if (n.op == codeOf<ops::Slot>) return slots_[n.data];
    scratch_.numbers.clear();
    for (const field::Operand& o : graph_.operands(id)) scratch_.numbers.push_back(fateOf(o.node).value());
    return foldedValue(graph_, n, scratch_.numbers);
}

std::optional<NodeId> Compiler::passesOn(NodeId id) const {
    const auto operands = graph_.operands(id);
    if (operands.size() != 2) return {};
    const NodeClass &a = fateOf(operands[0].node), &b = fateOf(operands[1].node);
    if ((a.kind == NodeClass::Constant) == (b.kind == NodeClass::Constant)) return {};
    const bool second = b.kind == NodeClass::Constant;
    const field::OpCode op = graph_.node(id).op;
    if (!(second || field::traits(op).commutative) || !field::keepsFirst(op, second ? b.value() : a.value())) return {};
    return standIn(operands[second ? 0 : 1].node);
}

void Compiler::decide(NodeId id) {
    const auto operands = graph_.operands(id);
    if (isInput(id)) {
        inputs_.push_back(id);
        return;
    }
    if (operands.size() == 2) return decidePair(id, standIn(operands[0].node), standIn(operands[1].node));
    const auto isNumber = [&](const field::Operand& o) { return fateOf(o.node).kind == NodeClass::Constant; };
    if (std::all_of(operands.begin(), operands.end(), isNumber))
        nodeClasses_[id] = {NodeClass::Constant, 0, 0, std::bit_cast<uint32_t>(number(id))};
    else
        decideInstruction(id);
}

/// Most nodes have two operands: what stands for them is looked up once.
void Compiler::decidePair(NodeId id, NodeId a, NodeId b) {
    NodeClass& nodeClass = nodeClasses_[id];
    const bool isNumberA = nodeClasses_[a].kind == NodeClass::Constant,
               isNumberB = nodeClasses_[b].kind == NodeClass::Constant;
    if (isNumberA && isNumberB) {
        nodeClass = {NodeClass::Constant, 0, 0, std::bit_cast<uint32_t>(number(id))};
        return;
    }
    if (isNumberA || isNumberB)
        if (const auto same = passesOn(id)) {
            nodeClass = {NodeClass::Same, 0, 0, *same};
            return;
        }
    std::array<NodeId, 2> heavy;
    size_t count = 0;
    if (isHeavy(a)) heavy[count++] = a;
    if (isHeavy(b)) heavy[count++] = b;
    if (count == 2 && isHeavier(b, a)) std::swap(heavy[0], heavy[1]);
    setInstruction(id, std::span(heavy).first(count));
}

void Compiler::decideInstruction(NodeId id) { setInstruction(id, byRegisterNeed(id, scratch_.sorted)); }

void Compiler::setInstruction(NodeId id, std::span<const NodeId> heavy) {
    const auto count = static_cast<uint32_t>(std::min<size_t>(heavy.size(), 3));
    nodeClasses_[id] = {NodeClass::Instruction, count, need(heavy), heavy.empty() ? id : heavy[0]};
    if (count > 1) seconds_[id] = heavy[1];
    ++instructions_;
}

/// Whether `a` needs more registers than `b`; the older one first where both need as many.
bool Compiler::isHeavier(NodeId a, NodeId b) const {
    return nodeClasses_[a].need != nodeClasses_[b].need ? nodeClasses_[a].need > nodeClasses_[b].need : a < b;
}

/// Operands that are instructions, those that need most registers first: the order that keeps fewest of them busy.
std::span<const NodeId> Compiler::byRegisterNeed(NodeId id, std::vector<NodeId>& sorted) const {
    const auto operands = graph_.operands(id);
    if (sorted.size() < operands.size()) sorted.resize(operands.size());
    NodeId *const begin = sorted.data(), *end = begin;
    for (const field::Operand& o : operands)
        if (const NodeId at = standIn(o.node); isHeavy(at)) *end++ = at;  // inputs need no register
    std::sort(begin, end, [&](NodeId a, NodeId b) { return isHeavier(a, b); });
    return {begin, end};
}

uint32_t Compiler::need(std::span<const NodeId> heavy) const {
    uint32_t most = 1;
    for (uint32_t i = 0; i < heavy.size(); ++i) most = std::max(most, nodeClasses_[heavy[i]].need + i);
    return most;
}

/// Post-order over what is left, and beside it what hangs on nothing of it. Gives values the keys that the builder
/// knows them by: far fewer than nodes, most of which are numbers. Gives what is said of the field as a whole, for
/// which a thread is free meanwhile.
TapeBuilder::Scale Compiler::order(const field::Field& field, int threads) {
    TapeBuilder::Scale scale{};
    // Two halves of what the root reads. Both may order what they share: then it stands in the first.
    std::array<PageVector<NodeId>, 2> halves;
    std::vector<NodeId> heavy;
    const bool isInstruction = fateOf(root_).kind == NodeClass::Instruction && !isInput(standIn(root_));
    if (isInstruction) heavy.resize(byRegisterNeed(standIn(root_), heavy).size());
    const size_t middle = threads == 1 ? heavy.size() : heavy.size() / 2;
    parallelFor(4, threads, nullptr, [&](size_t task, int) {
        if (task == 0) builder_.reserve(instructions_ + 3, instructions_);
        if (task == 1) halves[0] = inOrder(std::span(heavy).first(middle));
        if (task == 2) halves[1] = inOrder(std::span(heavy).subspan(middle));
        if (task == 3) namePieces(), scale = scaleOf(field);
    });
    std::vector<bool> done(nodeClasses_.size());
    const auto put = [&](NodeId id) {
        if (done[id]) return;
        done[id] = true;
        nodeClasses_[id].what = static_cast<uint32_t>(ordered_.size());
        ordered_.push_back(id);
    };
    ordered_.reserve(halves[0].size() + halves[1].size() + 1);
    for (const PageVector<NodeId>& half : halves) std::for_each(half.begin(), half.end(), put);
    if (isInstruction) put(standIn(root_));
    return scale;
}

/// These values and all that they consist of, each after what it is made of; on a stack of our own.
PageVector<NodeId> Compiler::inOrder(std::span<const NodeId> values) const {
    PageVector<NodeId> ordered;
    std::vector<bool> done(nodeClasses_.size());
    std::vector<NodeId> sorted;
    std::vector<std::pair<NodeId, bool>> stack;
    constexpr NodeId ahead = 64;
    for (size_t i = values.size(); i-- > 0;) stack.push_back({values[i], false});
    while (!stack.empty()) {
        const auto [id, ready] = stack.back();
        stack.pop_back();
        if (done[id]) continue;
        if (ready) {
            done[id] = true;
            ordered.push_back(id);
            continue;
        }
        stack.push_back({id, true});
        const NodeClass& nodeClass = nodeClasses_[id];
        // What a value is made of lies below it, mostly in a row.
        __builtin_prefetch(&nodeClasses_[id - std::min(id, ahead)]);
        if (nodeClass.heavy > 2) {
            const auto heavy = byRegisterNeed(id, sorted);
            for (size_t i = heavy.size(); i-- > 0;)
                if (!done[heavy[i]]) stack.push_back({heavy[i], false});
            continue;
        }
        if (nodeClass.heavy == 2) stack.push_back({seconds_[id], false});
        if (nodeClass.heavy > 0) stack.push_back({nodeClass.what, false});
    }
    return ordered;
}

TapeBuilder::Use Compiler::useOf(const field::Operand& o) {
    const NodeClass& f = fateOf(o.node);
    return {f.kind == NodeClass::Constant ? constantAt(standIn(o.node)) : f.what, o.origin};
}

/// What is known of a node and its operands, into the caches.
void Compiler::fetch(NodeId id) const {
    __builtin_prefetch(&pieces_[id]);
    for (const field::Operand& o : graph_.operands(id)) __builtin_prefetch(&nodeClasses_[o.node]);
}

/// The place of a number in the tape's table.
Source Compiler::constantAt(NodeId id) {
    NodeClass& number = nodeClasses_[id];
    if (number.need == 0) {
        table_.push_back(number.value());
        number.need = static_cast<uint32_t>(table_.size());
    }
    return (number.need - 1) | constantBit;
}

/// Tells nodes by all that they consist of, slots by their keys: so names outlast a change of numbers and of other
/// parts. Reads nothing but the graph.
void Compiler::hashNodes() {
    hashes_.resize(nodeClasses_.size());
    for (NodeId id = 0; id <= root_; ++id) {
        const Node& n = graph_.node(id);
        uint64_t hash = combine(static_cast<uint64_t>(n.op) + 1, n.data);
        if (n.op == codeOf<ops::Slot>) {
            const field::SlotKey key = graph_.slotKeys()[n.data];
            if (!(key == field::SlotKey{})) hash = combine(mix(key.path), key.attribute);
        } else if (field::traits(n.op).readsGrid) {
            hash = combine(static_cast<uint64_t>(n.op) + 1, graph_.grids()[n.data]->hash());
        }
        for (const field::Operand& o : graph_.operands(id)) hash = combine(hash, hashes_[o.node]);
        hashes_[id] = hash;
    }
}

/// Names each value from which an op chooses. What a blend joins has the name of the blend.
void Compiler::namePieces() {
    pieces_.assign(nodeClasses_.size(), 0);
    const auto nameOf = [&](NodeId id) { return static_cast<uint32_t>(hashes_[id]) | 1u; };
    for (NodeId id = root_ + 1; id-- > 0;) {  // a blend before what it joins
        if (nodeClasses_[id].kind == NodeClass::Unreached) continue;
        const field::OpTraits& row = field::traits(graph_.node(id).op);
        const bool blends = row.pieces == ops::Pieces::Joined;
        if (blends && pieces_[id] == 0) pieces_[id] = nameOf(id);
        if (!blends && !row.selects && !row.hasSides) continue;
        for (const field::Operand& o : graph_.operands(id).subspan(blends ? 1 : 0))
            if (const NodeId of = standIn(o.node); blends || pieces_[of] == 0)
                pieces_[of] = blends ? pieces_[id] : nameOf(of);
    }
}

TapeBuilder::Scale Compiler::scaleOf(const field::Field& field) const {
    const Box3f& box = field.bounds;
    uint32_t chosen = 0;
    for (const NodeId id : inputs_)
        if (pieces_[id] != 0) chosen |= 1u << graph_.node(id).data;
    if (box.empty() || !box.finite()) return {field.lipschitz, 0, chosen};
    float most = 0;
    for (const Vec3f& end : {box.lo, box.hi})
        most = std::max({most, std::abs(end.x), std::abs(end.y), std::abs(end.z)});
    constexpr int bits = 20;  // of a float's 24
    int exponent = 0;
    std::frexp(most, &exponent);
    return {field.lipschitz, std::ldexp(1.0f, exponent - bits), chosen};
}

Tape Compiler::write(TapeBuilder::Scale scale) {
    TapeBuilder builder = std::move(builder_);
    builder.begin(ordered_.size() + 3, ordered_.size());
    for (const NodeId id : inputs_) {
        nodeClasses_[id].what = static_cast<uint32_t>(ordered_.size()) + graph_.node(id).data;
        builder.bindInput(nodeClasses_[id].what, graph_.node(id).data);
    }
    builder.result(useOf({root_, 0}));
    std::vector<TapeBuilder::Use> uses;
    constexpr size_t ahead = 16;  // a large graph lies outside the caches, and its nodes aren't read in their order
    for (size_t i = ordered_.size(); i-- > 0;) {
        if (i >= 3 * ahead) __builtin_prefetch(&graph_.node(ordered_[i - 3 * ahead]));
        if (i >= 2 * ahead) __builtin_prefetch(graph_.operands(ordered_[i - 2 * ahead]).data());
        if (i >= ahead) fetch(ordered_[i - ahead]);
        const Node& n = graph_.node(ordered_[i]);
        const auto key = static_cast<uint32_t>(i);
        uses.clear();
        for (const field::Operand& o : graph_.operands(ordered_[i])) uses.push_back(useOf(o));
        // min(f, f) is a place for f's owner.
        if (field::traits(n.op).selects && uses[0].source == uses[1].source && uses[0].origin == uses[1].origin) {
            builder.alias(key, uses[0]);
            continue;
        }
        const bool listed = owned_ && field::traits(n.op).owner != ops::Owner::First;
        const Instruction like{.op = n.op, .count = 0, .out = 0, .data = n.data, .piece = pieces_[ordered_[i]]};
        builder.define(key, like, uses.data(), uses.size(), listed);
    }
    const auto grids = graph_.grids().empty() ? nullptr : std::make_shared<const Grids>(graph_.grids());
    return builder.release(std::make_shared<const std::vector<float>>(std::move(table_)), grids, scale);
}

Grids::Grids(std::vector<field::SampledGridPtr> all) : list(std::move(all)) {
    for (const field::SampledGridPtr& grid : list) words.push_back(grid->words().data());
}

Tape compile(const field::Graph& graph, const field::Field& field, std::span<const float> constants, int threads) {
    return Compiler(graph, field.value.id(), constants).run(field, threads);
}

}  // namespace sgm::eval
