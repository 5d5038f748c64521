#include "modeler/tiles/level_regions.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "modeler/mesh/corners.h"
#include "modeler/mesh/polyline.h"
#include "modeler/mesh/triangulate.h"

namespace sgm::tiles {
namespace {

using mesh::DirectedEdge;
using mesh::noIndex;
using mesh::Triangle;

/// Which triangles are level, and the regions of one key and height that look the same way.
class Regions {
public:
    Regions(const KeyedTriangles& ground, std::span<const Vec3f> positions, double rounding_m)
        : ground_(ground), positions_(positions), rounding_m_(rounding_m) {
        neighbours_ = mesh::findEdgeNeighbours(ground.triangles, positions.size());
        of_.assign(ground.triangles.size(), noIndex);
        for (uint32_t t = 0; t < of_.size(); ++t)
            if (of_[t] == noIndex && isLevel(t, heightOf(t))) fill(t);
    }
    size_t count() const { return up_.size(); }
    bool looksUp(uint32_t region) const { return up_[region]; }
    /// By triangle, its region or noIndex.
    uint32_t at(size_t triangle) const { return of_[triangle]; }
    /// The region across an edge of a triangle, or noIndex where none is.
    uint32_t across(size_t triangle, int edge) const {
        const uint32_t t = neighbours_[triangle][edge];
        return t == noIndex ? noIndex : of_[t];
    }

private:
    float heightOf(uint32_t t) const { return positions_[ground_.triangles[t].x].y; }
    bool isLevel(uint32_t t, float height) const {
        for (int k = 0; k < 3; ++k)
            if (std::abs(double{positions_[ground_.triangles[t][k]].y} - height) > rounding_m_) return false;
        return true;
    }
    bool looksUpAt(uint32_t t) const {
        const Triangle& c = ground_.triangles[t];
        const Vec3d a = positions_[c.x].as<double>(), b = positions_[c.y].as<double>() - a,
                    d = positions_[c.z].as<double>() - a;
        return b.z * d.x - b.x * d.z >= 0;
    }
    void fill(uint32_t first) {
        const auto region = static_cast<uint32_t>(up_.size());
        const float height = heightOf(first);
        up_.push_back(looksUpAt(first));
        of_[first] = region;
        open_ = {first};
        while (!open_.empty()) {
            const uint32_t t = open_.back();
            open_.pop_back();
            for (int k = 0; k < 3; ++k) {
                const uint32_t u = neighbours_[t][k];
                if (u == noIndex || of_[u] != noIndex || ground_.keys[u] != ground_.keys[t] || !isLevel(u, height) ||
                    looksUpAt(u) != up_[region])
                    continue;
                of_[u] = region;
                open_.push_back(u);
            }
        }
    }

    const KeyedTriangles& ground_;
    const std::span<const Vec3f> positions_;
    const double rounding_m_;
    std::vector<Triangle> neighbours_;
    std::vector<uint32_t> of_, open_;
    std::vector<bool> up_;
};

/// The borders of all regions, as edges that run around them, and which of their vertices are kept.
class Borders {
public:
    Borders(const KeyedTriangles& ground, std::span<const Vec3f> positions, const Regions& regions)
        : positions_(positions) {
        firstEdge_.assign(regions.count() + 1, 0);
        for (size_t t = 0; t < ground.triangles.size(); ++t)
            if (const uint32_t region = regions.at(t); region != noIndex)
                for (int k = 0; k < 3; ++k)
                    if (regions.across(t, k) != region) ++firstEdge_[region + 1];
        for (size_t r = 0; r < regions.count(); ++r) firstEdge_[r + 1] += firstEdge_[r];
        edges_.resize(firstEdge_.back());
        std::vector<uint32_t> next(firstEdge_.begin(), firstEdge_.end() - 1), leaving(positions.size(), 0);
        keep_.assign(positions.size(), false);
        from_.assign(positions.size(), {noIndex, noIndex});
        for (size_t t = 0; t < ground.triangles.size(); ++t) {
            const uint32_t region = regions.at(t);
            for (int k = 0; k < 3; ++k) {
                const uint32_t a = ground.triangles[t][k], b = ground.triangles[t][(k + 1) % 3];
                const uint32_t other = regions.across(t, k);
                if (region == noIndex) keep_[a] = true;
                if (region == noIndex || other == region) continue;
                if (other == noIndex) keep_[a] = keep_[b] = true;
                if (leaving[a] < 2) from_[a][leaving[a]] = next[region];
                ++leaving[a];
                edges_[next[region]++] = {a, b, other};
            }
        }
        for (uint32_t v = 0; v < keep_.size(); ++v) keep_[v] = keep_[v] || leaving[v] != 2;
    }

    /// Drops the vertices that lie straight between others.
    void straighten(double tolerance_m) {
        const std::vector<bool> fixed = keep_;
        std::vector<bool> seen = keep_;
        for (uint32_t e = 0; e < edges_.size(); ++e)
            if (fixed[edges_[e].from] && !fixed[edges_[e].to]) straightenChain(e, fixed, seen, tolerance_m);
        for (uint32_t v = 0; v < seen.size(); ++v)
            if (!seen[v] && from_[v][0] != noIndex) straightenLoop(v, fixed, seen, tolerance_m);
    }

    /// The border of a region without the vertices that are dropped.
    void findBoundary(uint32_t region, std::vector<DirectedEdge>& boundary) const {
        boundary.clear();
        for (uint32_t e = firstEdge_[region]; e < firstEdge_[region + 1]; ++e)
            if (keep_[edges_[e].from]) {
                uint32_t last = e;
                while (!keep_[edges_[last].to]) last = after(last);
                boundary.push_back({edges_[e].from, edges_[last].to});
            }
    }

