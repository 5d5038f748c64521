// Rooms by a sweep from the widest voxel to the narrowest: basins of clearance grow, and where two meet is the widest
// way between them (the maximum spanning tree, by Kruskal's union-find; persistence after Edelsbrunner, Letscher,
// Zomorodian 2002).
#include "modeler/volume/cave_parts.h"

#include <algorithm>
#include <numeric>

namespace sgm::volume {
namespace {

/// A neck at most this wide, against the smaller of two basins, makes them two rooms.
constexpr float neck = 0.75f;

class Sweep {
public:
    Sweep(const Air& air, Cave& cave)
        : air_(air),
          cave_(cave),
          agent_m_(static_cast<float>(cave.agent.radius_m)),
          parent_(air.size(), nowhere),
          basin_(air.size()),
          into_(air.size()),
          opening_(air.size(), nowhere) {}

    std::vector<uint32_t> run() {
        findOpenings();
        std::vector<uint32_t> order(air_.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return air_.clearance_m[a] != air_.clearance_m[b] ? air_.clearance_m[a] > air_.clearance_m[b] : a < b;
        });
        for (const uint32_t v : order) visit(v);
        return settle();
    }

private:
    /// A component of the air swept so far, kept at its root.
    struct Component {
        uint32_t peak = nowhere;  ///< its widest voxel
        uint64_t voxels = 0;
        std::vector<uint32_t> entrances;
    };
    struct Neck {
        uint32_t a, b, at;  ///< basins, and the voxel where they meet
    };

