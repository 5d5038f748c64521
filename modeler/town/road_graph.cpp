#include "modeler/town/road_graph.h"

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

constexpr int cellBits = 16;  // cells of 65.536 m

uint64_t pageKey(int32_t x, int32_t z) {
    return static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32 | static_cast<uint32_t>(z);
}

int32_t millimetres(double metres) { return static_cast<int32_t>(std::ceil(metres * 1000)); }

/// Whether p, on the line through shared → end, goes the same way as end: two edges of one node would overlap.
bool runsAlong(Point shared, Point end, Point p) {
    if (turnOf(shared, end, p) != 0) return false;
    const int64_t x = int64_t{end.x} - shared.x, z = int64_t{end.z} - shared.z;
    return x * (int64_t{p.x} - shared.x) + z * (int64_t{p.z} - shared.z) > 0;
}

}  // namespace

RoadGraph::Box RoadGraph::boxOf(Point a, Point b, int32_t margin_mm) {
    return {{std::min(a.x, b.x) - margin_mm, std::min(a.z, b.z) - margin_mm},
            {std::max(a.x, b.x) + margin_mm, std::max(a.z, b.z) + margin_mm}};
}

template <class Of, class Visit>
void RoadGraph::eachCell(Of& pages, const Box& box, Visit&& visit) {
    constexpr int32_t cellsAlong = 1 << pageBits;
    const Point lo{box.lo.x >> cellBits, box.lo.z >> cellBits}, hi{box.hi.x >> cellBits, box.hi.z >> cellBits};
    for (int32_t px = lo.x >> pageBits; px <= hi.x >> pageBits; ++px)
        for (int32_t pz = lo.z >> pageBits; pz <= hi.z >> pageBits; ++pz) {
            std::conditional_t<std::is_const_v<Of>, const Page, Page>* page;
            if constexpr (std::is_const_v<Of>) {
                const auto found = pages.find(pageKey(px, pz));
                if (found == pages.end()) continue;
                page = &found->second;
            } else {
                page = &pages[pageKey(px, pz)];
            }
            const Point first{px * cellsAlong, pz * cellsAlong};
            const int32_t endX = std::min(hi.x - first.x + 1, cellsAlong),
                          endZ = std::min(hi.z - first.z + 1, cellsAlong);
            for (int32_t x = std::max(lo.x - first.x, 0); x < endX; ++x)
                for (int32_t z = std::max(lo.z - first.z, 0); z < endZ; ++z)
                    visit((*page)[static_cast<size_t>(x * cellsAlong + z)]);
        }
}

Nearby RoadGraph::gather(const Pages& pages, const Box& box) {
    Nearby found;
    eachCell(pages, box, [&](const Cell& cell) {
        for (const Entry& entry : cell) {
            const auto& [lo, hi] = entry.box;
            if (lo.x <= box.hi.x && hi.x >= box.lo.x && lo.z <= box.hi.z && hi.z >= box.lo.z)
                found.push_back(entry.index);
        }
    });
    if (found.size() < 2) return found;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

Nearby RoadGraph::edgesNear(Point a, Point b, double margin_m) const {
    return gather(edgePages_, boxOf(a, b, millimetres(margin_m)));
}

Nearby RoadGraph::nodesNear(Point a, Point b, double margin_m) const {
    return gather(nodePages_, boxOf(a, b, millimetres(margin_m)));
}

bool RoadGraph::areJoined(uint32_t a, uint32_t b) const {
    const auto& list = nodes_[a].edges;
    return std::any_of(list.begin(), list.end(), [&](uint32_t e) { return edges_[e].other(a) == b; });
}

uint32_t RoadGraph::addNode(Point at) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({at, {}});
    nodes_.back().edges.reserve(4);
    eachCell(nodePages_, boxOf(at, at), [&](Cell& cell) { cell.push_back({boxOf(at, at), index}); });
    return index;
}

void RoadGraph::enter(uint32_t edge) {
    const Box box = boxOf(at(edges_[edge].a), at(edges_[edge].b));
    eachCell(edgePages_, box, [&](Cell& cell) { cell.push_back({box, edge}); });
}

void RoadGraph::leave(uint32_t edge) {
    eachCell(edgePages_, boxOf(at(edges_[edge].a), at(edges_[edge].b)),
             [&](Cell& cell) { std::erase_if(cell, [&](const Entry& entry) { return entry.index == edge; }); });
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
    kept.nodes_.reserve(nodes_.size());
    kept.edges_.reserve(edges_.size());
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
