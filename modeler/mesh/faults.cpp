#include "modeler/mesh/faults.h"

#include <algorithm>
#include <bit>
#include <mutex>

#include "modeler/core/parallel.h"
#include "modeler/mesh/exact_meeting.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t leafTriangles = 4;
constexpr size_t tasksPerThread = 64;
constexpr uint32_t noRegion = 0xffffffffu;

/// The bits of a coordinate in [0, 1023], two places between each.
uint32_t spread(uint32_t x) {
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

/// What a node bounds: triangles.
struct Bounds {
    Box3f box;
    bool fresh = false;         ///< whether one of them is to be compared with all
    uint32_t sound = noRegion;  ///< the sound region that has all of them

    /// Whether the triangles of both are known to meet nowhere wrongly.
    bool isSoundWith(const Bounds& other) const { return sound != noRegion && sound == other.sound; }
    bool meets(const Bounds& other) const { return !intersection(box, other.box).empty(); }
};

Bounds hull(const Bounds& a, const Bounds& b) {
    const uint32_t sound = a.box.empty() || a.sound == b.sound ? b.sound : b.box.empty() ? a.sound : noRegion;
    return {sgm::hull(a.box, b.box), a.fresh || b.fresh, sound};
}

/// A complete binary tree over triangles in the order of a space-filling curve (Morton 1966); node n has 2n and 2n + 1.
class Hierarchy {
public:
    /// `fresh` by triangle: whether it is to be compared with all, not only with those. `sound` by region, or empty.
    Hierarchy(std::span<const Vec3f> positions, std::span<const SimpleTriangle> triangles,
              std::span<const uint8_t> fresh, std::span<const uint8_t> sound, int threads)
        : positions_(positions), triangles_(triangles) {
        own_.resize(triangles.size());
        Box3f all;
        std::vector<Vec3f> centres(triangles.size());
        for (size_t i = 0; i < triangles.size(); ++i) {
            const Box3f box = boxOf(i);
            all = sgm::hull(all, box);
            centres[i] = box.centre();
        }
        const Vec3f size = all.size();
        const auto place = [&](Vec3f p, int axis) {
            const float share = size[axis] > 0 ? (p[axis] - all.lo[axis]) / size[axis] : 0;
            return spread(static_cast<uint32_t>(share * 1023));
        };
        std::vector<uint64_t> keys(triangles.size());
        for (size_t i = 0; i < keys.size(); ++i) {
            const Vec3f p = centres[i];
            keys[i] = static_cast<uint64_t>(place(p, 0) | place(p, 1) << 1 | place(p, 2) << 2) << 32 | i;
        }
        std::sort(keys.begin(), keys.end());
        order_.reserve(keys.size());
        for (const uint64_t key : keys) order_.push_back(static_cast<uint32_t>(key));
        leaves_ = std::bit_ceil(std::max<size_t>(1, (order_.size() + leafTriangles - 1) / leafTriangles));
        nodes_.resize(2 * leaves_);
        parallelFor(leaves_, threads, nullptr, [&](size_t leaf, int) {
            const auto [begin, end] = placesOf(leaves_ + leaf);
            for (size_t i = begin; i < end; ++i) {
                const uint32_t region = triangles_[order_[i]].region;
                const bool isSound = region < sound.size() && sound[region] != 0;
                own_[i] = {boxOf(order_[i]), fresh[order_[i]] != 0, isSound ? region : noRegion};
                nodes_[leaves_ + leaf] = hull(nodes_[leaves_ + leaf], own_[i]);
            }
        });
        for (size_t n = leaves_ - 1; n > 0; --n) nodes_[n] = hull(nodes_[2 * n], nodes_[2 * n + 1]);
    }

    using Pair = std::pair<uint32_t, uint32_t>;

    /// Appends what remains of comparing two nodes, or a node with itself, one level down; leaves are compared.
    template <class Found>
    void compare(Pair pair, std::vector<Pair>& open, Found&& found) const {
        const auto [a, b] = pair;
        if (nodes_[a].isSoundWith(nodes_[b])) return;
        if (a == b) {
            if (!nodes_[a].fresh || nodes_[a].box.empty()) return;
            if (a >= leaves_) return compareLeaves(a, b, found);
            open.insert(open.end(), {{2 * a, 2 * a}, {2 * a + 1, 2 * a + 1}, {2 * a, 2 * a + 1}});
            return;
        }
        if (!(nodes_[a].fresh || nodes_[b].fresh) || !nodes_[a].meets(nodes_[b])) return;
        if (a >= leaves_) return compareLeaves(a, b, found);
        for (const uint32_t i : {2 * a, 2 * a + 1})
            for (const uint32_t j : {2 * b, 2 * b + 1}) open.push_back({i, j});
    }

private:
    Vec3f corner(size_t triangle, int i) const { return positions_[triangles_[triangle].corners[i]]; }
    Box3f boxOf(size_t t) const {
        return sgm::hull(sgm::hull(Box3f{corner(t, 0), corner(t, 0)}, corner(t, 1)), corner(t, 2));
    }
    /// In order_: the first and the end.
    std::pair<size_t, size_t> placesOf(size_t leaf) const {
        const size_t begin = std::min(order_.size(), (leaf - leaves_) * leafTriangles);
        return {begin, std::min<size_t>(order_.size(), begin + leafTriangles)};
    }
    template <class Found>
    void compareLeaves(uint32_t a, uint32_t b, Found&& found) const {
        const auto [firstLeft, endLeft] = placesOf(a);
        const auto [firstRight, endRight] = placesOf(b);
        for (size_t i = firstLeft; i < endLeft; ++i) {
            if (!nodes_[b].meets(own_[i])) continue;
            for (size_t j = a == b ? i + 1 : firstRight; j < endRight; ++j) {
                if (!(own_[i].fresh || own_[j].fresh) || own_[i].isSoundWith(own_[j])) continue;
                if (!own_[i].meets(own_[j])) continue;
                const uint32_t s = order_[i], t = order_[j];
                if (meetWrongly(positions_, triangles_[s].corners, triangles_[t].corners)) found(s), found(t);
            }
        }
    }

    std::span<const Vec3f> positions_;
    std::span<const SimpleTriangle> triangles_;
    PageVector<Bounds> own_;  ///< of triangles, as order_
    std::vector<uint32_t> order_;
    size_t leaves_ = 0;
    std::vector<Bounds> nodes_;
};

/// Where an edge ends, and the triangle that it is a side of.
struct End {
    uint32_t vertex, triangle;
};

/// Triangles with an edge that runs the same way as another's, and those around a vertex at which several fans meet.
void findNonManifold(std::span<const Vec3f> positions, std::span<const SimpleTriangle> triangles,
                     std::vector<uint32_t>& faults) {
    PageVector<uint32_t> begin;
    begin.assign(positions.size() + 1, 0);
    for (const SimpleTriangle& t : triangles)
        for (int i = 0; i < 3; ++i) ++begin[t.corners[i] + 1];
    for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    PageVector<uint32_t> next(begin.begin(), begin.end() - 1);
    PageVector<End> ends;  // by start
    ends.resize(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = triangles[t].corners[i], b = triangles[t].corners[(i + 1) % 3];
            for (uint32_t k = begin[a]; k < next[a]; ++k)
                if (ends[k].vertex == b) faults.insert(faults.end(), {ends[k].triangle, t});
            ends[next[a]++] = {b, t};
        }
    for (uint32_t v = 0; v < positions.size(); ++v) {
        const std::span<const End> around(ends.data() + begin[v], begin[v + 1] - begin[v]);
        if (around.empty()) continue;
        // From triangle to triangle over the edges at v, back to the first.
        const auto thirdOf = [&](size_t i) {
            const Triangle& t = triangles[around[i].triangle].corners;
            return t.x == v ? t.z : t.y == v ? t.x : t.y;
        };
        size_t at = 0, seen = 0;
        do {
            const uint32_t third = thirdOf(at);
            at = static_cast<size_t>(
                std::find_if(around.begin(), around.end(), [&](const auto& e) { return e.vertex == third; }) -
                around.begin());
            ++seen;
        } while (at != 0 && at < around.size() && seen < around.size());
        if (at == 0 && seen == around.size()) continue;
        for (const End& end : around) faults.push_back(end.triangle);
    }
}

}  // namespace

