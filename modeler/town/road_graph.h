// A planar graph of roads.
// Enters: nodes and edges, one at a time. Leaves: the graph, and what lies near a place. Assumes that whoever adds an
// edge asked `isFree` before; then no two edges share a point but a common node, decided exactly on the lattice.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "modeler/town/point.h"
#include "modeler/town/road_parameters.h"

namespace sgm::town {

inline constexpr uint32_t noIndex = 0xffffffffu;

/// Numbers of edges or nodes near a place, for the most part so few that nothing is allocated.
using Nearby = boost::container::small_vector<uint32_t, 24>;

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
    Nearby edgesNear(Point a, Point b, double margin_m) const;
    /// Nodes within `margin_m` of the box around a and b, in ascending order.
    Nearby nodesNear(Point a, Point b, double margin_m) const;
    /// Whether the segment from `a` to `b` shares no point with any edge but those that end at `nodeA` or `nodeB`
    /// (noIndex: a new place), nor with `but`; those may share that node alone.
    bool isFree(Point a, Point b, uint32_t nodeA, uint32_t nodeB, uint32_t but = noIndex) const;

private:
    /// An axis-aligned rectangle of the lattice, its borders included.
    struct Box {
        Point lo, hi;
    };
    /// An edge or node that reaches into a cell. Its box lies beside its number: most of what a cell holds is too far
    /// away, and is told so without a look at the graph.
    struct Entry {
        Box box;
        uint32_t index = noIndex;
    };
    using Cell = std::vector<Entry>;
    static constexpr int32_t pageBits = 4;
    /// A square of cells side by side, so that most questions look up one.
    using Page = std::array<Cell, size_t{1} << 2 * pageBits>;
    using Pages = std::unordered_map<uint64_t, Page>;
    /// Calls visit(cell) for each cell that the box reaches into; pages that aren't there are made unless `Of` is
    /// const.
    template <class Of, class Visit>
    static void eachCell(Of& pages, const Box& box, Visit&& visit);
    static Box boxOf(Point a, Point b, int32_t margin_mm = 0);
    static Nearby gather(const Pages& pages, const Box& box);
    void enter(uint32_t edge);
    void leave(uint32_t edge);

    std::vector<RoadNode> nodes_;
    std::vector<RoadEdge> edges_;
    Pages nodePages_, edgePages_;
};

}  // namespace sgm::town
