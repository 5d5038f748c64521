#include "modeler/mesh/distances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

#include "modeler/mesh/point_triangle.h"
#include "modeler/mesh/read.h"

namespace sgm::mesh {
namespace {

constexpr uint32_t nobody = std::numeric_limits<uint32_t>::max();
/// Cells around the mesh. Not whole, so that walls along the axes lie between nodes.
constexpr float margin = 2.37f;

/// A triangle in the frame of the grid: cells from the first node. Its corners lie together, for sweeps ask for
/// triangles in no order.
using Corners = std::array<Vec3f, 3>;

TriangleSoup soupOf(const Mesh& mesh) {
    TriangleSoup soup;
    for (const Chunk& c : mesh.chunks) {
        for (const Vec3f& p : c.positions) soup.positions.push_back(p.as<double>());
        for (const Triangle& t : c.triangles) soup.triangles.push_back(c.inMesh(t));
    }
    return soup;
}

/// Makes vertices at the same place one.
void weld(TriangleSoup& soup) {
    struct Corner {
        Vec3d p;
        uint32_t vertex;
    };
    std::vector<Corner> order;
    order.reserve(soup.positions.size());
    for (const Vec3d& p : soup.positions) order.push_back({p, static_cast<uint32_t>(order.size())});
    const auto key = [](const Corner& c) { return std::tie(c.p.x, c.p.y, c.p.z); };
    std::sort(order.begin(), order.end(), [&](const Corner& a, const Corner& b) {
        return key(a) != key(b) ? key(a) < key(b) : a.vertex < b.vertex;
    });
    std::vector<uint32_t> first(order.size());
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i].vertex] =
            i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1].vertex] : order[i].vertex;
    for (Triangle& t : soup.triangles) t = {first[t.x], first[t.y], first[t.z]};
}

/// The middle of an edge that isn't run through as often one way as the other.
std::optional<Vec3d> hole(const TriangleSoup& soup) {
    std::vector<std::array<uint32_t, 3>> edges;  // lower vertex, higher vertex, 1 when run downward
    edges.reserve(3 * soup.triangles.size());
    for (const Triangle& t : soup.triangles)
        for (int i = 0; i < 3; ++i)
            if (const uint32_t a = t[i], b = t[(i + 1) % 3]; a != b)
                edges.push_back({std::min(a, b), std::max(a, b), a > b});
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size();) {
        int64_t balance = 0;
        const auto [a, b, unused] = edges[i];
        for (; i < edges.size() && edges[i][0] == a && edges[i][1] == b; ++i) balance += edges[i][2] ? 1 : -1;
        if (balance != 0) return (soup.positions[a] + soup.positions[b]) * 0.5;
    }
    return {};
}

/// Distances in cells on a grid of nodes; positions are in cells from the first node.
class Nodes {
public:
    Nodes(std::vector<Corners> triangles, Vec3i count, const Progress* progress)
        : triangles_(std::move(triangles)),
          count_(count),
          progress_(progress),
          squared_(size(), std::numeric_limits<float>::infinity()),
          nearest_(size(), nobody) {}

    Result<std::vector<float>> signedDistances() {
        for (uint32_t t = 0; t < triangles_.size(); ++t) {
            if (t % 8 == 0 && cancelled(progress_)) return cancelledError();
            seed(t, triangles_[t]);
            if (offers_ > mostOffers())
                return Error{Error::Kind::Budget, "has too many large triangles, one over the other: simplify it"};
        }
        for (int way = 0; way < 8; ++way) {
            if (cancelled(progress_)) return cancelledError();
            sweep(way);
        }
        const std::vector<int> windings = this->windings();
        if (cancelled(progress_)) return cancelledError();
        std::vector<float> distances(size());
        for (size_t i = 0; i < size(); ++i) distances[i] = (windings[i] != 0 ? -1.0f : 1.0f) * std::sqrt(squared_[i]);
        return distances;
    }

private:
    /// Small triangles are offered to few nodes each; large ones cover the box three hundred times before this is
    /// spent.
    uint64_t mostOffers() const { return 500'000'000 + 200 * uint64_t{triangles_.size()}; }

    size_t size() const {
        return static_cast<size_t>(count_.x) * static_cast<size_t>(count_.y) * static_cast<size_t>(count_.z);
    }
    size_t at(int i, int j, int k) const {
        return (static_cast<size_t>(k) * static_cast<size_t>(count_.y) + static_cast<size_t>(j)) *
                   static_cast<size_t>(count_.x) +
               static_cast<size_t>(i);
    }

