#include "modeler/mesh/planar_split.h"

#include <algorithm>
#include <array>
#include <span>

#include "modeler/core/parallel.h"
#include "modeler/mesh/polyline.h"
#include "modeler/mesh/triangulate.h"

namespace sgm::mesh {
namespace {

constexpr size_t leastTriangles = 32;  ///< of a region that is worth it
constexpr size_t mostBumps = 8;        ///< one in so many triangles may be a bump's
constexpr double leastFlat = 0.98;     ///< area of the region's shadow on its plane over its area
constexpr double leastHeight = 1e-5;   ///< of a triangle in the plane, over its longest side
constexpr size_t mostSamples = 1024;   ///< triangles that a median is of
/// Of the bound, in turn: vertices this near to the plane so far decide where it is.
constexpr double nearness[] = {16, 2};

class Separation {
public:
    Separation(const FlatMesh& mesh, double bound_m, SurfaceRegions& regions, std::vector<Plane>& planes)
        : mesh_(mesh), bound_(bound_m), regions_(regions), planes_(planes), before_(regions.count()) {}

    std::vector<uint32_t> run() {
        listTriangles();
        for (uint32_t r = 0; r < before_; ++r) {
            const std::span<const uint32_t> triangles(list_.data() + begin_[r], begin_[r + 1] - begin_[r]);
            if (triangles.size() < leastTriangles || !findPlane(triangles)) continue;
            planes_[r] = plane_;
            found_.push_back(r);
            if (!bumps_.empty()) separate(r);
        }
        if (edges_.empty()) return std::move(found_);
        std::sort(edges_.begin(), edges_.end());
        splitBorders();
        numberBorderVertices();
        return std::move(found_);
    }

private:
    /// A side of a bump's triangle.
    struct Edge {
        uint32_t a, b, region, from;  ///< its region, and the one that it was part of
        friend bool operator<(const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
    };

    /// Triangles of curved regions, by region.
    void listTriangles() {
        begin_.assign(before_ + 1, 0);
        const auto forCurved = [&](auto&& visit) {
            for (uint32_t t = 0; t < regions_.ofTriangle.size(); ++t)
                if (!planes_[regions_.ofTriangle[t]].planar()) visit(t, regions_.ofTriangle[t]);
        };
        forCurved([&](uint32_t, uint32_t r) { ++begin_[r + 1]; });
        for (size_t r = 1; r < begin_.size(); ++r) begin_[r] += begin_[r - 1];
        list_.resize(begin_.back());
        std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
        forCurved([&](uint32_t t, uint32_t r) { list_[next[r]++] = t; });
    }

    Vec3d at(uint32_t v) const { return mesh_.positions[v].as<double>() - origin_; }
    double height(uint32_t v) const { return dot(plane_.normal, at(v)) - plane_.offset; }
    double farthest(const Triangle& t) const {
        return std::max({std::abs(height(t.x)), std::abs(height(t.y)), std::abs(height(t.z))});
    }
    Vec3d across(const Triangle& t) const {
        const Vec3d p = at(t.x);
        return cross(at(t.y) - p, at(t.z) - p);
    }

    /// The median of what some of the triangles have, which a few bumps don't move.
    template <class Value>
    double medianOf(std::span<const uint32_t> triangles, Value&& valueOf) {
        values_.clear();
        const size_t step = 1 + triangles.size() / mostSamples;
        for (size_t i = 0; i < triangles.size(); i += step) values_.push_back(valueOf(mesh_.triangles[triangles[i]]));
        const auto middle = values_.begin() + static_cast<ptrdiff_t>(values_.size() / 2);
        std::nth_element(values_.begin(), middle, values_.end());
        return *middle;
    }

    /// Whether a triangle's shadow on the plane is a needle or on its back: the border could touch itself there.
    bool isFlattened(const Triangle& t) const {
        const Vec3d a = at(t.x), b = at(t.y), c = at(t.z);
        const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
        return !(dot(across(t), plane_.normal) > leastHeight * longest);
    }

    /// The plane of most of a region, and the triangles that aren't in it; false where these are too many.
    bool findPlane(std::span<const uint32_t> triangles) {
        origin_ = mesh_.positions[mesh_.triangles[triangles[0]].x].as<double>();
        Vec3d sum;
        double area = 0;
        for (const uint32_t t : triangles) {
            const Vec3d n = across(mesh_.triangles[t]);
            sum += n, area += length(n);
        }
        if (!(length(sum) > leastFlat * area)) return false;
        for (int axis = 0; axis < 3; ++axis)
            plane_.normal[axis] = medianOf(triangles, [&](const Triangle& t) { return normalized(across(t))[axis]; });
        plane_ = {normalized(plane_.normal), 0};
        plane_.offset = medianOf(triangles, [&](const Triangle& t) { return height(t.x); });
        for (const double share : nearness) settle(triangles, share * bound_);
        bumps_.clear();
        for (const uint32_t t : triangles) {
            const Triangle& c = mesh_.triangles[t];
            if (farthest(c) > bound_ || isFlattened(c)) bumps_.push_back(t);
            if (mostBumps * bumps_.size() > triangles.size()) return false;
        }
        plane_.offset += dot(plane_.normal, origin_);
        return true;
    }

