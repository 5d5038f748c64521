#include "modeler/field/graph.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>
#include <utility>

#include "modeler/core/random.h"
#include "modeler/field/ops.h"

namespace sgm::field {
namespace {

// Graphs of many shapes are far larger than the caches: what is built together has hashes that lie together.

/// Of a node without operands.
uint64_t hashOf(OpCode op, uint32_t data) { return mix(static_cast<uint64_t>(op) << 32 | data); }

/// Near those of nodes whose newest operand is as old: five bits, of a product, tell these apart.
uint64_t hashOf(OpCode op, std::span<const Operand> operands, uint32_t data, NodeId newest) {
    constexpr uint64_t spread = 0x9e3779b97f4a7c15ull;
    uint64_t h = (static_cast<uint64_t>(op) << 32 | data) * spread;
    uint64_t factor = spread;  // of its own for each place, and no product waits for another
    for (const Operand& o : operands) h += (static_cast<uint64_t>(o.origin) << 32 | o.node) * (factor += 2 * spread);
    return 2 * static_cast<uint64_t>(newest) + (h >> 59);
}

uint64_t hashOf(const SlotKey& key) { return combine(key.path, key.attribute); }

bool isLiteral(const Node& n) { return n.op == codeOf<ops::Literal>; }
float literalOf(const Node& n) { return std::bit_cast<float>(n.data); }

/// The value of an op of one or two literals.
std::optional<float> folded(OpCode op, float a, float b, size_t count) {
    return visitOp(op, [&]<class Row>() -> std::optional<float> {
        if constexpr (Row::arity == 1) {
            if (count == 1) return Row::apply(a);
        } else if constexpr (Row::arity == 2) {
            if (count == 2) return Row::apply(a, b);
        }
        return {};
    });
}

NodeRef binary(OpCode op, NodeRef a, NodeRef b) { return a.graph().apply(op, {a, b}); }
NodeRef unary(OpCode op, NodeRef a) { return a.graph().apply(op, {a}); }

}  // namespace

Graph::Graph() = default;

void Graph::reserveBoxes(size_t count) {
    // Centre and half-size are slots; the coordinates less the centre; the box; the minimum that joins it.
    constexpr size_t slots = 6, differences = 3;
    const auto reserve = [](auto& list, size_t more) { list.reserve(list.size() + more); };
    reserve(nodes_, count * (slots + differences + 2));
    reserve(operands_, count * (2 * differences + (slots + 3) + 2));
    reserve(constants_, count * slots);
    reserve(slotKeys_, count * slots);
    reserve(slotNodes_, count * slots);
    reserve(runs_, count);
    nodeIndex_.reserve(nodes_.size() + count * (differences + 2));
    runIndex_.reserve(runs_.size() + count);
}

NodeRef Graph::input(uint32_t axis) {
    if (inputs_[axis] == absent) inputs_[axis] = append(codeOf<ops::Input>, {}, axis);
    return {this, inputs_[axis]};
}

NodeRef Graph::literal(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    if (latestLiteral_ == absent || nodes_[latestLiteral_].data != bits)
        latestLiteral_ = insert(codeOf<ops::Literal>, {}, bits);
    return {this, latestLiteral_};
}

NodeRef Graph::slot(SlotKey key, float value) {
    SlotRun& run = runs_[runOf(key.path)];
    if (const SlotId known = findSlot(run, key); known != absent) {
        constants_[known] = value;
        return {this, slotNodes_[known]};
    }
    const auto next = static_cast<SlotId>(constants_.size());
    if (run.count == 0) run.first = next;
    if (run.first + run.count == next && run.count < longestRun) {
        ++run.count;
    } else {
        run.hasMore = true;
        laterSlots_.insert(hashOf(key), next);
    }
    return addSlot(key, value);
}

void Graph::addSlots(uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                     std::span<NodeRef> slots) {
    SlotRun& run = runs_[runOf(path)];
    const size_t first = constants_.size(), count = attributes.size();
    const bool goesOn = run.count == 0 || (run.first + run.count == first && !run.hasMore);
    const auto isKnown = [&](uint64_t attribute) { return findSlot(run, {path, attribute}) != absent; };
    if (!goesOn || run.count + count > longestRun || std::any_of(attributes.begin(), attributes.end(), isKnown)) {
        for (size_t i = 0; i < count; ++i) slots[i] = slot({path, attributes[i]}, values[i]);
        return;
    }
    if (run.count == 0) run.first = static_cast<SlotId>(first);
    run.count += static_cast<uint32_t>(count);
    const auto operands = static_cast<uint32_t>(operands_.size()), node = static_cast<NodeId>(nodes_.size());
    constants_.resize(first + count);
    slotKeys_.resize(first + count);
    slotNodes_.resize(first + count);
    nodes_.resize(node + count);
    float* const constant = constants_.data() + first;
    SlotKey* const key = slotKeys_.data() + first;
    NodeId* const slotNode = slotNodes_.data() + first;
    Node* const made = nodes_.data() + node;
    for (uint32_t i = 0; i < count; ++i) {
        constant[i] = values[i];
        key[i] = {path, attributes[i]};
        slotNode[i] = node + i;
        made[i] = {codeOf<ops::Slot>, static_cast<SlotId>(first + i), operands, 0};
        slots[i] = {this, node + i};
    }
}

/// The number of the run of a path, which is empty where no slot of the path is known.
uint32_t Graph::runOf(uint64_t path) {
    const auto isOf = [&](uint32_t run) { return slotKeys_[runs_[run].first].path == path; };
    if (latestRun_ != absent && isOf(latestRun_)) return latestRun_;
    const uint64_t h = mix(path);
    latestRun_ = runIndex_.find(h, isOf);
    if (latestRun_ == absent) {
        latestRun_ = static_cast<uint32_t>(runs_.size());
        runs_.push_back({});
        runIndex_.insert(h, latestRun_);
    }
    return latestRun_;
}

/// The slot of the key, or `absent`.
SlotId Graph::findSlot(const SlotRun& run, const SlotKey& key) const {
    for (SlotId id = run.first; id < run.first + run.count; ++id)
        if (slotKeys_[id].attribute == key.attribute) return id;
    if (!run.hasMore) return absent;
    return laterSlots_.find(hashOf(key), [&](SlotId id) { return slotKeys_[id] == key; });
}

NodeRef Graph::slot(float value) { return addSlot({}, value); }

uint32_t Graph::grid(const SampledGridPtr& samples) {
    const auto at = static_cast<uint32_t>(std::find(grids_.begin(), grids_.end(), samples) - grids_.begin());
    if (at == grids_.size()) grids_.push_back(samples);
    return at;
}

NodeRef Graph::addSlot(SlotKey key, float value) {
    constants_.push_back(value);
    slotKeys_.push_back(key);
    slotNodes_.push_back(append(codeOf<ops::Slot>, {}, static_cast<SlotId>(constants_.size() - 1)));
    return {this, slotNodes_.back()};
}

NodeRef Graph::apply(OpCode op, std::span<const Operand> operands, uint32_t data) {
    const OpTraits& row = traits(op);
    assert(row.arity == ops::variadic || operands.size() == static_cast<size_t>(row.arity));
    assert(row.arity != ops::leaf);
    if (row.arity != ops::variadic) {
        const Node& first = nodes_[operands.front().node];
        const Node& last = nodes_[operands.back().node];
        if (isLiteral(first) && isLiteral(last))
            if (const auto value = folded(op, literalOf(first), literalOf(last), operands.size()))
                return literal(*value);
        if (operands.size() == 2 && isLiteral(last) && keepsFirst(op, literalOf(last))) return {this, operands[0].node};
        if (operands.size() == 2 && isLiteral(first) && row.commutative && keepsFirst(op, literalOf(first)))
            return {this, operands[1].node};
    }
    return {this, insert(op, operands, data)};
}

NodeRef Graph::apply(OpCode op, std::initializer_list<NodeRef> operands, uint32_t data) {
    constexpr size_t few = 12;  // all but the longest lists, so that arithmetic and boxes allocate nothing here
    std::array<Operand, few> small;
    std::vector<Operand> large(operands.size() > few ? operands.size() : 0);
    const std::span<Operand> list =
        large.empty() ? std::span<Operand>(small.data(), operands.size()) : std::span<Operand>(large);
    std::transform(operands.begin(), operands.end(), list.begin(), [](const NodeRef& n) { return Operand{n.id(), 0}; });
    if (traits(op).commutative && list.size() == 2 && list[1].node < list[0].node) std::swap(list[0], list[1]);
    return apply(op, list, data);
}

NodeId Graph::insert(OpCode op, std::span<const Operand> operands, uint32_t data) {
    [[maybe_unused]] const bool mayOwn = traits(op).owner != ops::Owner::First;
    for ([[maybe_unused]] const Operand& o : operands) assert(o.node < nodes_.size() && (mayOwn || o.origin == 0));
    NodeId newest = 0;
    for (const Operand& o : operands) newest = std::max(newest, o.node);
    const uint64_t h = operands.empty() ? hashOf(op, data) : hashOf(op, operands, data, newest);
    if (newest <= latestOperand_) {  // else no node has all of these operands
        const NodeId known = nodeIndex_.find(h, [&](NodeId i) {
            const Node& n = nodes_[i];
            const auto seen = this->operands(i);
            return n.op == op && n.data == data &&
                   std::equal(seen.begin(), seen.end(), operands.begin(), operands.end());
        });
        if (known != absent) return known;
    }
    latestOperand_ = std::max(latestOperand_, newest);
    nodeIndex_.insert(h, static_cast<NodeId>(nodes_.size()));
    return append(op, operands, data);
}

NodeId Graph::append(OpCode op, std::span<const Operand> operands, uint32_t data) {
    const size_t first = operands_.size();
    nodes_.push_back({op, data, static_cast<uint32_t>(first), static_cast<uint32_t>(operands.size())});
    operands_.resize(first + operands.size());
    std::copy(operands.begin(), operands.end(), operands_.begin() + static_cast<std::ptrdiff_t>(first));
    return static_cast<NodeId>(nodes_.size() - 1);
}

NodeRef operator+(NodeRef a, NodeRef b) { return binary(codeOf<ops::Add>, a, b); }
NodeRef operator-(NodeRef a, NodeRef b) { return binary(codeOf<ops::Sub>, a, b); }
NodeRef operator*(NodeRef a, NodeRef b) { return a.id() == b.id() ? square(a) : binary(codeOf<ops::Mul>, a, b); }
NodeRef operator/(NodeRef a, NodeRef b) { return binary(codeOf<ops::Div>, a, b); }
NodeRef operator-(NodeRef a) { return unary(codeOf<ops::Neg>, a); }
NodeRef operator+(NodeRef a, float b) { return a + a.graph().literal(b); }
NodeRef operator+(float a, NodeRef b) { return b.graph().literal(a) + b; }
NodeRef operator-(NodeRef a, float b) { return a - a.graph().literal(b); }
NodeRef operator-(float a, NodeRef b) { return b.graph().literal(a) - b; }
NodeRef operator*(NodeRef a, float b) { return a * a.graph().literal(b); }
NodeRef operator*(float a, NodeRef b) { return b.graph().literal(a) * b; }
NodeRef operator/(NodeRef a, float b) { return a / a.graph().literal(b); }
NodeRef operator/(float a, NodeRef b) { return b.graph().literal(a) / b; }
NodeRef min(NodeRef a, NodeRef b) { return binary(codeOf<ops::Min>, a, b); }
NodeRef max(NodeRef a, NodeRef b) { return binary(codeOf<ops::Max>, a, b); }
NodeRef min(NodeRef a, float b) { return min(a, a.graph().literal(b)); }
NodeRef max(NodeRef a, float b) { return max(a, a.graph().literal(b)); }
NodeRef abs(NodeRef a) { return unary(codeOf<ops::Abs>, a); }
NodeRef sqrt(NodeRef a) { return unary(codeOf<ops::Sqrt>, a); }
NodeRef square(NodeRef a) { return unary(codeOf<ops::Square>, a); }
NodeRef floor(NodeRef a) { return unary(codeOf<ops::Floor>, a); }
NodeRef mod(NodeRef a, NodeRef b) { return binary(codeOf<ops::Mod>, a, b); }
NodeRef sin(NodeRef a) { return unary(codeOf<ops::Sin>, a); }
NodeRef cos(NodeRef a) { return unary(codeOf<ops::Cos>, a); }
NodeRef exp(NodeRef a) { return unary(codeOf<ops::Exp>, a); }
NodeRef atan2(NodeRef y, NodeRef x) { return binary(codeOf<ops::Atan2>, y, x); }
NodeRef dot(Point a, Point b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
NodeRef length(Point a) { return sqrt(dot(a, a)); }

}  // namespace sgm::field