    void offer(int i, int j, int k, uint32_t triangle) {
        const size_t node = at(i, j, k);
        if (nearest_[node] == triangle) return;
        const Corners& c = triangles_[triangle];
        const Vec3f p = Vec3i{i, j, k}.as<float>();
        // Most triangles are farther away than the nearest one so far by their boxes alone; rounding is well below the
        // margin.
        constexpr float slack = 1.0001f;
        const Vec3f off = max(max(min(min(c[0], c[1]), c[2]) - p, p - max(max(c[0], c[1]), c[2])), Vec3f{});
        if (dot(off, off) > squared_[node] * slack) return;
        const float d = squaredDistance(p, c[0], c[1], c[2]);
        if (d < squared_[node]) squared_[node] = d, nearest_[node] = triangle;
    }

    /// Offers a triangle to the nodes around it; a long one piece by piece, so that it isn't offered to its whole box.
    void seed(uint32_t triangle, const Corners& c) {
        constexpr float longest = 8;
        const Vec3f lo = min(min(c[0], c[1]), c[2]), hi = max(max(c[0], c[1]), c[2]);
        if (maxComponent(hi - lo) > longest) {
            const Vec3f ab = (c[0] + c[1]) * 0.5f, bc = (c[1] + c[2]) * 0.5f, ca = (c[2] + c[0]) * 0.5f;
            for (const Corners& piece :
                 {Corners{c[0], ab, ca}, Corners{ab, c[1], bc}, Corners{ca, bc, c[2]}, Corners{ab, bc, ca}})
                seed(triangle, piece);
            return;
        }
        const auto nodes = [&](int axis) {
            return std::pair(std::max(static_cast<int>(lo[axis]) - 1, 0),
                             std::min(static_cast<int>(hi[axis]) + 2, count_[axis] - 1));
        };
        const auto [x0, x1] = nodes(0);
        const auto [y0, y1] = nodes(1);
        const auto [z0, z1] = nodes(2);
        for (int k = z0; k <= z1; ++k)
            for (int j = y0; j <= y1; ++j)
                for (int i = x0; i <= x1; ++i) offer(i, j, k, triangle);
        offers_ += static_cast<uint64_t>((x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1));
    }

    /// Hands nearest triangles on, from the corner of the grid that `way` names to the opposite one.
    void sweep(int way) {
        const Vec3i step{way & 1 ? -1 : 1, way & 2 ? -1 : 1, way & 4 ? -1 : 1};
        const auto first = [&](int axis) { return step[axis] > 0 ? 1 : count_[axis] - 2; };
        const auto end = [&](int axis) { return step[axis] > 0 ? count_[axis] : -1; };
        for (int k = first(2); k != end(2) && !cancelled(progress_); k += step.z)
            for (int j = first(1); j != end(1); j += step.y)
                for (int i = first(0); i != end(0); i += step.x)
                    for (int from = 1; from < 8; ++from) {
                        const size_t before =
                            at(from & 1 ? i - step.x : i, from & 2 ? j - step.y : j, from & 4 ? k - step.z : k);
                        if (nearest_[before] != nobody) offer(i, j, k, nearest_[before]);
                    }
    }

    /// How often the mesh winds around each node: crossings along the row before it, each counted with its sense.
    std::vector<int> windings() const {
        std::vector<int> result(size(), 0);
        for (uint32_t t = 0; t < triangles_.size(); ++t) {
            if (t % 1024 == 0 && cancelled(progress_)) break;
            cross(triangles_[t], result);
        }
        for (int k = 0; k < count_.z; ++k)
            for (int j = 0; j < count_.y; ++j)
                for (int i = 1; i < count_.x; ++i) result[at(i, j, k)] += result[at(i - 1, j, k)];
        return result;
    }

    /// Enters the rows along x that cross a triangle, at the first node behind it.
    void cross(const Corners& c, std::vector<int>& result) const {
        const Vec3f lo = min(min(c[0], c[1]), c[2]), hi = max(max(c[0], c[1]), c[2]);
        for (int k = std::max(static_cast<int>(lo.z), 0); k <= std::min(static_cast<int>(hi.z) + 1, count_.z - 1); ++k)
            for (int j = std::max(static_cast<int>(lo.y), 0); j <= std::min(static_cast<int>(hi.y) + 1, count_.y - 1);
                 ++j) {
                const double s0 = side(c[1], c[2], j, k), s1 = side(c[2], c[0], j, k), s2 = side(c[0], c[1], j, k);
                const bool positive = s0 > 0;
                if ((s1 > 0) != positive || (s2 > 0) != positive) continue;
                const double x = (s0 * c[0].x + s1 * c[1].x + s2 * c[2].x) / (s0 + s1 + s2);
                const int behind = std::clamp(static_cast<int>(std::ceil(x)), 0, count_.x - 1);
                result[at(behind, j, k)] += positive ? -1 : 1;
            }
    }

