// A planar graph of roads.
// Enters: nodes and edges, one at a time. Leaves: the graph, and what lies near a place. Assumes that whoever adds an
// edge asked `isFree` before; then no two edges share a point but a common node, decided exactly on the lattice.
#pragma once

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "modeler/town/point.h"

namespace sgm::town {

enum class RoadClass : uint8_t { Highway, Street };

inline constexpr uint32_t noIndex = 0xffffffffu;

/// A crossing, a bend or a dead end.
struct RoadNode {
    Point at;
    std::vector<uint32_t> edges;
};

/// A straight piece of road between two nodes.
struct RoadEdge {
    uint32_t a = noIndex, b = noIndex;
    RoadClass kind = RoadClass::Street;
    bool bridge = false;   ///< over water or a valley
    bool tunnel = false;   ///< under a hill
    bool removed = false;  ///< by `remove`; keeps its number until `compact`
    bool own = false;      ///< of a file: it stays, and so does its end
    uint32_t curve = 0;    ///< of pieces that make one curve: its number from 1
    uint32_t other(uint32_t node) const { return node == a ? b : a; }
};

class RoadGraph {
public:
    std::span<const RoadNode> nodes() const { return nodes_; }
    std::span<const RoadEdge> edges() const { return edges_; }
    const RoadEdge& edge(uint32_t index) const { return edges_[index]; }
    Point at(uint32_t node) const { return nodes_[node].at; }
    Vec2 metresAt(uint32_t node) const { return metres(nodes_[node].at); }
    /// From `node` to the other end of `edge`, metres.
    Vec2 along(uint32_t edge, uint32_t node) const { return metresAt(edges_[edge].other(node)) - metresAt(node); }
    size_t degree(uint32_t node) const { return nodes_[node].edges.size(); }
    bool areJoined(uint32_t a, uint32_t b) const;

    uint32_t addNode(Point at);
    uint32_t addEdge(uint32_t a, uint32_t b, RoadClass kind, bool bridge, bool own = false, uint32_t curve = 0,
                     bool tunnel = false);
    /// Puts a node into an edge, which goes on to it; the rest is a new edge.
    uint32_t splitEdge(uint32_t edge, Point at);
    void remove(uint32_t edge);
    /// Drops removed edges and nodes without edges; what is left is numbered anew, in its order.
    void compact();

    /// Edges whose boxes come within `margin_m` of the box around a and b, each once, in ascending order.
    std::vector<uint32_t> edgesNear(Point a, Point b, double margin_m) const;
    /// Nodes within `margin_m` of the box around a and b, in ascending order.
    std::vector<uint32_t> nodesNear(Point a, Point b, double margin_m) const;
    /// Whether the segment from `a` to `b` shares no point with any edge but those that end at `nodeA` or `nodeB`
    /// (noIndex: a new place), nor with `but`; those may share that node alone.
    bool isFree(Point a, Point b, uint32_t nodeA, uint32_t nodeB, uint32_t but = noIndex) const;

private:
    using Cells = std::unordered_map<uint64_t, std::vector<uint32_t>>;
    template <class Visit>
    static void eachCell(Point a, Point b, int32_t margin_mm, Visit&& visit);
    static std::vector<uint32_t> gather(const Cells& cells, Point a, Point b, double margin_m);
    void enter(uint32_t edge);
    void leave(uint32_t edge);

    std::vector<RoadNode> nodes_;
    std::vector<RoadEdge> edges_;
    Cells nodeCells_, edgeCells_;
};

}  // namespace sgm::town
