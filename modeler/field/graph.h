// The hash-consed expression graph that every field is a node of.
// Enters: arithmetic on `NodeRef` handles. Leaves: node ids, equal for equal structure. Assumes one thread builds it.
// Every number a user can change is a slot, so that structure (and with it a shader) survives a change of numbers;
// hash-consing never merges two slots. After building, a Graph is only read.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "modeler/core/pages.h"
#include "modeler/core/provenance.h"
#include "modeler/field/node_index.h"
#include "modeler/field/sampled_grid.h"
#include "modeler/field/slot_table.h"

namespace sgm::field {

/// One node. Leaves have no operands: Input (`data` 0, 1, 2 = x, y, z), Literal (`data` = float bits),
/// Slot (`data` = SlotId). Other ops may keep a structural integer in `data` (the passes of a KIFS, the
/// number of a grid).
struct Node {
    OpCode op;
    uint32_t data = 0;
    uint32_t first = 0;  ///< first operand in Graph::operands()
    uint32_t count = 0;  ///< number of operands
};

/// What one operand of a min, max, blend or morph belongs to; 0 lets the operand's own origins through.
struct Operand {
    NodeId node = 0;
    OriginId origin = 0;
    friend bool operator==(const Operand&, const Operand&) = default;
};

class Graph;

/// A handle to a node of a graph; arithmetic on it adds nodes. A plain value, valid while its graph lives.
class NodeRef {
public:
    NodeRef() = default;
    NodeRef(Graph* graph, NodeId id) : graph_(graph), id_(id) {}
    Graph& graph() const { return *graph_; }
    NodeId id() const { return id_; }

private:
    Graph* graph_ = nullptr;
    NodeId id_ = 0;
};

/// Three coordinates (or any three numbers) of one graph.
struct Point {
    NodeRef x, y, z;
};

class Graph {
public:
    Graph();
    Graph(Graph&&) = default;
    Graph& operator=(Graph&&) = default;

    /// Makes room for so many more boxes that stand each in a place of its own, and for solids over plans with so many
    /// edges in all, as a rule: arrays that grow are copied, and their new memory has to be cleared.
    void reserve(size_t boxes, size_t planEdges);
    /// What has been reserved and not used yet, for `clearAhead`; valid until another node or slot is added.
    std::vector<UnusedMemory> unusedMemory() const;

    NodeRef x() { return input(0); }
    NodeRef y() { return input(1); }
    NodeRef z() { return input(2); }
    Point position() { return {x(), y(), z()}; }
    /// A number that is part of the structure (a formula's 0.5): equal literals are one node.
    NodeRef literal(float value);
    /// A number that may change without changing structure. A key seen before keeps its slot and takes the new value.
    NodeRef slot(SlotKey key, float value);
    /// Says that no slot has a key of this path so far, which spares looking for it.
    void beginPath(uint64_t path) { slots_.beginPath(path); }
    /// Slots of one path by attribute, as `slot` gives them one after the other.
    template <size_t count>
    std::array<NodeRef, count> slots(uint64_t path, const std::array<uint64_t, count>& attributes,
                                     const std::array<float, count>& values) {
        std::array<NodeRef, count> made;
        addSlots(path, attributes, values, made);
        return made;
    }
    /// A slot nobody else names; for numbers without a path.
    NodeRef slot(float value);
    /// A node of the op table; equal structure is shared. Operands with origins, which only min, max, blend and morph
    /// may have, keep their order, for the first of equal ones owns the surface; commutative ones of a list are
    /// ordered.
    NodeRef apply(OpCode op, std::span<const Operand> operands, uint32_t data = 0);
    NodeRef apply(OpCode op, std::initializer_list<NodeRef> operands, uint32_t data = 0);

    /// The number of a grid in this graph: the `data` of ops that read one. The same grid keeps its number.
    uint32_t grid(const SampledGridPtr& samples);

    const Node& node(NodeId id) const { return nodes_[id]; }
    std::span<const Operand> operands(NodeId id) const {
        return {operands_.data() + nodes_[id].first, nodes_[id].count};
    }
    size_t nodeCount() const { return nodes_.size(); }
    /// Present values of all slots, by SlotId: what `compile` binds and the GPU gets as a buffer.
    std::span<const float> constants() const { return slots_.values(); }
    /// By number.
    const std::vector<SampledGridPtr>& grids() const { return grids_; }
    /// Key of each slot, by SlotId.
    std::span<const SlotKey> slotKeys() const { return slots_.keys(); }

    /// Makes place for so many boxes, each with slots of its own, which hold anything until `setBox`. No slot has a key
    /// of their paths so far. The first one's node; the others follow boxNodes apart.
    NodeId addBoxes(size_t count);
    /// The box of a scope: its centre and half-size along x, y and z become slots by `boxAttributes`.
    struct Box {
        uint64_t path;
        std::array<float, 6> numbers;
    };
    /// Makes a box of a row that `addBoxes` made place for, from any thread.
    void setBox(NodeId first, size_t index, const Point& p, const Box& box);
    static constexpr uint32_t boxNodes = 7;
    static const std::array<uint64_t, 6> boxAttributes;  ///< "centre.x" … "size.z"

private:
    static constexpr uint32_t absent = HashIndex::none;

    NodeRef input(uint32_t axis);
    NodeId insert(OpCode op, std::span<const Operand> operands, uint32_t data);
    NodeId find(OpCode op, std::span<const Operand> operands, uint32_t data, NodeId newest);
    NodeId append(OpCode op, std::span<const Operand> operands, uint32_t data);
    void addSlots(uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                  std::span<NodeRef> slots);

    PageVector<Node> nodes_;
    PageVector<Operand> operands_;
    SlotTable slots_;
    std::vector<SampledGridPtr> grids_;
    NodeIndex index_;
    std::array<NodeId, 3> inputs_{absent, absent, absent};
    NodeId latestLiteral_ = absent;
};

NodeRef operator+(NodeRef a, NodeRef b);
NodeRef operator-(NodeRef a, NodeRef b);
NodeRef operator*(NodeRef a, NodeRef b);
NodeRef operator/(NodeRef a, NodeRef b);
NodeRef operator-(NodeRef a);
NodeRef operator+(NodeRef a, float b);
NodeRef operator+(float a, NodeRef b);
NodeRef operator-(NodeRef a, float b);
NodeRef operator-(float a, NodeRef b);
NodeRef operator*(NodeRef a, float b);
NodeRef operator*(float a, NodeRef b);
NodeRef operator/(NodeRef a, float b);
NodeRef operator/(float a, NodeRef b);
NodeRef min(NodeRef a, NodeRef b);
NodeRef max(NodeRef a, NodeRef b);
NodeRef min(NodeRef a, float b);
NodeRef max(NodeRef a, float b);
NodeRef abs(NodeRef a);
NodeRef sqrt(NodeRef a);
NodeRef square(NodeRef a);
NodeRef floor(NodeRef a);
/// Floor-modulo a − b·floor(a/b), in [0, b) for b > 0.
NodeRef mod(NodeRef a, NodeRef b);
NodeRef sin(NodeRef a);
NodeRef cos(NodeRef a);
NodeRef exp(NodeRef a);
/// Angle of (x, y) in (−π, π].
NodeRef atan2(NodeRef y, NodeRef x);

inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
NodeRef dot(Point a, Point b);
NodeRef length(Point a);

}  // namespace sgm::field
