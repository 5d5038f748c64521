// The faces of a planar road graph.
// Enters: a graph. Leaves: what its roads enclose. Assumes that edges meet at common nodes alone.
#pragma once

#include "modeler/town/road_graph.h"

namespace sgm::town {

/// A directed edge: 2·edge from a to b, 2·edge + 1 back.
using HalfEdge = uint32_t;
inline uint32_t edgeOf(HalfEdge h) { return h / 2; }
inline uint32_t beginOf(const RoadGraph& graph, HalfEdge h) {
    return h % 2 ? graph.edge(h / 2).b : graph.edge(h / 2).a;
}

/// Land between roads. Loops run with the face on their left in the plan (x right, z up the page).
struct Face {
    std::vector<HalfEdge> outline;             ///< counter-clockwise, no node twice
    std::vector<std::vector<HalfEdge>> holes;  ///< clockwise; may touch the outline or each other at a node
    std::vector<uint32_t> spurs;               ///< edges with this face on both sides
};

/// Edges of every node in counter-clockwise order, decided exactly.
std::vector<std::vector<uint32_t>> edgesAround(const RoadGraph& graph);

/// All bounded faces, in the order of their first half-edge. The walk of a component that lies inside a face of another
/// is left out: graphs that grow from one place have one component. O(n log n).
std::vector<Face> facesOf(const RoadGraph& graph);

}  // namespace sgm::town
