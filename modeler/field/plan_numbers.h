// What the field of a footprint is made of before there are nodes, so that solids over one footprint share it.
// Enters: a sound footprint in metres and its monotone formula. Leaves: numbers. Assumes that both outlive it. What
// few ask for is made on demand: for one thread, until it is prepared.
#pragma once

#include <optional>
#include <vector>

#include "modeler/field/bends.h"
#include "modeler/plan/formula.h"

namespace sgm::field {

class PlanNumbers {
public:
    PlanNumbers(const plan::Footprint& footprint, const plan::Formula& formula);

    const plan::Footprint& footprint() const { return *footprint_; }
    const plan::Formula& formula() const { return *formula_; }
    const std::vector<plan::PlacedEdge>& edges() const { return edges_; }
    /// Of edge i, as PlacedEdge::normal.
    plan::Vec2 normal(uint32_t edge) const { return normals_[edge]; }
    /// As plan::distancesOf.
    std::vector<plan::Linear> distances() const;
    /// By edge: the first of those parallel to it either way, itself where none is.
    const std::vector<uint32_t>& leaders() const;
    const Bends& bends() const;
    /// The greatest depth of the footprint, metres: at most a thousandth too much.
    double depth() const;
    /// Makes what is made on demand: then any thread may ask, for the depth where `withDepth`.
    void prepare(bool withDepth) const {
        leaders(), bends();
        if (withDepth) depth();
    }
    /// The depth where it was asked for.
    const std::optional<double>& knownDepth() const { return depth_; }
    /// Sets what `depth` returns, where it is known of an equal footprint and formula.
    void setDepth(double depth_m) { depth_ = depth_m; }

private:
    const plan::Footprint* footprint_;
    const plan::Formula* formula_;
    std::vector<plan::PlacedEdge> edges_;
    std::vector<plan::Vec2> normals_;
    mutable std::vector<uint32_t> leaders_;
    mutable std::optional<Bends> bends_;
    mutable std::optional<double> depth_;
};

}  // namespace sgm::field
