#include "modeler/field/plan_numbers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "modeler/core/conventions.h"

namespace sgm::field {
namespace {

/// By edge: the first of those parallel to it either way, so nearly that its line leaves its edge by at most 10 µm
/// anywhere in the footprint.
std::vector<uint32_t> leadersOf(const std::vector<plan::PlacedEdge>& edges, const std::vector<plan::Vec2>& normals) {
    plan::Box2 box;
    for (const plan::PlacedEdge& e : edges) box.add(e.from);
    const double tolerance = 1e-5 / std::max(length(box.size()), 1e-2);
    std::vector<double> angles;
    angles.reserve(edges.size());
    for (const plan::Vec2 n : normals) {
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

PlanNumbers::PlanNumbers(const plan::Footprint& footprint, const plan::Formula& formula)
    : footprint_(&footprint), formula_(&formula), edges_(plan::edgesOf(footprint)) {
    normals_.reserve(edges_.size());
    for (const plan::PlacedEdge& e : edges_) normals_.push_back(e.normal());
}

std::vector<plan::Linear> PlanNumbers::distances() const {
    std::vector<plan::Linear> all;
    all.reserve(edges_.size());
    for (size_t i = 0; i < edges_.size(); ++i)
        all.push_back({normals_[i].x, normals_[i].z, -dot(normals_[i], edges_[i].from)});
    return all;
}

const std::vector<uint32_t>& PlanNumbers::leaders() const {
    if (leaders_.empty()) leaders_ = leadersOf(edges_, normals_);
    return leaders_;
}

const Bends& PlanNumbers::bends() const {
    if (!bends_) bends_ = bendsOf(*formula_, edges_);
    return *bends_;
}

double PlanNumbers::depth() const {
    if (depth_) return *depth_;
    const std::vector<plan::Linear> leaves = distances();
    const plan::Box2 box = bounds(*footprint_);
    const double width = std::min(box.size().x, box.size().z);
    depth_ = -plan::leastInside(*formula_, leaves, leaves, box, 1e-3 * width);
    return *depth_;
}

}  // namespace sgm::field