    /// Takes back what a region's border has lost, and appends the regions beside it that lost it too. Whether there
    /// was something.
    bool restore(uint32_t region, std::vector<uint32_t>& beside) {
        bool lost = false;
        for (uint32_t e = firstEdge_[region]; e < firstEdge_[region + 1]; ++e) {
            if (keep_[edges_[e].from]) continue;
            lost = true;
            keep_[edges_[e].from] = true;
            beside.push_back(edges_[e].other);
        }
        return lost;
    }

private:
    struct Edge {
        uint32_t from, to, other;  ///< vertices, and the region on the right
    };

    /// The edge that follows another at a vertex with one on each side.
    uint32_t after(uint32_t edge) const {
        const auto& [a, b] = from_[edges_[edge].to];
        return edges_[a].other == edges_[edge].other ? a : b;
    }

    auto placeOf(uint32_t v) const {
        const Vec3f& p = positions_[v];
        return std::tuple(p.x, p.z, p.y);
    }

    /// Vertices along a border from an edge on to one that is fixed or the first.
    void gather(uint32_t edge, const std::vector<bool>& fixed) {
        chain_ = {edges_[edge].from};
        const uint32_t first = edges_[edge].from;
        for (;; edge = after(edge)) {
            chain_.push_back(edges_[edge].to);
            if (fixed[chain_.back()] || chain_.back() == first) return;
        }
    }

    /// A chain is straightened once, in a direction that doesn't hang on numbers.
    void straightenChain(uint32_t edge, const std::vector<bool>& fixed, std::vector<bool>& seen, double tolerance_m) {
        if (seen[edges_[edge].to]) return;
        gather(edge, fixed);
        if (placeOf(chain_.back()) < placeOf(chain_.front())) std::reverse(chain_.begin(), chain_.end());
        for (const uint32_t v : chain_) seen[v] = true;
        keepWhatBends(tolerance_m);
    }

    /// A border that no other meets.
    void straightenLoop(uint32_t vertex, const std::vector<bool>& fixed, std::vector<bool>& seen, double tolerance_m) {
        gather(from_[vertex][0], fixed);
        chain_.pop_back();
        std::rotate(chain_.begin(),
                    std::min_element(chain_.begin(), chain_.end(),
                                     [&](uint32_t a, uint32_t b) { return placeOf(a) < placeOf(b); }),
                    chain_.end());
        if (placeOf(chain_.back()) < placeOf(chain_[1])) std::reverse(chain_.begin() + 1, chain_.end());
        for (const uint32_t v : chain_) seen[v] = true;
        chain_.push_back(chain_.front());
        keepWhatBends(tolerance_m);
    }

    void keepWhatBends(double tolerance_m) {
        std::vector<Vec3f> points;
        for (const uint32_t v : chain_) points.push_back(positions_[v]);
        std::vector<bool> keep(chain_.size(), false);
        mesh::simplifyPolyline(points, false, tolerance_m, keep);
        for (size_t i = 0; i < chain_.size(); ++i)
            if (keep[i]) keep_[chain_[i]] = true;
    }

    const std::span<const Vec3f> positions_;
    std::vector<uint32_t> firstEdge_;            ///< by region
    std::vector<Edge> edges_;                    ///< by region
    std::vector<std::array<uint32_t, 2>> from_;  ///< by vertex, the first two edges that leave it
    std::vector<bool> keep_;                     ///< by vertex
    std::vector<uint32_t> chain_;
};

}  // namespace

KeyedTriangles mergeLevelRegions(const KeyedTriangles& ground, std::span<const Vec3f> positions, double rounding_m,
                                 double tolerance_m) {
    const Regions regions(ground, positions, rounding_m);
    Borders borders(ground, positions, regions);
    borders.straighten(tolerance_m);
    std::vector<std::vector<Triangle>> made(regions.count());
    std::vector<bool> stays(regions.count(), false);
    std::vector<uint32_t> open(regions.count()), again;
    for (uint32_t r = 0; r < open.size(); ++r) open[r] = r;
    std::vector<DirectedEdge> boundary;
    while (!open.empty()) {
        again.clear();
        for (const uint32_t r : open) {
            if (stays[r]) continue;
            made[r].clear();
            borders.findBoundary(r, boundary);
            if (mesh::triangulatePlanar(boundary, positions, {0, regions.looksUp(r) ? 1.0 : -1.0, 0}, made[r]))
                continue;
            if (borders.restore(r, again))
                again.push_back(r);
            else
                stays[r] = true;
        }
        std::sort(again.begin(), again.end());
        again.erase(std::unique(again.begin(), again.end()), again.end());
        open = again;
    }
    KeyedTriangles out;
    std::vector<uint32_t> keys(regions.count());
    for (size_t t = 0; t < ground.triangles.size(); ++t) {
        const uint32_t region = regions.at(t);
        if (region != noIndex) keys[region] = ground.keys[t];
        if (region != noIndex && !stays[region]) continue;
        out.triangles.push_back(ground.triangles[t]);
        out.keys.push_back(ground.keys[t]);
    }
    for (size_t r = 0; r < made.size(); ++r)
        if (!stays[r]) {
            out.triangles.insert(out.triangles.end(), made[r].begin(), made[r].end());
            out.keys.insert(out.keys.end(), made[r].size(), keys[r]);
        }
    return out;
}

}  // namespace sgm::tiles
