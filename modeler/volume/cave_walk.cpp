// Floors and ways. A floor under enough headroom that isn't too steep, and over which the agent's capsule is clear of
// the rock, is a node of the walk; neighbouring columns within a step are its links (voxel spans as in Mononen's
// Recast).
#include <algorithm>
#include <queue>

#include "modeler/volume/cave_parts.h"

namespace sgm::volume {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// Air between a floor and a roof in one column: voxels [first, first + count).
struct Span {
    uint32_t first, count;
    float floor_m;  ///< height of the floor
    bool hasFloor, hasRoof;
    float cosine;  ///< of the floor's slope
};

/// Shortest ways from one node to all. `links(node, visit)` calls visit(neighbour, metres).
template <class Links>
std::vector<float> distancesFrom(uint32_t start, size_t nodes, const Links& links) {
    std::vector<float> distance(nodes, infinite);
    using Entry = std::pair<float, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    distance[start] = 0;
    open.push({0.0f, start});
    while (!open.empty()) {
        const float d = open.top().first;
        const uint32_t node = open.top().second;
        open.pop();
        if (d > distance[node]) continue;
        links(node, [&](uint32_t other, float metres) {
            if (d + metres < distance[other]) open.push({distance[other] = d + metres, other});
        });
    }
    return distance;
}

/// The farthest node that can be reached.
uint32_t farthest(const std::vector<float>& distance) {
    uint32_t best = 0;
    for (uint32_t i = 0; i < distance.size(); ++i)
        if (distance[i] < infinite && !(distance[best] >= distance[i] && distance[best] < infinite)) best = i;
    return best;
}

/// Length of the longest of all shortest ways in the part around `start`, by two sweeps: exact in a tree.
template <class Links>
double longestWay(uint32_t start, size_t nodes, const Links& links) {
    const uint32_t end = farthest(distancesFrom(start, nodes, links));
    const auto distance = distancesFrom(end, nodes, links);
    return static_cast<double>(distance[farthest(distance)]);
}

constexpr size_t sides[4] = {0, 1, 4, 5};  // of Air::next: +x -x +z -z

class Walk {
public:
    Walk(const Air& air, const std::vector<uint32_t>& spaceOf, Cave& cave)
        : air_(air),
          spaceOf_(spaceOf),
          cave_(cave),
          half_m_(air.voxel_m / 2),
          radius_m_(static_cast<float>(cave.agent.radius_m)),
          height_m_(static_cast<float>(cave.agent.height_m)),
          step_m_(std::max(static_cast<float>(cave.agent.step_m()) + half_m_,
                           air.voxel_m * static_cast<float>(std::tan(cave.agent.slope_rad)))) {}

    void run() {
        findSpans();
        measureFloors();
        linkNodes();
        measureWalk();
    }

private:
    void findSpans();
    bool holdsBall(const Span& span) const;
    void measureFloors();
    bool isLow(const Span& span) const;
    bool canStand(const Span& span) const;
    void linkNodes();
    uint32_t beside(const Span& span, size_t side, float most_m) const;
    float rise(const Span& span, size_t pair) const;
    static float square(float x) { return x * x; }
    std::vector<uint32_t> parts() const;
    void measureWalk();
    double area(const Span& span) const {
        const double cell = static_cast<double>(air_.voxel_m);
        return cell * cell / static_cast<double>(span.cosine);
    }
    bool gentle(const Span& span) const {
        return span.hasFloor && span.cosine >= static_cast<float>(std::cos(cave_.agent.slope_rad)) - 1e-3f;
    }

