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

/// Where the corner between two edges goes when both move outward by `out`; a reflex one comes nearer, which is left
/// out.
plan::Vec2 movedCorner(const plan::PlacedEdge& before, const plan::PlacedEdge& after, double out) {
    const plan::Vec2 a = before.normal(), b = after.normal(), sum = a + b;
    const double square = dot(sum, sum);
    if (square < 1e-12) return after.from + a * (out * mitreLimit);
    const plan::Vec2 tip = sum * (2 / square);
    const double reach = std::min(length(tip), mitreLimit);
    return after.from + tip * (out * reach / length(tip));
}

/// By edge: the first of those parallel to it either way, so nearly that its line leaves its edge by no more than 10 µm
/// anywhere in the footprint.
std::vector<uint32_t> leadersOf(const std::vector<plan::PlacedEdge>& edges) {
    plan::Box2 box;
    for (const plan::PlacedEdge& e : edges) box.add(e.from);
    const double tolerance = 1e-5 / std::max(length(box.size()), 1e-2);
    std::vector<double> angles;
    for (const plan::PlacedEdge& e : edges) {
        const plan::Vec2 n = e.normal();
        double angle = std::atan2(n.z, n.x);
        if (angle < 0) angle += pi;
        angles.push_back(angle > pi - tolerance ? angle - pi : angle);
    }
    std::vector<uint32_t> order(edges.size()), leaders(edges.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return std::pair(angles[a], a) < std::pair(angles[b], b); });
    for (size_t begin = 0, end; begin < order.size(); begin = end) {
        uint32_t leader = order[begin];
        for (end = begin; end < order.size() && angles[order[end]] <= angles[order[begin]] + tolerance; ++end)
            leader = std::min(leader, order[end]);
        for (size_t i = begin; i < end; ++i) leaders[order[i]] = leader;
    }
    return leaders;
}

}  // namespace

NodeRef pathSlot(Graph& graph, uint64_t path, std::string_view attribute, uint64_t index, double value) {
    const auto number = static_cast<float>(value);
    return path == 0 ? graph.slot(number) : graph.slot({path, combine(hashText(attribute), index)}, number);
}

Quantity fixed(Graph& graph, double value) { return {graph.literal(static_cast<float>(value)), value}; }

PlanField::PlanField(const plan::Footprint& footprint, const plan::Formula& formula, Point p, uint64_t path)
    : footprint_(&footprint),
      formula_(&formula),
      p_(p),
      edges_(plan::edgesOf(footprint)),
      path_(path),
      leaders_(leadersOf(edges_)),
      distances_(edges_.size()),
      alongs_(edges_.size()) {
    outside_ = outsideByBends();
}

NodeRef PlanField::distance(uint32_t edge) const {
    std::optional<NodeRef>& known = distances_[edge];
    if (known) return *known;
    const auto number = [&](std::string_view of, double v) { return pathSlot(graph(), path_, of, edge, v); };
    const plan::Vec2 n = edges_[edge].normal();
    const double c = dot(n, edges_[edge].from);  // where the normal is an axis: a coordinate
    if (n.x == 1 || n.z == 1)
        known = (n.x == 1 ? p_.x : p_.z) - number("edge c", c);
    else if (n.x == -1 || n.z == -1)
        known = number("edge c", -c) - (n.x == -1 ? p_.x : p_.z);
    else {
        // By its leader's normal, which is its own or the opposite but for rounding.
        const plan::PlacedEdge& e = edges_[edge];
        const plan::Vec2 shared = edges_[leaders_[edge]].normal();
        const double offset = dot(shared, (e.from + e.to) * 0.5);
        known = dot(shared, n) > 0 ? alongNormal(leaders_[edge]) - number("edge c", offset)
                                   : number("edge c", offset) - alongNormal(leaders_[edge]);
    }
    return *known;
}

/// The position's coordinate along an edge's normal.
NodeRef PlanField::alongNormal(uint32_t edge) const {
    std::optional<NodeRef>& known = alongs_[edge];
    if (known) return *known;
    const plan::Vec2 n = edges_[edge].normal();
    known = p_.x * pathSlot(graph(), path_, "edge x", edge, n.x) + p_.z * pathSlot(graph(), path_, "edge z", edge, n.z);
    return *known;
}

/// Φ with the edges of bends relative to their bend's plane, and each bend relative to the one around it.
NodeRef PlanField::outsideByBends() const {
    const Bends bends = bendsOf(*formula_, edges_);
    if (bends.planes.empty()) return fold([this](uint32_t edge) { return distance(edge); });
    const auto relative = [&](std::string_view of, uint64_t index, PlanPlane plane, uint32_t bend) {
        const PlanPlane base = bend == Bends::none ? PlanPlane{} : bends.planes[bend];
        const auto number = [&](int axis, double v) {
            return pathSlot(graph(), path_, of, index * 3 + static_cast<uint64_t>(axis), v);
        };
        return p_.x * number(0, plane.normal.x - base.normal.x) + p_.z * number(1, plane.normal.z - base.normal.z) -
               number(2, plane.offset - base.offset);
    };
    std::vector<NodeRef> nodes;
    nodes.reserve(formula_->nodes.size());
    for (size_t i = 0; i < formula_->nodes.size(); ++i) {
        const FormulaNode& node = formula_->nodes[i];
        NodeRef value;
        if (node.kind != FormulaNode::Kind::Edge) {
            const NodeRef a = nodes[node.first], b = nodes[node.second];
            value = node.kind == FormulaNode::Kind::Max ? max(a, b) : min(a, b);
        } else if (bends.ofNode[i] == Bends::none) {
            value = distance(node.first);
        } else {
            const plan::PlacedEdge& e = edges_[node.first];
            value = relative("edge in bend", node.first, {e.normal(), dot(e.normal(), e.from)}, bends.ofNode[i]);
        }
        if (const uint32_t bend = bends.beginsAt[i]; bend != Bends::none)
            value = value + relative("bend", bend, bends.planes[bend], bends.outer[bend]);
        nodes.push_back(value);
    }
    return nodes.back();
}

NodeRef PlanField::fold(const std::function<NodeRef(uint32_t edge)>& leaf) const {
    std::vector<NodeRef> nodes;
    nodes.reserve(formula_->nodes.size());
    for (const FormulaNode& node : formula_->nodes)
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
    for (const plan::PlacedEdge& e : edges_) around(e.from, std::max(out, 0.0));
    if (out <= 0) return box;
    for (size_t i = 0; i < edges_.size(); ++i) {
        if (edges_[i].ring != 0) continue;
        const plan::Polygon& polygon = footprint_->polygons[edges_[i].polygon];
        const size_t n = polygon.outer.size(), next = edges_[i].index + 1 == n ? i + 1 - n : i + 1;
        if (cross(edges_[i].to - edges_[i].from, edges_[next].to - edges_[next].from) > 0)
            box.add(movedCorner(edges_[i], edges_[next], out));
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
    const auto number = [&](std::string_view of, uint64_t axis, double v) {
        return pathSlot(graph(), path, of, axis, v);
    };
    const Point p{p_.x - number("box centre", 0, centre.x), p_.y - number("box centre", 1, centre.y),
                  p_.z - number("box centre", 2, centre.z)};
    const Point size3{number("box half", 0, half.x), number("box half", 1, half.y), number("box half", 2, half.z)};
    return {max(value, solids::boxDistance(p, size3)), {c - h, c + h}, 1, solids::growth(1)};
}

}  // namespace sgm::field