/// Triangles that were not sound in the last surface, or not there.
std::vector<uint8_t> FaultFinder::findFresh(std::span<const SimpleTriangle> triangles) const {
    std::vector<uint8_t> fresh(triangles.size(), 1);
    if (isFirst_) return fresh;
    for (size_t t = 0; t < triangles.size(); ++t) {
        const Triangle& c = triangles[t].corners;
        const std::array<uint32_t, 2> others{c.y, c.z};
        const auto begin = sound_.begin() + soundBegin_[c.x], end = sound_.begin() + soundBegin_[c.x + 1];
        fresh[t] = std::find(begin, end, others) == end;
    }
    return fresh;
}

void FaultFinder::remember(std::span<const SimpleTriangle> triangles, std::span<const uint32_t> faults) {
    isFirst_ = false;
    soundBegin_.assign(positions_.size() + 1, 0);
    const auto forSound = [&](auto&& visit) {
        auto fault = faults.begin();
        for (uint32_t t = 0; t < triangles.size(); ++t) {
            if (fault != faults.end() && *fault == t)
                ++fault;
            else
                visit(triangles[t].corners);
        }
    };
    forSound([&](const Triangle& c) { ++soundBegin_[c.x + 1]; });
    for (size_t v = 1; v < soundBegin_.size(); ++v) soundBegin_[v] += soundBegin_[v - 1];
    sound_.resize(soundBegin_.back());
    std::vector<uint32_t> next(soundBegin_.begin(), soundBegin_.end() - 1);
    forSound([&](const Triangle& c) { sound_[next[c.x]++] = {c.y, c.z}; });
}

std::vector<uint32_t> FaultFinder::find(std::span<const SimpleTriangle> triangles,
                                        std::span<const uint8_t> soundRegions) {
    std::vector<uint32_t> faults;
    if (triangles.empty()) return faults;
    findNonManifold(positions_, triangles, faults);
    const Hierarchy hierarchy(positions_, triangles, findFresh(triangles), soundRegions, threads_);
    const auto note = [&faults](uint32_t t) { faults.push_back(t); };
    std::vector<Hierarchy::Pair> tasks{{1, 1}}, next;
    while (!tasks.empty() && tasks.size() < tasksPerThread * static_cast<size_t>(threadCount(threads_))) {
        next.clear();
        for (const Hierarchy::Pair& pair : tasks) hierarchy.compare(pair, next, note);
        tasks.swap(next);
    }
    std::mutex mutex;
    parallelFor(tasks.size(), threads_, progress_, [&](size_t i, int) {
        std::vector<uint32_t> found;
        std::vector<Hierarchy::Pair> open{tasks[i]};
        while (!open.empty()) {
            const Hierarchy::Pair pair = open.back();
            open.pop_back();
            hierarchy.compare(pair, open, [&found](uint32_t t) { found.push_back(t); });
        }
        if (found.empty()) return;
        const std::lock_guard lock(mutex);
        faults.insert(faults.end(), found.begin(), found.end());
    });
    std::sort(faults.begin(), faults.end());
    faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
    if (!faults.empty()) remember(triangles, faults);
    return faults;
}

}  // namespace sgm::mesh