    /// Twice the area that row (j, k) spans with an edge, seen along x. Never 0, and the opposite when the edge is run
    /// the other way: of two triangles at an edge, a row meets one.
    static double side(Vec3f a, Vec3f b, int j, int k) {
        const bool swapped = std::tie(b.y, b.z, b.x) < std::tie(a.y, a.z, a.x);
        if (swapped) std::swap(a, b);
        const double area = (double{a.y} - j) * (double{b.z} - k) - (double{a.z} - k) * (double{b.y} - j);
        const double never0 = area != 0 ? area : std::numeric_limits<double>::min();
        return swapped ? -never0 : never0;
    }

    std::vector<Corners> triangles_;
    Vec3i count_;
    const Progress* progress_;
    uint64_t offers_ = 0;
    std::vector<float> squared_;
    std::vector<uint32_t> nearest_;
};

/// Where the grid's own frame lies in the file's. Single precision is fine near 0 and near 1 alone: the middle becomes
/// the origin, and sizes that nobody builds in become some between 1 and 2.
struct GridFrame {
    Vec3d origin;
    double scale = 1;  ///< a power of 2, so that nothing is rounded
};
GridFrame frameOf(const Box3d& bounds) {
    constexpr int usual = 20;  // from a thousandth of a millimetre to a thousand kilometres
    const Vec3d size = bounds.size();
    constexpr int most = 1000;  // its power of 2 is a number still
    const int exponent = std::clamp(std::ilogb(maxComponent(size)), -most, most);
    return {bounds.lo + size * 0.5, std::abs(exponent) <= usual ? 1.0 : std::ldexp(1.0, -exponent)};
}

}  // namespace

Result<field::SampledGridPtr> toDistances(TriangleSoup soup, int cells, const Progress* progress) {
    const Box3d given = soup.bounds();
    const double longest = given.empty() ? 0 : maxComponent(given.size());
    if (!(longest > 0) || !(minComponent(given.size()) > 1e-4 * longest))
        return Error{Error::Kind::Input, "is flat: only a closed mesh has an inside"};
    if (!std::isfinite(longest)) return Error{Error::Kind::Input, "is larger than any number"};
    weld(soup);
    if (cancelled(progress)) return cancelledError();
    if (const auto at = hole(soup))
        return Error{
            Error::Kind::Input,
            fmt::format("is open near ({:.10g}, {:.10g}, {:.10g}): close its holes and let its faces look outward",
                        at->x, at->y, at->z)};
    const GridFrame frame = frameOf(given);
    const Vec3d half = given.size() * (0.5 * frame.scale);
    const Box3f bounds{(-half).as<float>(), half.as<float>()};
    const float cell_m = maxComponent(bounds.size()) / static_cast<float>(cells);
    const Vec3f low = bounds.lo - Vec3f{margin, margin, margin} * cell_m;
    Vec3i count;
    for (int axis = 0; axis < 3; ++axis)
        count[axis] = static_cast<int>(std::ceil(bounds.size()[axis] / cell_m + 2 * margin)) + 1;
    const auto placed = [&](uint32_t v) {
        return (((soup.positions[v] - frame.origin) * frame.scale - low.as<double>()) / double{cell_m}).as<float>();
    };
    std::vector<Corners> triangles;
    triangles.reserve(soup.triangles.size());
    for (const Triangle& t : soup.triangles) triangles.push_back({placed(t.x), placed(t.y), placed(t.z)});
    soup = {};
    auto distances = Nodes(std::move(triangles), count, progress).signedDistances();
    if (!distances.ok()) return distances.error();
    if (*std::min_element(distances->begin(), distances->end()) >= 0)
        return Error{Error::Kind::Input,
                     fmt::format("is too thin: it must be thicker somewhere than 1/{} of its longest side", cells)};
    for (float& d : *distances) d *= cell_m;
    return std::make_shared<const field::SampledGrid>(low, cell_m, count, *distances, bounds);
}

Result<field::SampledGridPtr> toDistances(const Mesh& mesh, int cells) { return toDistances(soupOf(mesh), cells); }

Result<field::SampledGridPtr> readDistances(const std::filesystem::path& path, const Progress* progress,
                                            std::vector<std::filesystem::path>* named) {
    auto soup = readMesh(path, progress, named);
    if (!soup.ok()) return soup.error();
    auto grid = toDistances(std::move(*soup), distanceCells, progress);
    if (!grid.ok() && grid.error().kind != Error::Kind::Cancelled)
        return Error{grid.error().kind, fmt::format("'{}' {}", path.string(), grid.error().message)};
    return grid;
}

}  // namespace sgm::mesh
