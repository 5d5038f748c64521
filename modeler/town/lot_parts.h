// What the cuts of lots share. For this folder's sources alone.
// Enters: land with tagged edges. Leaves: boxes, sides along streets, lots. Assumes sound footprints.
#pragma once

#include <utility>

#include "modeler/town/lots.h"

namespace sgm::town {

inline constexpr double mostDepth = 2;  // of a lot, in roots of its area

/// Which tags of a block are those of streets.
class StreetTags {
public:
    explicit StreetTags(const plan::Footprint& block);
    bool operator()(const plan::Edge& edge) const { return edge.tag < isStreet_.size() && isStreet_[edge.tag]; }

private:
    std::vector<bool> isStreet_;
};

/// A rectangle around an outline in the direction of one of its edges.
struct OrientedBox {
    plan::Vec2 along{1, 0};  ///< unit, its longer side
    double from = 0, length = 0, width = 0;
};
/// The least box; one in the direction of an edge is the least of all for convex outlines.
OrientedBox leastBox(const plan::Ring& outline);
/// Metres along streets.
double streetOf(const plan::Polygon& land, const StreetTags& isStreet);
/// Metres of the longest side along a street; pieces that bend by less than 20° are one side.
double longestStreet(const plan::Polygon& land, const StreetTags& isStreet);
/// The lot in its own frame; its tags are `tags`.
Lot lotOf(plan::Polygon land, const std::vector<std::string>& tags, const StreetTags& isStreet);

/// Lots of one polygon by its straight skeleton; nothing where it has none.
bool cutBySkeleton(const plan::Footprint& block, const LotParameters& parameters, uint64_t key,
                   const Progress* progress, std::vector<Lot>& out);

}  // namespace sgm::town
