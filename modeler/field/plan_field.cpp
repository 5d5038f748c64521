#include "modeler/field/plan_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "modeler/field/bends.h"
#include "modeler/field/solids.h"

namespace sgm::field {

namespace {

using plan::FormulaNode;

/// How far a mitred corner may stand out, in offsets.
constexpr double mitreLimit = 4;

/// Where the corner between two edges of these normals goes when both move outward by `out`; a reflex one comes nearer,
/// which is left out.
plan::Vec2 movedCorner(plan::Vec2 a, plan::Vec2 b, plan::Vec2 corner, double out) {
    const plan::Vec2 sum = a + b;
    const double square = dot(sum, sum);
    if (square < 1e-12) return corner + a * (out * mitreLimit);
    const plan::Vec2 tip = sum * (2 / square);
    const double reach = std::min(length(tip), mitreLimit);
    return corner + tip * (out * reach / length(tip));
}

}  // namespace

NodeRef pathSlot(Graph& graph, uint64_t path, NumberName attribute, uint64_t index, double value) {
    const auto number = static_cast<float>(value);
    return path == 0 ? graph.slot(number) : graph.slot({path, combine(attribute.hash, index)}, number);
}

Quantity fixed(Graph& graph, double value) { return {graph.literal(static_cast<float>(value)), value}; }

PlanField::PlanField(std::shared_ptr<const PlanNumbers> numbers, Point p, uint64_t path)
    : numbers_(std::move(numbers)), p_(p), path_(path), distances_(edges().size()), alongs_(edges().size()) {
    outside_ = outsideByBends();
}

PlanField::PlanField(std::shared_ptr<const PlanNumbers> numbers, Graph& graph)
    : numbers_(std::move(numbers)),
      p_{graph.literal(0), graph.literal(0), graph.literal(0)},
      distances_(edges().size(), graph.literal(0)),
      outside_(graph.literal(0)),
      hasBoundsOnly_(true) {}

NodeRef PlanField::distance(uint32_t edge) const {
    std::optional<NodeRef>& known = distances_[edge];
    if (known) return *known;
    const auto number = [&](NumberName of, double v) { return pathSlot(graph(), path_, of, edge, v); };
    const plan::Vec2 n = numbers_->normal(edge);
    const double c = dot(n, edges()[edge].from);  // where the normal is an axis: a coordinate
    if (n.x == 1 || n.z == 1)
        known = (n.x == 1 ? p_.x : p_.z) - number("edge c", c);
    else if (n.x == -1 || n.z == -1)
        known = number("edge c", -c) - (n.x == -1 ? p_.x : p_.z);
    else {
        // By its leader's normal, which is its own or the opposite but for rounding.
        const plan::PlacedEdge& e = edges()[edge];
        const uint32_t leader = numbers_->leaders()[edge];
        const plan::Vec2 shared = numbers_->normal(leader);
        const double offset = dot(shared, (e.from + e.to) * 0.5);
        known = dot(shared, n) > 0 ? alongNormal(leader) - number("edge c", offset)
                                   : number("edge c", offset) - alongNormal(leader);
    }
    return *known;
}

/// The position's coordinate along an edge's normal.
NodeRef PlanField::alongNormal(uint32_t edge) const {
    std::optional<NodeRef>& known = alongs_[edge];
    if (known) return *known;
    const plan::Vec2 n = numbers_->normal(edge);
    known = p_.x * pathSlot(graph(), path_, "edge x", edge, n.x) + p_.z * pathSlot(graph(), path_, "edge z", edge, n.z);
    return *known;
}

/// Φ with the edges of bends relative to their bend's plane, and each bend relative to the one around it.
NodeRef PlanField::outsideByBends() const {
    const Bends& bends = numbers_->bends();
    const plan::Formula& formula = this->formula();
    if (bends.planes.empty()) return fold([this](uint32_t edge) { return distance(edge); });
    const auto relative = [&](NumberName of, uint64_t index, PlanPlane plane, uint32_t bend) {
        const PlanPlane base = bend == Bends::none ? PlanPlane{} : bends.planes[bend];
        const auto number = [&](int axis, double v) {
            return pathSlot(graph(), path_, of, index * 3 + static_cast<uint64_t>(axis), v);
        };
        return p_.x * number(0, plane.normal.x - base.normal.x) + p_.z * number(1, plane.normal.z - base.normal.z) -
               number(2, plane.offset - base.offset);
    };
    std::vector<NodeRef> nodes;
    nodes.reserve(formula.nodes.size());
    for (size_t i = 0; i < formula.nodes.size(); ++i) {
        const FormulaNode& node = formula.nodes[i];
        NodeRef value;
        if (node.kind != FormulaNode::Kind::Edge) {
            const NodeRef a = nodes[node.first], b = nodes[node.second];
            value = node.kind == FormulaNode::Kind::Max ? max(a, b) : min(a, b);
        } else if (bends.ofNode[i] == Bends::none) {
            value = distance(node.first);
        } else {
            const plan::Vec2 n = numbers_->normal(node.first);
            value = relative("edge in bend", node.first, {n, dot(n, edges()[node.first].from)}, bends.ofNode[i]);
        }
        if (const uint32_t bend = bends.beginsAt[i]; bend != Bends::none)
            value = value + relative("bend", bend, bends.planes[bend], bends.outer[bend]);
        nodes.push_back(value);
    }
    return nodes.back();
}

NodeRef PlanField::fold(const std::function<NodeRef(uint32_t edge)>& leaf) const {
    std::vector<NodeRef> nodes;
    nodes.reserve(formula().nodes.size());
    for (const FormulaNode& node : formula().nodes)
        nodes.push_back(node.kind == FormulaNode::Kind::Edge  ? leaf(node.first)
                        : node.kind == FormulaNode::Kind::Max ? max(nodes[node.first], nodes[node.second])
                                                              : min(nodes[node.first], nodes[node.second]));
    return nodes.back();
}

plan::Box2 PlanField::boundsOf(double out) const {
    plan::Box2 box;
    const auto around = [&](plan::Vec2 p, double r) {
        box.add({p.x - r, p.z - r});
        box.add({p.x + r, p.z + r});
    };
    for (const plan::PlacedEdge& e : edges()) around(e.from, std::max(out, 0.0));
    if (out <= 0) return box;
    const std::vector<plan::PlacedEdge>& edges = this->edges();
    for (uint32_t i = 0; i < edges.size(); ++i) {
        if (edges[i].ring != 0) continue;
        const auto n = static_cast<uint32_t>(footprint().polygons[edges[i].polygon].outer.size());
        const uint32_t next = edges[i].index + 1 == n ? i + 1 - n : i + 1;
        if (cross(edges[i].to - edges[i].from, edges[next].to - edges[next].from) > 0)
            box.add(movedCorner(numbers_->normal(i), numbers_->normal(next), edges[next].from, out));
    }
    return box;
}

Field PlanField::boxed(NodeRef value, uint64_t path, double bottom, double top, double out) const {
    const plan::Box2 box = boundsOf(out);
    const plan::Vec2 middle = box.centre(), size = box.size();
    // A little apart from the solid's own faces, so that rounding decides nothing where they would coincide.
    const double apart = 1e-3 * std::max({size.x, size.z, top - bottom, 1e-3});
    const Vec3d centre{middle.x, (bottom + top) / 2, middle.z};
    const Vec3d half{size.x / 2 + apart, std::max(top - bottom, 0.0) / 2 + apart, size.z / 2 + apart};
    const Vec3f c = centre.as<float>(), h = half.as<float>();
    if (hasBoundsOnly_) return {value, {c - h, c + h}, 1, solids::growth(1)};
    const auto number = [&](NumberName of, uint64_t axis, double v) { return pathSlot(graph(), path, of, axis, v); };
    const Point middle3{number("box centre", 0, centre.x), number("box centre", 1, centre.y),
                        number("box centre", 2, centre.z)};
    const Point size3{number("box half", 0, half.x), number("box half", 1, half.y), number("box half", 2, half.z)};
    return {max(value, solids::boxDistance(p_, middle3, size3)), {c - h, c + h}, 1, solids::growth(1)};
}

}  // namespace sgm::field
