// Blocks: the land that roads enclose, less the roads' own width, water and parks; and the roads as surfaces.
// Enters: a planar graph and the widths of its roads. Leaves: polygons that don't overlap. Assumes that roads are
// longer than wide; a piece of road that crossings at its ends use up has no surface of its own.
#pragma once

#include "modeler/town/faces.h"
#include "modeler/town/grow.h"

namespace sgm::town {

/// A block. Its edges along streets are tagged "street", along highways "street highway", along bridges
/// "bridge" or "bridge highway", along the banks of rivers and lakes "water", along parks "park".
struct Block {
    plan::Footprint land;
    uint64_t key = 0;  ///< of the place: the same whatever is built elsewhere
};

/// What is taken off the faces besides roads.
struct LandCuts {
    std::function<bool(Vec2)> water, park;
    double cell_m = 10;  ///< of the lattice on which their outlines are sought
};

/// The blocks of the face: none where the roads leave less than 1 m².
std::vector<Block> blocksOf(const RoadGraph& graph, const RoadParameters& parameters, const Face& face,
                            const LandCuts& cuts);

/// A straight piece of road, a curve, or a crossing.
struct RoadSurface {
    plan::Footprint area;
    uint32_t edge = noIndex, node = noIndex;  ///< one of them; of a curve its first edge
    Vec2 from, to;                            ///< of an edge: the ends of its middle line, crossings left out
};

/// The surfaces of all roads: a quadrilateral for every edge, a band for every curve, a polygon for every node where
/// three or more meet.
std::vector<RoadSurface> surfacesOf(const RoadGraph& graph, const RoadParameters& parameters);

}  // namespace sgm::town