    float clearance(uint32_t v) const { return air_.clearance_m[v]; }
    uint32_t root(uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    /// The basin that took this one in, or itself.
    uint32_t basinOf(uint32_t b) {
        while (into_[b] != b) b = into_[b] = into_[into_[b]];
        return b;
    }
    void findOpenings();
    void visit(uint32_t v);
    void join(uint32_t a, uint32_t b, uint32_t v);
    std::vector<uint32_t> settle();

    const Air& air_;
    Cave& cave_;
    float agent_m_;
    std::vector<uint32_t> parent_, basin_, into_, opening_;
    std::vector<uint32_t> component_;  ///< by root: its place in components_
    std::vector<Component> components_;
    std::vector<Neck> necks_;
    std::vector<float> bottleneck_m_;
};

/// Patches of the box's sides through which air goes out: connected voxels of its outermost layer.
void Sweep::findOpenings() {
    component_.assign(air_.size(), nowhere);
    std::vector<uint32_t> stack;
    for (uint32_t first = 0; first < air_.size(); ++first) {
        if (!air_.rim[first] || opening_[first] != nowhere) continue;
        Entrance e;
        Vec3d sum;
        double voxels = 0, faces[6] = {};
        const auto number = static_cast<uint32_t>(cave_.entrances.size());
        opening_[first] = number;
        stack.push_back(first);
        while (!stack.empty()) {
            const uint32_t v = stack.back();
            stack.pop_back();
            sum += air_.place(v).as<double>();
            ++voxels;
            for (size_t d = 0; d < 6; ++d) faces[d] += (air_.rim[v] >> d) & 1;
            e.radius_m = std::max(e.radius_m, clearance(v));
            for (const uint32_t n : air_.next[v])
                if (n != nowhere && air_.rim[n] && opening_[n] == nowhere) opening_[n] = number, stack.push_back(n);
        }
        e.at = (sum / voxels).as<float>();
        e.face = static_cast<uint32_t>(std::max_element(faces, faces + 6) - faces);
        e.area_m2 = std::accumulate(faces, faces + 6, 0.0) * static_cast<double>(air_.voxel_m) *
                    static_cast<double>(air_.voxel_m);
        cave_.entrances.push_back(e);
    }
    bottleneck_m_.assign(cave_.entrances.size(), -1);
}

void Sweep::visit(uint32_t v) {
    parent_[v] = v;
    uint32_t highest = nowhere;
    for (const uint32_t n : air_.next[v])
        if (n != nowhere && parent_[n] != nowhere && (highest == nowhere || clearance(n) > clearance(highest)))
            highest = n;
    basin_[v] = highest == nowhere ? v : basin_[highest];
    if (highest == nowhere) into_[v] = v;
    component_[v] = static_cast<uint32_t>(components_.size());
    if (highest == nowhere)
        components_.push_back({v, 1, {}});
    else {
        const uint32_t r = root(highest);
        parent_[v] = r;
        ++components_[component_[r]].voxels;
    }
    // The first voxel of an opening is its widest: the way in is no wider.
    if (const uint32_t e = opening_[v]; e != nowhere && bottleneck_m_[e] < 0) {
        bottleneck_m_[e] = clearance(v);
        components_[component_[root(v)]].entrances.push_back(e);
    }
    for (const uint32_t n : air_.next[v])
        if (n != nowhere && n != highest && parent_[n] != nowhere && root(n) != root(v)) join(n, highest, v);
}

/// Two components meet at v, between its neighbours a and b.
void Sweep::join(uint32_t a, uint32_t b, uint32_t v) {
    const auto wider = [&](uint32_t x, uint32_t y) {
        const uint32_t p = components_[component_[root(x)]].peak, q = components_[component_[root(y)]].peak;
        return clearance(p) != clearance(q) ? clearance(p) > clearance(q) : p < q;
    };
    if (wider(b, a)) std::swap(a, b);
    Component &wide = components_[component_[root(a)]], &narrow = components_[component_[root(b)]];
    const float level = clearance(v), peak = clearance(narrow.peak);
    if (peak >= agent_m_ && level <= neck * peak)
        necks_.push_back({basin_[a], basin_[b], v});
    else
        into_[narrow.peak] = basinOf(basin_[a]);
    for (const uint32_t e : narrow.entrances) bottleneck_m_[e] = level;
    wide.entrances.insert(wide.entrances.end(), narrow.entrances.begin(), narrow.entrances.end());
    wide.voxels += narrow.voxels;
    narrow = {};
    parent_[root(b)] = root(a);
}

/// Numbers what was found: spaces and rooms by size, entrances by area.
std::vector<uint32_t> Sweep::settle() {
    const double voxel_m3 = std::pow(static_cast<double>(air_.voxel_m), 3);
    std::vector<uint32_t> roots;
    for (uint32_t v = 0; v < air_.size(); ++v) {
        if (parent_[v] != v) continue;
        if (clearance(components_[component_[v]].peak) >= agent_m_)
            roots.push_back(v);
        else
            ++cave_.pockets;
    }
    const auto voxels = [&](uint32_t r) { return components_[component_[r]].voxels; };
    std::stable_sort(roots.begin(), roots.end(), [&](uint32_t a, uint32_t b) { return voxels(a) > voxels(b); });
    std::vector<uint32_t> spaceOfRoot(air_.size(), nowhere);
    for (const uint32_t r : roots) {
        spaceOfRoot[r] = static_cast<uint32_t>(cave_.spaces.size());
        cave_.spaces.push_back({static_cast<double>(voxels(r)) * voxel_m3, 0, 0});
    }
    std::vector<uint32_t> spaceOf(air_.size());
    for (uint32_t v = 0; v < air_.size(); ++v) spaceOf[v] = spaceOfRoot[root(v)];

    std::vector<uint32_t> peaks;
    for (uint32_t v = 0; v < air_.size(); ++v)
        if (basin_[v] == v && into_[v] == v && spaceOf[v] != nowhere) peaks.push_back(v);
    std::stable_sort(peaks.begin(), peaks.end(), [&](uint32_t a, uint32_t b) { return clearance(a) > clearance(b); });
    std::vector<uint32_t> roomOf(air_.size(), nowhere);
    for (const uint32_t p : peaks) {
        roomOf[p] = static_cast<uint32_t>(cave_.rooms.size());
        cave_.rooms.push_back({air_.place(p), clearance(p), spaceOf[p]});
        ++cave_.spaces[spaceOf[p]].rooms;
    }
    // A voxel is wide enough when the agent's ball fits between the surface's samples: half a voxel is within the
    // error.
    const float least = agent_m_ - air_.voxel_m / 2;
    for (const Neck& n : necks_)
        cave_.passages.push_back({{roomOf[basinOf(n.a)], roomOf[basinOf(n.b)]},
                                  air_.place(n.at),
                                  clearance(n.at),
                                  clearance(n.at) >= least});
    for (uint32_t v = 0; v < air_.size(); ++v)
        if (opening_[v] != nowhere) cave_.entrances[opening_[v]].space = spaceOf[v];
    for (size_t e = 0; e < cave_.entrances.size(); ++e) cave_.entrances[e].bottleneck_m = bottleneck_m_[e];
    std::erase_if(cave_.entrances, [](const Entrance& e) { return e.space == nowhere; });
    std::stable_sort(cave_.entrances.begin(), cave_.entrances.end(),
                     [](const Entrance& a, const Entrance& b) { return a.area_m2 > b.area_m2; });
    for (const Entrance& e : cave_.entrances) ++cave_.spaces[e.space].entrances;
    return spaceOf;
}

}  // namespace

std::vector<uint32_t> findRooms(const Air& air, Cave& cave) { return Sweep(air, cave).run(); }

}  // namespace sgm::volume