    const Air& air_;
    const std::vector<uint32_t>& spaceOf_;
    Cave& cave_;
    float half_m_, radius_m_, height_m_, step_m_;
    std::vector<Span> spans_;
    std::vector<uint32_t> spanOf_;  ///< by voxel
    std::vector<uint32_t> nodes_;   ///< spans on which the agent can stand
    std::vector<uint32_t> nodeOf_;  ///< by span: its node, or nowhere
    std::vector<std::array<uint32_t, 4>> link_;
};

void Walk::findSpans() {
    spanOf_.resize(air_.size());
    for (uint32_t v = 0; v < air_.size(); ++v) {
        Span span{v, 1, air_.floor_m[v], !std::isnan(air_.floor_m[v]), false, 1};
        if (!span.hasFloor) span.floor_m = air_.place(v).y - half_m_;
        spanOf_[v] = static_cast<uint32_t>(spans_.size());
        for (; air_.next[v][2] != nowhere; ++span.count)
            spanOf_[v = air_.next[v][2]] = static_cast<uint32_t>(spans_.size());
        span.hasRoof = !(air_.rim[v] & 4);
        spans_.push_back(span);
    }
    for (Span& span : spans_) span.cosine = 1 / std::sqrt(1 + square(rise(span, 0)) + square(rise(span, 2)));
}

/// The span whose floor is next to this one's toward a side and at most `most_m` higher or lower; nowhere without one.
uint32_t Walk::beside(const Span& span, size_t side, float most_m) const {
    for (uint32_t v = span.first; v < span.first + span.count; ++v) {
        if (air_.place(v).y - span.floor_m > most_m + 2 * half_m_) break;
        const uint32_t n = air_.next[v][side];
        if (n != nowhere && std::abs(spans_[spanOf_[n]].floor_m - span.floor_m) <= most_m) return spanOf_[n];
    }
    return nowhere;
}

/// Height by way of the floor along x (pair 0) or z (pair 2) of `sides`. A wall or a ledge counts on neither side.
float Walk::rise(const Span& span, size_t pair) const {
    const uint32_t ahead = beside(span, sides[pair], 4 * half_m_), behind = beside(span, sides[pair + 1], 4 * half_m_);
    const float up = ahead == nowhere ? span.floor_m : spans_[ahead].floor_m;
    const float down = behind == nowhere ? span.floor_m : spans_[behind].floor_m;
    const int ways = (ahead != nowhere) + (behind != nowhere);
    return ways == 0 ? 0 : (up - down) / (2 * half_m_ * static_cast<float>(ways));
}

/// True where the agent's ball fits somewhere between floor and roof: not in the wedge where they meet.
bool Walk::holdsBall(const Span& span) const {
    const auto first = air_.clearance_m.begin() + span.first;
    return *std::max_element(first, first + span.count) >= radius_m_ - half_m_;
}

void Walk::measureFloors() {
    std::vector<float> headrooms;
    for (const Span& span : spans_) {
        if (spaceOf_[span.first] == nowhere || !span.hasFloor) continue;
        const double slope_deg = degrees(std::acos(static_cast<double>(span.cosine)));
        size_t k = 0;
        while (k < 4 && slope_deg > Cave::slopeClasses_deg[k]) ++k;
        if (k < 4) cave_.floor_m2[k] += area(span);
        const uint32_t top = span.first + span.count - 1;
        if (gentle(span) && span.hasRoof && holdsBall(span)) headrooms.push_back(air_.roof_m[top] - span.floor_m);
    }
    if (headrooms.empty()) return;
    std::sort(headrooms.begin(), headrooms.end());
    cave_.headroom = {headrooms.front(), headrooms[headrooms.size() / 2], headrooms.back()};
}

/// Whether the roof is lower than the agent: heights are known to far less than a voxel, clearances aren't.
bool Walk::isLow(const Span& span) const {
    constexpr float rounding = 0.05f;  // of a voxel
    if (!span.hasRoof) return false;
    const float headroom_m = air_.roof_m[span.first + span.count - 1] - span.floor_m;
    return headroom_m < height_m_ - rounding * air_.voxel_m;
}

/// Whether the agent can stand on the span. Its ball must be clear of rock from some height up to the agent's own; the
/// ball rests there or hangs at most a step higher. So rock beside it that is no higher than a step is stepped upon,
/// and stairs are one walk.
bool Walk::canStand(const Span& span) const {
    if (!gentle(span) || spaceOf_[span.first] == nowhere || isLow(span)) return false;
    const float least = radius_m_ - half_m_;
    const float resting = radius_m_ / span.cosine + 2 * half_m_;  // a ball on a slope stands higher
    const float reach = std::max(resting, radius_m_ + static_cast<float>(cave_.agent.step_m()));
    uint32_t v = span.first;
    const uint32_t end = span.first + span.count;
    const auto above = [&](uint32_t i) { return air_.place(i).y - span.floor_m; };
    while (v < end && above(v) < radius_m_ - half_m_) ++v;
    while (v < end && air_.clearance_m[v] < least && above(v) <= reach) ++v;
    if (v == end || air_.clearance_m[v] < least) return false;
    const float top = height_m_ - radius_m_ - half_m_;
    uint32_t u = v;
    while (u < end && above(u) < top && air_.clearance_m[u] >= least) ++u;
    return u == end ? !span.hasRoof || above(u - 1) >= top : above(u) >= top;
}

void Walk::linkNodes() {
    nodeOf_.assign(spans_.size(), nowhere);
    for (uint32_t s = 0; s < spans_.size(); ++s) {
        if (!canStand(spans_[s])) continue;
        nodeOf_[s] = static_cast<uint32_t>(nodes_.size());
        nodes_.push_back(s);
    }
    link_.resize(nodes_.size());
    for (uint32_t n = 0; n < nodes_.size(); ++n)
        for (size_t side = 0; side < 4; ++side) {
            const uint32_t s = beside(spans_[nodes_[n]], sides[side], step_m_);
            link_[n][side] = s == nowhere ? nowhere : nodeOf_[s];
        }
}

/// The part of each node, numbered from 0 in order of their first nodes.
std::vector<uint32_t> Walk::parts() const {
    std::vector<uint32_t> part(nodes_.size(), nowhere), stack;
    uint32_t number = 0;
    for (uint32_t first = 0; first < nodes_.size(); ++first) {
        if (part[first] != nowhere) continue;
        part[first] = number;
        stack.push_back(first);
        while (!stack.empty()) {
            const uint32_t n = stack.back();
            stack.pop_back();
            for (const uint32_t m : link_[n])
                if (m != nowhere && part[m] == nowhere) part[m] = number, stack.push_back(m);
        }
        ++number;
    }
    return part;
}

void Walk::measureWalk() {
    if (nodes_.empty()) return;
    const std::vector<uint32_t> part = parts();
    cave_.walkParts = 1 + *std::max_element(part.begin(), part.end());
    std::vector<double> area_m2(cave_.walkParts);
    std::vector<bool> entered(cave_.walkParts);
    for (uint32_t n = 0; n < nodes_.size(); ++n) {
        const Span& span = spans_[nodes_[n]];
        const Vec3i at = air_.voxels[span.first];
        cave_.walkable.push_back({at.x, at.z, span.floor_m});
        cave_.walkable_m2 += area(span);
        area_m2[part[n]] += area(span);
        for (uint32_t v = span.first; v < span.first + span.count; ++v)
            if (air_.rim[v] & 0b110011) entered[part[n]] = true;  // an opening in a wall
    }
    if (std::find(entered.begin(), entered.end(), true) == entered.end())
        entered[static_cast<size_t>(std::max_element(area_m2.begin(), area_m2.end()) - area_m2.begin())] = true;
    const auto links = [&](uint32_t n, const auto& visit) {
        const auto go = [&](uint32_t m) {
            if (m != nowhere)
                visit(m, length(Vec3f{air_.place(spans_[nodes_[m]].first) - air_.place(spans_[nodes_[n]].first)}));
        };
        for (size_t i = 0; i < 4; ++i) go(link_[n][i]);
        for (size_t i = 0; i < 2; ++i)  // across corners where both ways round are open
            for (size_t k = 2; k < 4; ++k) {
                const uint32_t x = link_[n][i], z = link_[n][k];
                if (x != nowhere && z != nowhere && link_[x][k] == link_[z][i]) go(link_[x][k]);
            }
    };
    std::vector<bool> done(cave_.walkParts);
    for (uint32_t n = 0; n < nodes_.size(); ++n) {
        if (!entered[part[n]] || done[part[n]]) continue;
        done[part[n]] = true;
        cave_.reachable_m2 += area_m2[part[n]];
        cave_.longestWalk_m = std::max(cave_.longestWalk_m, longestWay(n, nodes_.size(), links));
    }
}

/// The longest way of the agent's ball through the largest space: the air eroded by its radius.
double longestPath(const Air& air, const std::vector<uint32_t>& spaceOf, const Cave& cave) {
    const float least = static_cast<float>(cave.agent.radius_m) - air.voxel_m / 2;
    const auto clear = [&](uint32_t v) { return v != nowhere && air.clearance_m[v] >= least; };
    const float one = air.voxel_m, two = one * std::sqrt(2.0f);
    const auto links = [&](uint32_t v, const auto& visit) {
        for (size_t d = 0; d < 6; ++d) {
            const uint32_t n = air.next[v][d];
            if (!clear(n)) continue;
            visit(n, one);
            for (size_t e = (d | 1) + 1; e < 6; ++e)  // the axes after d's own: every diagonal of a face once
                if (clear(air.next[n][e])) visit(air.next[n][e], two);
        }
    };
    uint32_t start = nowhere;
    for (uint32_t v = 0; v < air.size(); ++v)
        if (spaceOf[v] == 0 && (start == nowhere || air.clearance_m[v] > air.clearance_m[start])) start = v;
    return start == nowhere ? 0 : longestWay(start, air.size(), links);
}

}  // namespace

void findWays(const Air& air, const std::vector<uint32_t>& spaceOf, Cave& cave) {
    Walk(air, spaceOf, cave).run();
    cave.longestPath_m = longestPath(air, spaceOf, cave);
}

}  // namespace sgm::volume
