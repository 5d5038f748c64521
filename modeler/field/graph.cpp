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

/// Near those of nodes whose newest operand is as old.
uint64_t hashOf(OpCode op, std::span<const Operand> operands, uint32_t data) {
    uint64_t h = mix(static_cast<uint64_t>(op) << 32 | data);
    uint64_t newest = 0;
    for (const Operand& o : operands) {
        h = combine(h, static_cast<uint64_t>(o.origin) << 32 | o.node);
        newest = std::max<uint64_t>(newest, o.node);
    }
    return operands.empty() ? h : 2 * newest + (h & 31);
}

/// Near those of the other numbers of its shape.
uint64_t hashOf(const SlotKey& key) { return (mix(key.path) & ~uint64_t{31}) | (key.attribute & 31); }

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

NodeRef Graph::x() { return {this, insert(codeOf<ops::Input>, {}, 0)}; }
NodeRef Graph::y() { return {this, insert(codeOf<ops::Input>, {}, 1)}; }
NodeRef Graph::z() { return {this, insert(codeOf<ops::Input>, {}, 2)}; }

NodeRef Graph::literal(float value) { return {this, insert(codeOf<ops::Literal>, {}, std::bit_cast<uint32_t>(value))}; }

NodeRef Graph::slot(SlotKey key, float value) {
    const uint64_t h = hashOf(key);
    const SlotId known = slotIndex_.find(h, [&](SlotId id) { return slotKeys_[id] == key; });
    if (known == HashIndex::none) {
        slotIndex_.insert(h, static_cast<SlotId>(constants_.size()));
        return addSlot(key, value);
    }
    constants_[known] = value;
    return {this, slotNodes_[known]};
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
    if (row.commutative && operands.size() == 2 && operands[1].node < operands[0].node) {
        const Operand ordered[] = {operands[1], operands[0]};
        return {this, insert(op, ordered, data)};
    }
    return {this, insert(op, operands, data)};
}

NodeRef Graph::apply(OpCode op, std::initializer_list<NodeRef> operands, uint32_t data) {
    constexpr size_t few = 4;  // all but the longest lists, so that arithmetic allocates nothing here
    std::array<Operand, few> small;
    std::vector<Operand> large(operands.size() > few ? operands.size() : 0);
    const std::span<Operand> list =
        large.empty() ? std::span<Operand>(small.data(), operands.size()) : std::span<Operand>(large);
    std::transform(operands.begin(), operands.end(), list.begin(), [](const NodeRef& n) { return Operand{n.id(), 0}; });
    return apply(op, list, data);
}

NodeId Graph::insert(OpCode op, std::span<const Operand> operands, uint32_t data) {
    [[maybe_unused]] const bool mayOwn = traits(op).owner != ops::Owner::First;
    for ([[maybe_unused]] const Operand& o : operands) assert(o.node < nodes_.size() && (mayOwn || o.origin == 0));
    const uint64_t h = hashOf(op, operands, data);
    const NodeId known = nodeIndex_.find(h, [&](NodeId i) {
        const Node& n = nodes_[i];
        const auto seen = this->operands(i);
        return n.op == op && n.data == data && std::equal(seen.begin(), seen.end(), operands.begin(), operands.end());
    });
    if (known != HashIndex::none) return known;
    nodeIndex_.insert(h, static_cast<NodeId>(nodes_.size()));
    return append(op, operands, data);
}

NodeId Graph::append(OpCode op, std::span<const Operand> operands, uint32_t data) {
    nodes_.push_back({op, data, static_cast<uint32_t>(operands_.size()), static_cast<uint32_t>(operands.size())});
    operands_.insert(operands_.end(), operands.begin(), operands.end());
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
