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

/// What tells apart of which nodes the newest operands are compared: their own op and that of the operand.
OpCode kindOf(OpCode op, OpCode newest) {
    return static_cast<OpCode>(static_cast<uint32_t>(op) + static_cast<uint32_t>(newest) * 12);
}

NodeId newestOf(std::span<const Operand> operands) {
    NodeId newest = 0;
    for (const Operand& o : operands) newest = std::max(newest, o.node);
    return newest;
}

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

void Graph::reserve(size_t boxes, size_t planEdges) {
    // A box is its slots and a node, and the minimum that joins it.
    constexpr size_t slots = 6, operands = slots + 3;
    // An edge of a wall or a roof takes 10 nodes, of which 6 have operands, 12.3 operands and 4 slots.
    constexpr size_t nodesOfEdge = 12, operandsOfEdge = 15, slotsOfEdge = 5;
    nodes_.reserve(nodes_.size() + boxes * (boxNodes + 1) + planEdges * nodesOfEdge);
    operands_.reserve(operands_.size() + boxes * (operands + 2) + planEdges * operandsOfEdge);
    slots_.reserve(boxes * slots + planEdges * slotsOfEdge, boxes);
}

std::vector<UnusedMemory> Graph::unusedMemory() const {
    const auto ofSlots = slots_.unusedMemory();
    std::vector<UnusedMemory> all(ofSlots.begin(), ofSlots.end());
    all.push_back(unusedOf(nodes_)), all.push_back(unusedOf(operands_));
    return all;
}

NodeRef Graph::input(uint32_t axis) {
    if (inputs_[axis] == absent) inputs_[axis] = append(codeOf<ops::Input>, {}, axis);
    return {this, inputs_[axis]};
}

NodeRef Graph::literal(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    if (latestLiteral_ != absent && nodes_[latestLiteral_].data == bits) return {this, latestLiteral_};
    const uint64_t h = hashOf(codeOf<ops::Literal>, bits);
    latestLiteral_ = index_.findLeaf(h, [&](NodeId i) { return isLiteral(nodes_[i]) && nodes_[i].data == bits; });
    if (latestLiteral_ == absent) {
        latestLiteral_ = append(codeOf<ops::Literal>, {}, bits);
        index_.insert(h, latestLiteral_);
    }
    return {this, latestLiteral_};
}

NodeRef Graph::slot(SlotKey key, float value) {
    if (const SlotId known = slots_.find(key); known != absent) {
        slots_.setValue(known, value);
        return {this, slots_.nodeOf(known)};
    }
    const auto node = static_cast<NodeId>(nodes_.size());
    append(codeOf<ops::Slot>, {}, slots_.add(key, value, node));
    return {this, node};
}

NodeRef Graph::slot(float value) {
    const auto node = static_cast<NodeId>(nodes_.size());
    append(codeOf<ops::Slot>, {}, slots_.add(value, node));
    return {this, node};
}

void Graph::addSlots(uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                     std::span<NodeRef> slots) {
    const auto node = static_cast<NodeId>(nodes_.size());
    const auto first = slots_.addRow(path, attributes, values, node);
    for (uint32_t i = 0; i < attributes.size(); ++i) {
        slots[i] = first ? NodeRef(this, node + i) : slot({path, attributes[i]}, values[i]);
        if (first) append(codeOf<ops::Slot>, {}, *first + i);
    }
}

uint32_t Graph::grid(const SampledGridPtr& samples) {
    const auto at = static_cast<uint32_t>(std::find(grids_.begin(), grids_.end(), samples) - grids_.begin());
    if (at == grids_.size()) grids_.push_back(samples);
    return at;
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
    const NodeId newest = newestOf(operands);
    if (const NodeId known = find(op, operands, data, newest); known != absent) return known;
    index_.note(newest, kindOf(op, nodes_[newest].op));
    return append(op, operands, data);
}

NodeId Graph::find(OpCode op, std::span<const Operand> operands, uint32_t data, NodeId newest) {
    const auto enter = [this](NodeId id) {
        const auto list = this->operands(id);
        if (!list.empty()) index_.insert(hashOf(nodes_[id].op, list, nodes_[id].data, newestOf(list)), id);
    };
    const auto isSame = [&](NodeId i) {
        const Node& n = nodes_[i];
        const auto seen = this->operands(i);
        return n.op == op && n.data == data && std::equal(seen.begin(), seen.end(), operands.begin(), operands.end());
    };
    return index_.find(newest, kindOf(op, nodes_[newest].op), hashOf(op, operands, data, newest),
                       static_cast<NodeId>(nodes_.size()), enter, isSame);
}

NodeId Graph::append(OpCode op, std::span<const Operand> operands, uint32_t data) {
    const size_t first = operands_.size();
    nodes_.push_back({op, data, static_cast<uint32_t>(first), static_cast<uint32_t>(operands.size())});
    operands_.resize(first + operands.size());
    std::copy(operands.begin(), operands.end(), operands_.begin() + static_cast<std::ptrdiff_t>(first));
    return static_cast<NodeId>(nodes_.size() - 1);
}

constinit const std::array<uint64_t, 6> Graph::boxAttributes{hashText("centre.x"), hashText("centre.y"),
                                                             hashText("centre.z"), hashText("size.x"),
                                                             hashText("size.y"),   hashText("size.z")};

NodeId Graph::addBoxes(size_t count) {
    constexpr uint32_t slots = boxAttributes.size(), listed = slots + 3;
    const size_t first = nodes_.size(), operand = operands_.size();
    const SlotId slot = slots_.addRows(count, slots);
    nodes_.resize(first + count * boxNodes);
    operands_.resize(operand + count * listed);
    if (count == 0) return static_cast<NodeId>(first);
    // Where the first one's slots and operands lie tells where those of all others do.
    nodes_[first] = {codeOf<ops::Slot>, slot, static_cast<uint32_t>(operand), 0};
    const OpCode kind = kindOf(codeOf<ops::Box>, codeOf<ops::Slot>);
    for (size_t i = 0; i < count; ++i) index_.note(static_cast<NodeId>(first + i * boxNodes + slots - 1), kind);
    return static_cast<NodeId>(first);
}

void Graph::setBox(NodeId first, size_t index, const Point& p, const Box& box) {
    constexpr uint32_t slots = boxAttributes.size(), listed = slots + 3;
    const auto at = static_cast<uint32_t>(index);
    const NodeId node = first + at * boxNodes;
    const SlotId slot = nodes_[first].data + at * slots;
    const uint32_t operand = nodes_[first].first + at * listed;
    slots_.setRow(slot, box.path, boxAttributes, box.numbers, node);
    for (uint32_t i = at == 0 ? 1 : 0; i < slots; ++i) nodes_[node + i] = {codeOf<ops::Slot>, slot + i, operand, 0};
    nodes_[node + slots] = {codeOf<ops::Box>, 0, operand, listed};
    Operand* const list = operands_.data() + operand;
    list[0] = {p.x.id(), 0}, list[1] = {p.y.id(), 0}, list[2] = {p.z.id(), 0};
    for (uint32_t i = 0; i < slots; ++i) list[3 + i] = {node + i, 0};
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
