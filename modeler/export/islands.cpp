#include "modeler/export/islands.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include "modeler/core/random.h"
#include "modeler/export/surface.h"
#include "modeler/mesh/corners.h"

namespace sgm::exporter {
namespace {

using mesh::noIndex;
using Point = std::array<double, 2>;
using Corners = std::array<Point, 3>;

/// How far p lies to the left of the line from a to b.
double leftOf(const Point& a, const Point& b, const Point& p) {
    const double x = b[0] - a[0], y = b[1] - a[1], l = std::hypot(x, y);
    return l > 0 ? (x * (p[1] - a[1]) - y * (p[0] - a[0])) / l : 0;
}

/// Whether some edge of `a` has all of `b` on its right, to `slack`. Both run counter-clockwise.
bool separates(const Corners& a, const Corners& b, double slack) {
    for (size_t k = 0; k < 3; ++k) {
        double most = leftOf(a[k], a[(k + 1) % 3], b[0]);
        for (size_t j = 1; j < 3; ++j) most = std::max(most, leftOf(a[k], a[(k + 1) % 3], b[j]));
        if (most <= slack) return true;
    }
    return false;
}

bool overlap(const Corners& a, const Corners& b, double slack) {
    return !separates(a, b, slack) && !separates(b, a, slack);
}

/// The triangles of one island by the squares of a grid that they reach.
class Covered {
public:
    Covered(double square, double slack) : square_(square), slack_(slack) {}

    bool isFree(const Corners& t) {
        bool free = true;
        forSquares(t, [&](uint64_t key) {
            const auto found = squares_.find(key);
            if (found == squares_.end()) return;
            for (const uint32_t i : found->second) free = free && !overlap(all_[i], t, slack_);
        });
        return free;
    }
    void add(const Corners& t) {
        forSquares(t, [&](uint64_t key) { squares_[key].push_back(static_cast<uint32_t>(all_.size())); });
        all_.push_back(t);
    }

private:
    template <class Visit>
    void forSquares(const Corners& t, Visit visit) const {
        std::array<int64_t, 2> lo, hi;
        for (size_t k = 0; k < 2; ++k) {
            const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
            lo[k] = static_cast<int64_t>(std::floor(least / square_));
            hi[k] = static_cast<int64_t>(std::floor(most / square_));
        }
        for (int64_t x = lo[0]; x <= hi[0]; ++x)
            for (int64_t y = lo[1]; y <= hi[1]; ++y) visit(combine(static_cast<uint64_t>(x), static_cast<uint64_t>(y)));
    }

    double square_, slack_;
    std::vector<Corners> all_;
    std::unordered_map<uint64_t, std::vector<uint32_t>> squares_;
};

/// Grows islands from triangle to triangle across edges.
class Grower {
public:
    Grower(const mesh::Mesh& mesh, const TextureCharts& charts, const std::vector<uint32_t>& objects)
        : charts_(charts), objects_(objects), triangles_(mesh::gatherTriangles(mesh)), vertices_(mesh) {
        neighbours_ = mesh::findEdgeNeighbours(triangles_, mesh.vertexCount());
        slack_ = 1e-6 * static_cast<double>(maxComponent(mesh.bounds().size()));
        islands_.ofTriangle.assign(triangles_.size(), noIndex);
        reached_.resize(triangles_.size());
        setOf_.resize(triangles_.size(), 0);
        for (const mesh::Triangle& t : triangles_) {
            const Vec3d a = vertices_.position(t.x).as<double>();
            area_ +=
                length(cross(vertices_.position(t.y).as<double>() - a, vertices_.position(t.z).as<double>() - a)) / 2;
        }
    }

    Islands run(const Progress* progress) {
        for (uint32_t t = 0; t < triangles_.size() && !cancelled(progress); ++t)
            if (islands_.ofTriangle[t] == noIndex) grow(t);
        return std::move(islands_);
    }

private:
    Corners corners(uint32_t t) {
        Corners c;
        for (int k = 0; k < 3; ++k) {
            const auto [u, v] = charts_.at(charts_.ofTriangle[t], vertices_.position(triangles_[t][k]));
            c[static_cast<size_t>(k)] = {static_cast<double>(u), static_cast<double>(v)};
        }
        return c;
    }

    bool alike(uint32_t a, uint32_t b) const {
        return charts_.ofTriangle[a] == charts_.ofTriangle[b] && (objects_.empty() || objects_[a] == objects_[b]);
    }

    /// All that hangs together with `first` through triangles of its chart that aren't taken.
    std::vector<uint32_t> connected(uint32_t first) {
        std::vector<uint32_t> all{first};
        reached_[first] = true;
        for (size_t i = 0; i < all.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const uint32_t next = neighbours_[all[i]][k];
                if (next == noIndex || reached_[next] || islands_.ofTriangle[next] != noIndex || !alike(first, next))
                    continue;
                reached_[next] = true;
                all.push_back(next);
            }
        for (const uint32_t t : all) reached_[t] = false;
        return all;
    }

    /// Whether they lie in one plane of the chart, where a surface that doesn't cross itself can't cover itself.
    bool isFlat(std::span<const uint32_t> all) {
        const ChartAxes& axes = charts_.axes[charts_.ofTriangle[all[0]]];
        const Vec3f normal = cross(axes.u, axes.v);
        float lo = 0, hi = 0;
        const float level = dot(normal, vertices_.position(triangles_[all[0]].x));
        for (const uint32_t t : all)
            for (int k = 0; k < 3; ++k) {
                const float height = dot(normal, vertices_.position(triangles_[t][k])) - level;
                lo = std::min(lo, height), hi = std::max(hi, height);
            }
        return static_cast<double>(hi - lo) <= 100 * slack_;
    }

