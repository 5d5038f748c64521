#include "modeler/town/road_graph.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

constexpr int cellBits = 17;  // cells of 131.072 m

uint64_t cellKey(int32_t x, int32_t z) {
    return static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32 | static_cast<uint32_t>(z);
}

/// Whether p, on the line through shared → end, goes the same way as end: two edges of one node would overlap.
bool runsAlong(Point shared, Point end, Point p) {
    if (turnOf(shared, end, p) != 0) return false;
    const int64_t x = int64_t{end.x} - shared.x, z = int64_t{end.z} - shared.z;
    return x * (int64_t{p.x} - shared.x) + z * (int64_t{p.z} - shared.z) > 0;
}

}  // namespace

template <class Visit>
void RoadGraph::eachCell(Point a, Point b, int32_t margin_mm, Visit&& visit) {
    const int32_t x0 = (std::min(a.x, b.x) - margin_mm) >> cellBits, x1 = (std::max(a.x, b.x) + margin_mm) >> cellBits;
    const int32_t z0 = (std::min(a.z, b.z) - margin_mm) >> cellBits, z1 = (std::max(a.z, b.z) + margin_mm) >> cellBits;
    for (int32_t x = x0; x <= x1; ++x)
        for (int32_t z = z0; z <= z1; ++z) visit(cellKey(x, z));
}

std::vector<uint32_t> RoadGraph::gather(const Cells& cells, Point a, Point b, double margin_m) {
    std::vector<uint32_t> found;
    found.reserve(32);
    eachCell(a, b, static_cast<int32_t>(std::ceil(margin_m * 1000)), [&](uint64_t key) {
        if (const auto cell = cells.find(key); cell != cells.end())
            found.insert(found.end(), cell->second.begin(), cell->second.end());
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<uint32_t> RoadGraph::edgesNear(Point a, Point b, double margin_m) const {
    return gather(edgeCells_, a, b, margin_m);
}

std::vector<uint32_t> RoadGraph::nodesNear(Point a, Point b, double margin_m) const {
    return gather(nodeCells_, a, b, margin_m);
}

bool RoadGraph::areJoined(uint32_t a, uint32_t b) const {
    const auto& list = nodes_[a].edges;
    return std::any_of(list.begin(), list.end(), [&](uint32_t e) { return edges_[e].other(a) == b; });
}

uint32_t RoadGraph::addNode(Point at) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({at, {}});
    nodeCells_[cellKey(at.x >> cellBits, at.z >> cellBits)].push_back(index);
    return index;
}

void RoadGraph::enter(uint32_t edge) {
    eachCell(at(edges_[edge].a), at(edges_[edge].b), 0, [&](uint64_t key) { edgeCells_[key].push_back(edge); });
}

void RoadGraph::leave(uint32_t edge) {
    eachCell(at(edges_[edge].a), at(edges_[edge].b), 0, [&](uint64_t key) { std::erase(edgeCells_[key], edge); });
}

uint32_t RoadGraph::addEdge(uint32_t a, uint32_t b, RoadClass kind, bool bridge, bool own, uint32_t curve,
                            bool tunnel) {
    const auto index = static_cast<uint32_t>(edges_.size());
    edges_.push_back({a, b, kind, bridge, tunnel, false, own, curve});
    nodes_[a].edges.push_back(index);
    nodes_[b].edges.push_back(index);
    enter(index);
    return index;
}

uint32_t RoadGraph::splitEdge(uint32_t edge, Point at) {
    const uint32_t node = addNode(at), far = edges_[edge].b;
    leave(edge);
    std::erase(nodes_[far].edges, edge);
    edges_[edge].b = node;
    nodes_[node].edges.push_back(edge);
    enter(edge);
    addEdge(node, far, edges_[edge].kind, edges_[edge].bridge, edges_[edge].own, edges_[edge].curve,
            edges_[edge].tunnel);
    return node;
}

void RoadGraph::remove(uint32_t edge) {
    leave(edge);
    std::erase(nodes_[edges_[edge].a].edges, edge);
    std::erase(nodes_[edges_[edge].b].edges, edge);
    edges_[edge].removed = true;
}

void RoadGraph::compact() {
    RoadGraph kept;
    std::vector<uint32_t> number(nodes_.size(), noIndex);
    for (uint32_t n = 0; n < nodes_.size(); ++n)
        if (!nodes_[n].edges.empty()) number[n] = kept.addNode(nodes_[n].at);
    for (const RoadEdge& e : edges_)
        if (!e.removed) kept.addEdge(number[e.a], number[e.b], e.kind, e.bridge, e.own, e.curve, e.tunnel);
    *this = std::move(kept);
}

bool RoadGraph::isFree(Point a, Point b, uint32_t nodeA, uint32_t nodeB, uint32_t but) const {
    if (a == b) return false;
    for (const uint32_t index : edgesNear(a, b, 0)) {
        if (index == but) continue;
        const RoadEdge& e = edges_[index];
        const bool atA = nodeA != noIndex && (e.a == nodeA || e.b == nodeA);
        const bool atB = nodeB != noIndex && (e.a == nodeB || e.b == nodeB);
        if (!atA && !atB) {
            if (segmentsMeet(a, b, at(e.a), at(e.b))) return false;
            continue;
        }
        if (atA && atB) return false;  // joined already
        const uint32_t shared = atA ? nodeA : nodeB;
        if (runsAlong(at(shared), at(e.other(shared)), atA ? b : a)) return false;
    }
    return true;
}

}  // namespace sgm::town
