// How one road tries to go on. For the sources of this folder alone.
// Enters: a graph, and where a road would go. Leaves: the graph with one piece more, or as it was. Assumes that the
// graph and the maps outlive it.
#pragma once

#include "modeler/town/grow.h"

namespace sgm::town {

/// A road that was built.
struct Built {
    uint32_t edge = noIndex, node = noIndex;  ///< the piece and the node at its far end
    bool joined = false;                      ///< it met another road there, and ends
};

class Grower {
public:
    Grower(RoadGraph& graph, const RoadParameters& parameters, const Land& land)
        : graph_(graph), parameters_(parameters), land_(land) {}

    /// Builds a piece from `node` along `heading`, under the local constraints: within the area, out of parks, over
    /// water by a bridge or not at all, no steeper than allowed, joining the first road it crosses or comes near to,
    /// planar.
    std::optional<Built> extend(uint32_t node, Vec2 heading, RoadClass kind, bool mayBridge);
    /// Builds a piece from a dead end straight on to the next road within `reach_m`.
    bool join(uint32_t node, double reach_m);

    double pullAt(Vec2 p) const { return land_.pull ? land_.pull(p) : 1; }
    bool spreadsAt(Vec2 p) const { return !land_.spread || land_.spread(p); }
    bool isWater(Vec2 p) const { return land_.water && land_.water(p); }
    bool isPark(Vec2 p) const { return land_.park && land_.park(p); }
    bool isInside(Vec2 p) const;

private:
    /// What a straight piece runs over.
    struct Survey {
        bool legal = true, water = false;
        double rise_m = 0;                ///< between its ends, either way
        double above_m = 0, below_m = 0;  ///< how far the ground stands above the straight line between them, and below
        double length_m = 0;
    };
    /// Where a piece ends: at a node, in an edge, or on open ground.
    struct Target {
        Point at;
        uint32_t node = noIndex, edge = noIndex;
        bool crossing = false;  ///< the piece would have crossed that edge
    };

    Survey survey(Vec2 from, Vec2 to) const;
    bool tunnels(const Survey& survey) const;
    bool spans(const Survey& survey) const;
    std::optional<Vec2> beyondSlope(Vec2 from, Vec2 heading, double first_m) const;
    std::optional<double> bridgeLength(Vec2 from, Vec2 heading, double first_m) const;
    std::optional<Target> firstCrossing(uint32_t node, Point to) const;
    Target resolve(uint32_t node, Vec2 to) const;
    Target nearestJoin(uint32_t node, Point to) const;
    Target snappedToEnds(Target target) const;
    bool hasAngle(uint32_t node, Vec2 direction) const;
    bool isClear(uint32_t node, const Target& target) const;
    std::optional<Built> build(uint32_t node, const Target& target, RoadClass kind, bool mayBridge);

    RoadGraph& graph_;
    const RoadParameters& parameters_;
    const Land& land_;
};

}  // namespace sgm::town
