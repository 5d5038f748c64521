// A footprint as a field of the plan: every solid over it is a profile of this field and the height.
// Enters: a sound footprint, its monotone formula, coordinates. Leaves: nodes. Assumes that x and z of the coordinates
// are the footprint's, in metres; y is up.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/field/field.h"
#include "modeler/field/plan_numbers.h"

namespace sgm::field {

/// A number of a solid: the node that carries it, and its present value for bounds.
struct Quantity {
    NodeRef node;
    double value = 0;
};
/// A number that never changes, as a literal.
Quantity fixed(Graph& graph, double value);

/// The name of a number, hashed when the program is compiled.
struct NumberName {
    uint64_t hash;
    consteval NumberName(const char* text) : hash(hashText(text)) {}
};
/// The slot keyed by (path, attribute and index), or a fresh one for path 0.
NodeRef pathSlot(Graph& graph, uint64_t path, NumberName attribute, uint64_t index, double value);

/// The distances to the lines of a footprint's edges, and Φ, their formula.
class PlanField {
public:
    /// One half-plane an edge: nx·x + nz·z − c, numbers in slots keyed by (path, "edge i …"), fresh slots for path 0.
    /// Edges along an axis need one number, and parallel edges share what they have in common. `p` must be of the
    /// graph. 5 instructions an edge at most, 2 where most edges are parallel to others.
    PlanField(const plan::Footprint& footprint, const plan::Formula& formula, Point p, uint64_t path)
        : PlanField(std::make_shared<const PlanNumbers>(footprint, formula), p, path) {}
    /// The same of numbers that solids over one footprint share.
    PlanField(std::shared_ptr<const PlanNumbers> numbers, Point p, uint64_t path);
    /// With literals in place of distances and of the position: a solid over it has its bounds, and no field.
    PlanField(std::shared_ptr<const PlanNumbers> numbers, Graph& graph);

    Graph& graph() const { return p_.x.graph(); }
    const Point& position() const { return p_; }
    const PlanNumbers& numbers() const { return *numbers_; }
    const plan::Footprint& footprint() const { return numbers_->footprint(); }
    const plan::Formula& formula() const { return numbers_->formula(); }
    const std::vector<plan::PlacedEdge>& edges() const { return numbers_->edges(); }
    /// Signed distance to the line of edge i, > 0 outside, metres.
    NodeRef distance(uint32_t edge) const;
    /// Φ = −D: < 0 inside, metres; 1-Lipschitz, mitred beyond corners.
    NodeRef outside() const { return outside_; }
    /// The formula over other leaves, one an edge. Φ is fold(distance).
    NodeRef fold(const std::function<NodeRef(uint32_t edge)>& leaf) const;
    /// The rectangle around the outline moved outward by `out` metres: with the tips of mitred corners, up to 4 times
    /// as far out.
    plan::Box2 boundsOf(double out = 0) const;
    /// `value` cut by the box between two heights and around the outline moved by `out`, a little larger than asked
    /// for: its bounds hold, lipschitz is 1 and growth 1. The box's slots are of `path`, the solid's own.
    Field boxed(NodeRef value, uint64_t path, double bottom, double top, double out = 0) const;

private:
    NodeRef outsideByBends() const;
    NodeRef alongNormal(uint32_t edge) const;

    std::shared_ptr<const PlanNumbers> numbers_;
    Point p_;
    uint64_t path_ = 0;
    mutable std::vector<std::optional<NodeRef>> distances_,
        alongs_;  ///< made when asked for; along each leader's normal
    NodeRef outside_;
    bool hasBoundsOnly_ = false;
};

}  // namespace sgm::field
