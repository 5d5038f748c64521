#include "modeler/field/section.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "modeler/field/ops.h"

namespace sgm::field {
namespace {

/// The same values, but a place inside belongs to the part it is of: walls of cuts to their hosts.
class Interior {
public:
    explicit Interior(Graph& graph) : graph_(graph) {}

    NodeRef of(NodeId root) {
        const size_t count = size_t{root} + 1;
        std::vector<bool> reached(count, false);
        reached[root] = true;
        for (NodeId id = root + 1; id-- > 0;)
            if (reached[id])
                for (const Operand& o : graph_.operands(id)) reached[o.node] = true;
        copies_.assign(count, 0);
        owned_.assign(count, false);
        for (NodeId id = 0; id < count; ++id)
            if (reached[id]) copy(id);
        return {&graph_, copies_[root]};
    }

    /// `value`, but owned by whoever owns `host`: 0 · host has its owners, and squared none of its creases.
    NodeRef ownedLike(NodeRef host, NodeRef value) {
        const NodeRef nothing =
            graph_.apply(codeOf<ops::Square>, {graph_.apply(codeOf<ops::Mul>, {host, graph_.literal(0)})});
        return graph_.apply(codeOf<ops::Sub>, {nothing, negative(value)});
    }

private:
    bool isOwned(const Operand& o) const { return o.origin != 0 || owned_[o.node]; }
    bool is(NodeId id, OpCode op) const { return graph_.node(id).op == op; }
    NodeRef negative(NodeRef value) {
        return is(value.id(), codeOf<ops::Neg>) ? NodeRef(&graph_, graph_.operands(value.id())[0].node) : -value;
    }
    /// The operand with its owner; min(f, f) gives one a place.
    NodeRef ref(const Operand& o) {
        if (o.origin == 0) return {&graph_, o.node};
        const Operand twice[] = {o, o};
        return graph_.apply(codeOf<ops::Min>, twice);
    }

    void copy(NodeId id) {
        const Node node = graph_.node(id);
        const auto span = graph_.operands(id);
        std::vector<Operand> operands(span.begin(), span.end());
        bool changed = false;
        for (const Operand& o : operands) owned_[id] = owned_[id] || isOwned(o);
        const bool cuts = is(id, codeOf<ops::Max>) && isOwned(operands[0]) && isOwned(operands[1]);
        // A rounded cut is −blend(radius, −host, cuts …).
        const bool rounds = is(id, codeOf<ops::Blend>) && operands.size() > 2 && is(operands[1].node, codeOf<ops::Neg>);
        for (Operand& o : operands) {
            changed = changed || copies_[o.node] != o.node;
            o.node = copies_[o.node];
        }
        if (owned_[id] && (cuts || rounds)) {
            const size_t host = rounds ? 1 : 0;
            const NodeRef owner = ref(operands[host]);
            for (size_t k = host + 1; k < operands.size(); ++k)
                operands[k] = {ownedLike(owner, {&graph_, operands[k].node}).id(), 0};
            operands[host] = {owner.id(), 0};
            changed = true;
        }
        copies_[id] = changed ? graph_.apply(node.op, operands, node.data).id() : id;
    }

    Graph& graph_;
    std::vector<NodeId> copies_;
    std::vector<bool> owned_;
};

}  // namespace

Field section(Graph& graph, const Field& field, Vec3d normal, double offset_m) {
    const auto n = normal.as<float>();
    Interior interior(graph);
    const NodeRef inside = interior.of(field.value.id());
    const Point p = graph.position();
    const NodeRef along[] = {p.x, p.y, p.z};
    NodeRef beyond = graph.literal(static_cast<float>(-offset_m));
    for (int axis = 0; axis < 3; ++axis)
        if (n[axis] != 0) beyond = along[axis] * n[axis] + beyond;
    const NodeRef plane = interior.ownedLike(inside, beyond);
    Box3f bounds = field.bounds;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) < 1 - 1e-9) continue;
        const auto at = static_cast<float>(offset_m * normal[axis]);
        if (normal[axis] > 0)
            bounds.hi[axis] = std::min(bounds.hi[axis], at);
        else
            bounds.lo[axis] = std::max(bounds.lo[axis], at);
        if (bounds.lo[axis] >= bounds.hi[axis]) return {max(field.value, plane), {}, field.lipschitz, 0};
    }
    // An intersection grows away from its bounds by less than either (see field::intersection).
    return {max(field.value, plane), bounds, std::max(field.lipschitz, 1.0f), field.growth * 0.70710f};
}

}  // namespace sgm::field