    /// Bounds on the chart, and how much of them is covered.
    struct Extent {
        Point lo{Box3d::limit(), Box3d::limit()}, hi{-Box3d::limit(), -Box3d::limit()};
        double area = 0;

        void add(const Corners& c) {
            for (const Point& p : c)
                for (size_t k = 0; k < 2; ++k) lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
            area += leftOf(c[0], c[1], c[2]) * std::hypot(c[1][0] - c[0][0], c[1][1] - c[0][1]) / 2;
        }
        double box() const { return (hi[0] - lo[0]) * (hi[1] - lo[1]); }
    };

    /// Whether a rectangle about it would be mostly empty, and large enough to matter.
    bool wastes(const Extent& extent) const {
        constexpr double leastCover = 0.4, leastBox = 1e-3;  // of the rectangle; of the whole mesh's area
        return extent.area < leastCover * extent.box() && extent.box() > leastBox * area_;
    }

    Extent extentOf(std::span<const uint32_t> all) {
        Extent extent;
        for (const uint32_t t : all) extent.add(corners(t));
        return extent;
    }

    /// Of frames and other shapes that would leave most of their rectangle empty, as much as wouldn't, grown from the
    /// first triangle on.
    std::vector<uint32_t> compact(const std::vector<uint32_t>& all) {
        if (!wastes(extentOf(all))) return all;
        ++sets_;
        for (const uint32_t t : all) setOf_[t] = sets_;
        std::vector<uint32_t> part{all[0]}, border{all[0]};
        Extent extent = extentOf(part);
        setOf_[all[0]] = 0;
        for (bool grew = true; grew;) {
            grew = false;
            std::vector<uint32_t> left;  // those beside which something still is
            for (size_t i = 0; i < border.size(); ++i) {
                bool done = true;
                for (int k = 0; k < 3; ++k) {
                    const uint32_t next = neighbours_[border[i]][k];
                    if (next == noIndex || setOf_[next] != sets_) continue;
                    Extent with = extent;
                    with.add(corners(next));
                    if (wastes(with)) {
                        done = false;
                        continue;
                    }
                    extent = with;
                    setOf_[next] = 0;
                    part.push_back(next);
                    border.push_back(next);
                    grew = true;
                }
                if (!done) left.push_back(border[i]);
            }
            border = std::move(left);
        }
        return part;
    }

    void grow(uint32_t first) {
        const auto island = static_cast<uint32_t>(islands_.all.size());
        std::vector<uint32_t> all = connected(first);
        if (!isFlat(all)) all = withoutOverlap(all);
        all = compact(all);
        for (const uint32_t t : all) islands_.ofTriangle[t] = island;
        const Extent extent = extentOf(all);
        const auto bound = [](const Point& p) {
            return std::array<float, 2>{static_cast<float>(p[0]), static_cast<float>(p[1])};
        };
        islands_.all.push_back(
            {charts_.ofTriangle[first], objects_.empty() ? 0 : objects_[first], bound(extent.lo), bound(extent.hi)});
    }

    /// About the size of a triangle, but at most some hundred squares along the whole.
    double squareFor(const std::vector<uint32_t>& all) {
        constexpr double most = 512;
        double sizes = 0, lo[2] = {}, hi[2] = {};
        for (const uint32_t t : all) {
            const Corners c = corners(t);
            for (size_t k = 0; k < 2; ++k) {
                const auto [least, greatest] = std::minmax({c[0][k], c[1][k], c[2][k]});
                sizes += greatest - least;
                lo[k] = t == all[0] ? least : std::min(lo[k], least);
                hi[k] = t == all[0] ? greatest : std::max(hi[k], greatest);
            }
        }
        const double extent = std::max(hi[0] - lo[0], hi[1] - lo[1]);
        return std::max({sizes / static_cast<double>(2 * all.size()), extent / most, 10 * slack_});
    }

    /// Those that can be laid beside each other, from the first one on across edges.
    std::vector<uint32_t> withoutOverlap(const std::vector<uint32_t>& all) {
        Covered covered(squareFor(all), slack_);
        std::vector<uint32_t> laid{all[0]};
        covered.add(corners(all[0]));
        reached_[all[0]] = true;
        std::vector<uint32_t> refused;
        for (size_t i = 0; i < laid.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const uint32_t next = neighbours_[laid[i]][k];
                if (next == noIndex || reached_[next] || islands_.ofTriangle[next] != noIndex || !alike(all[0], next))
                    continue;
                reached_[next] = true;
                const Corners c = corners(next);
                if (covered.isFree(c))
                    covered.add(c), laid.push_back(next);
                else
                    refused.push_back(next);
            }
        for (const auto* list : {&laid, &refused})
            for (const uint32_t t : *list) reached_[t] = false;
        return laid;
    }

    const TextureCharts& charts_;
    const std::vector<uint32_t>& objects_;
    std::vector<mesh::Triangle> triangles_, neighbours_;
    Vertices vertices_;
    double slack_, area_ = 0;
    std::vector<bool> reached_;
    std::vector<uint32_t> setOf_;  ///< by triangle: the last set it was in and not taken out of
    uint32_t sets_ = 0;
    Islands islands_;
};

}  // namespace

Islands findIslands(const mesh::Mesh& mesh, const TextureCharts& charts, const std::vector<uint32_t>& objects,
                    const Progress* progress) {
    return Grower(mesh, charts, objects).run(progress);
}

}  // namespace sgm::exporter
