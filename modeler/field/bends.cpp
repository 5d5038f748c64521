#include "modeler/field/bends.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/conventions.h"

namespace sgm::field {

namespace {

constexpr uint32_t fewestEdges = 8;
constexpr double widest = radians(24), narrowing = 0.25;

/// Directions from lo to hi, radians; hi − lo ≥ 2π where nothing is known.
struct Sector {
    double lo = 0, hi = 0;
    double width() const { return hi - lo; }
};

/// Around both, the shorter way.
Sector joined(Sector a, Sector b) {
    const double shift = 2 * pi * std::round((a.lo + a.hi - b.lo - b.hi) / 2 / (2 * pi));
    return {std::min(a.lo, b.lo + shift), std::max(a.hi, b.hi + shift)};
}

/// What is known of a node's leaves.
struct Leaves {
    uint32_t count = 0;
    Sector sector;
    double offsets = 0;  ///< their sum
};

}  // namespace

Bends bendsOf(const plan::Formula& formula, std::span<const plan::PlacedEdge> edges) {
    const size_t n = formula.nodes.size();
    std::vector<Leaves> leaves(n);
    for (size_t i = 0; i < n; ++i) {
        const plan::FormulaNode& node = formula.nodes[i];
        if (node.kind == plan::FormulaNode::Kind::Edge) {
            const plan::Vec2 normal = edges[node.first].normal();
            const double angle = std::atan2(normal.z, normal.x);
            leaves[i] = {1, {angle, angle}, dot(normal, edges[node.first].from)};
        } else {
            const Leaves &a = leaves[node.first], &b = leaves[node.second];
            leaves[i] = {a.count + b.count, joined(a.sector, b.sector), a.offsets + b.offsets};
        }
    }
    Bends bends;
    bends.ofNode.assign(n, Bends::none);
    bends.beginsAt.assign(n, Bends::none);
    std::vector<double> limits;  // by bend
    const auto visit = [&](size_t node, uint32_t around) {
        bends.ofNode[node] = around;
        const Leaves& own = leaves[node];
        if (own.count < fewestEdges || own.sector.width() > (around == Bends::none ? widest : limits[around])) return;
        const double angle = (own.sector.lo + own.sector.hi) / 2;
        bends.beginsAt[node] = bends.ofNode[node] = static_cast<uint32_t>(bends.planes.size());
        bends.planes.push_back({{std::cos(angle), std::sin(angle)}, own.offsets / own.count});
        bends.outer.push_back(around);
        limits.push_back(own.sector.width() * narrowing);
    };
    if (n > 0) visit(n - 1, Bends::none);
    for (size_t i = n; i-- > 0;) {
        const plan::FormulaNode& node = formula.nodes[i];
        if (node.kind == plan::FormulaNode::Kind::Edge) continue;
        visit(node.first, bends.ofNode[i]);
        visit(node.second, bends.ofNode[i]);
    }
    return bends;
}

}  // namespace sgm::field