    /// The plane amid what is near to it; where that isn't in one plane, the plane of most of the region.
    void settle(std::span<const uint32_t> triangles, double near) {
        Vec3d sum;
        for (const uint32_t t : triangles)
            if (farthest(mesh_.triangles[t]) <= near) sum += across(mesh_.triangles[t]);
        Plane settled{normalized(sum), 0};
        double low = Box3d::limit(), high = -Box3d::limit();
        for (const uint32_t t : triangles) {
            if (farthest(mesh_.triangles[t]) > near) continue;
            const double h = dot(settled.normal, at(mesh_.triangles[t].x));
            low = std::min(low, h), high = std::max(high, h);
        }
        if (!settled.planar()) return;
        plane_ = settled;
        plane_.offset = high - low <= 2 * bound_
                            ? (low + high) / 2
                            : medianOf(triangles, [&](const Triangle& t) { return dot(settled.normal, at(t.x)); });
    }

    void separate(uint32_t from) {
        const auto region = static_cast<uint32_t>(regions_.keys.size());
        const uint64_t key = regions_.keys[from];
        regions_.keys.push_back(key);
        planes_.emplace_back();
        for (const uint32_t t : bumps_) {
            const Triangle& c = mesh_.triangles[t];
            regions_.ofTriangle[t] = region;
            for (int i = 0; i < 3; ++i) {
                edges_.push_back({c[i], c[(i + 1) % 3], region, from});
                if (!SurfaceRegions::isBorder(regions_.ofVertex[c[i]])) regions_.ofVertex[c[i]] = region;
            }
        }
    }

    Edge* find(uint32_t a, uint32_t b, uint32_t from) {
        const auto at = std::lower_bound(edges_.begin(), edges_.end(), Edge{a, b, 0, 0});
        return at != edges_.end() && at->a == a && at->b == b && at->from == from ? &*at : nullptr;
    }

    /// Borders of the regions as they were go to the bumps where those are; new ones run between both.
    void splitBorders() {
        std::vector<uint8_t> isOld(edges_.size());
        const auto split = [&](uint32_t& region, uint32_t a, uint32_t b) {
            if (region >= before_ || begin_[region + 1] == begin_[region]) return;
            if (Edge* const edge = find(a, b, region)) {
                region = edge->region;
                isOld[static_cast<size_t>(edge - edges_.data())] = 1;
            }
        };
        for (BorderEdge& e : regions_.borders) split(e.left, e.a, e.b), split(e.right, e.b, e.a);
        for (size_t i = 0; i < edges_.size(); ++i) {
            const Edge& e = edges_[i];
            if (isOld[i] || find(e.b, e.a, e.from)) continue;
            regions_.borders.push_back({e.a, e.b, e.region, e.from});
            for (const uint32_t v : {e.a, e.b})
                if (!SurfaceRegions::isBorder(regions_.ofVertex[v])) added_.push_back(v);
        }
    }

    void numberBorderVertices() {
        std::sort(added_.begin(), added_.end());
        added_.erase(std::unique(added_.begin(), added_.end()), added_.end());
        std::vector<uint32_t> all(regions_.borderVertices.size() + added_.size());
        std::merge(regions_.borderVertices.begin(), regions_.borderVertices.end(), added_.begin(), added_.end(),
                   all.begin());
        for (uint32_t i = 0; i < all.size(); ++i) regions_.ofVertex[all[i]] = SurfaceRegions::borderBit | i;
        regions_.borderVertices = std::move(all);
    }

    const FlatMesh& mesh_;
    const double bound_;
    SurfaceRegions& regions_;
    std::vector<Plane>& planes_;
    const size_t before_;  ///< regions that there were
    std::vector<uint32_t> begin_;
    PageVector<uint32_t> list_;
    Vec3d origin_;  ///< near the region in work, so that products of positions don't cancel
    Plane plane_;   ///< of the region in work, from origin_
    std::vector<double> values_;
    std::vector<uint32_t> bumps_, added_, found_;
    std::vector<Edge> edges_;
};

}  // namespace

std::vector<uint32_t> separateBumps(const FlatMesh& mesh, double bound_m, SurfaceRegions& regions,
                                    std::vector<Plane>& planes) {
    return Separation(mesh, bound_m, regions, planes).run();
}

void rejectTouching(const FlatMesh& mesh, const Chains& chains, std::span<const uint32_t> regions, double chain_m,
                    std::vector<Plane>& planes, int threads) {
    const auto touches = [&](uint32_t region, double bound_m) {
        std::vector<DirectedEdge> boundary;
        std::vector<Vec3f> points;
        std::vector<bool> keep;
        for (const uint32_t c : chains.around(region)) {
            const Chain& chain = chains.chains[c];
            const std::span<const uint32_t> vertices(chains.vertices.data() + chain.begin, chain.end - chain.begin);
            points.clear();
            for (const uint32_t v : vertices) points.push_back(mesh.positions[v]);
            keep.assign(points.size(), bound_m == 0);
            if (bound_m > 0) simplifyPolyline(points, chain.closed, bound_m, keep);
            const auto add = [&](uint32_t a, uint32_t b) {
                boundary.push_back(chain.left == region ? DirectedEdge{a, b} : DirectedEdge{b, a});
            };
            uint32_t before = Chains::none, first = Chains::none;
            for (size_t i = 0; i < keep.size(); ++i) {
                if (!keep[i]) continue;
                if (before != Chains::none) add(before, vertices[i]);
                if (first == Chains::none) first = vertices[i];
                before = vertices[i];
            }
            if (chain.closed) add(before, first);
        }
        std::vector<Triangle> triangles;
        return !triangulatePlanar(boundary, mesh.positions, planes[region].normal, triangles);
    };
    parallelFor(regions.size(), threads, nullptr, [&](size_t i, int) {
        if ((chain_m == 0 || touches(regions[i], chain_m)) && touches(regions[i], 0)) planes[regions[i]] = {};
    });
}

}  // namespace sgm::mesh
