#include "modeler/town/faces.h"

#include <algorithm>
#include <map>

namespace sgm::town {
namespace {

using Loop = std::vector<HalfEdge>;

/// 0 for directions from +x up to −x, 1 for the others.
int halfOf(Point d) { return d.z > 0 || (d.z == 0 && d.x > 0) ? 0 : 1; }

double areaOf(const RoadGraph& graph, const Loop& loop) {
    double twice = 0;
    const Vec2 origin = graph.metresAt(beginOf(graph, loop[0]));
    for (const HalfEdge h : loop) {
        const Vec2 a = graph.metresAt(beginOf(graph, h)), b = graph.metresAt(beginOf(graph, h ^ 1));
        twice += cross(a - origin, b - origin);
    }
    return twice / 2;
}

/// A walk taken apart at edges that it goes both ways, and then at nodes that it meets twice.
struct Parted {
    std::vector<Loop> loops;
    std::vector<uint32_t> spurs;
};

/// Whether some number is there twice.
bool repeats(std::vector<uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    return std::adjacent_find(numbers.begin(), numbers.end()) != numbers.end();
}

/// Loops without a common edge: what lies between both directions of an edge is a loop of its own.
void partAtSpurs(const Loop& walk, Parted& out) {
    std::vector<uint32_t> edges;
    edges.reserve(walk.size());
    for (const HalfEdge h : walk) edges.push_back(edgeOf(h));
    if (!repeats(edges)) return out.loops.push_back(walk);
    std::map<uint32_t, int> times;
    for (const HalfEdge h : walk) ++times[edgeOf(h)];
    std::vector<Loop> open(1);
    std::vector<uint32_t> entered;
    for (const HalfEdge h : walk) {
        if (times[edgeOf(h)] == 1) {
            open.back().push_back(h);
        } else if (entered.empty() || entered.back() != edgeOf(h)) {
            entered.push_back(edgeOf(h));
            open.emplace_back();
        } else {
            entered.pop_back();
            out.spurs.push_back(edgeOf(h));
            if (!open.back().empty()) out.loops.push_back(std::move(open.back()));
            open.pop_back();
        }
    }
    if (!open.front().empty()) out.loops.push_back(std::move(open.front()));
}

/// Loops that meet no node twice.
void partAtNodes(const RoadGraph& graph, const Loop& loop, std::vector<Loop>& out) {
    std::vector<uint32_t> nodes;
    nodes.reserve(loop.size());
    for (const HalfEdge h : loop) nodes.push_back(beginOf(graph, h));
    if (!repeats(nodes)) return out.push_back(loop);
    Loop stack;
    std::map<uint32_t, size_t> place;  // of the node where each half-edge on the stack begins
    for (const HalfEdge h : loop) {
        const uint32_t node = beginOf(graph, h);
        if (const auto seen = place.find(node); seen != place.end()) {
            const size_t from = seen->second;
            out.emplace_back(stack.begin() + static_cast<ptrdiff_t>(from), stack.end());
            for (size_t i = from; i < stack.size(); ++i) place.erase(beginOf(graph, stack[i]));
            stack.resize(from);
        }
        place[node] = stack.size();
        stack.push_back(h);
    }
    if (!stack.empty()) out.push_back(std::move(stack));
}

}  // namespace

std::vector<std::vector<uint32_t>> edgesAround(const RoadGraph& graph) {
    std::vector<std::vector<uint32_t>> around(graph.nodes().size());
    for (uint32_t n = 0; n < around.size(); ++n) {
        around[n] = graph.nodes()[n].edges;
        const Point at = graph.at(n);
        const auto direction = [&](uint32_t e) {
            const Point far = graph.at(graph.edge(e).other(n));
            return Point{far.x - at.x, far.z - at.z};
        };
        std::sort(around[n].begin(), around[n].end(), [&](uint32_t e, uint32_t f) {
            const Point d = direction(e), g = direction(f);
            if (halfOf(d) != halfOf(g)) return halfOf(d) < halfOf(g);
            return int64_t{d.x} * g.z - int64_t{d.z} * g.x > 0;
        });
    }
    return around;
}

std::vector<Face> facesOf(const RoadGraph& graph) {
    const auto around = edgesAround(graph);
    const auto next = [&](HalfEdge h) {
        const uint32_t node = beginOf(graph, h ^ 1);
        const auto& list = around[node];
        const auto at = static_cast<size_t>(std::find(list.begin(), list.end(), edgeOf(h)) - list.begin());
        const uint32_t e = list[(at + list.size() - 1) % list.size()];
        return 2 * e + (graph.edge(e).a == node ? 0u : 1u);
    };
    std::vector<bool> seen(2 * graph.edges().size(), false);
    std::vector<Face> faces;
    for (HalfEdge first = 0; first < seen.size(); ++first) {
        if (seen[first] || graph.edge(edgeOf(first)).removed) continue;
        Loop walk;
        for (HalfEdge h = first; !seen[h]; h = next(h)) seen[h] = true, walk.push_back(h);
        Parted parted;
        partAtSpurs(walk, parted);
        std::vector<Loop> simple;
        for (const Loop& loop : parted.loops) partAtNodes(graph, loop, simple);
        Face face;
        for (Loop& loop : simple) {
            if (areaOf(graph, loop) <= 0)
                face.holes.push_back(std::move(loop));
            else if (face.outline.empty())
                face.outline = std::move(loop);
        }
        face.spurs = std::move(parted.spurs);
        if (!face.outline.empty()) faces.push_back(std::move(face));
    }
    return faces;
}

}  // namespace sgm::town
