#include "modeler/mesh/compose.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// The normal of the input's corner at a vertex on a curved region.
struct InputCorner {
    uint32_t vertex, region;
    Vec3f normal;

    friend bool operator<(const InputCorner& a, const InputCorner& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.region < b.region;
    }
};

constexpr float sameDirection = 0.9f;    ///< cosine between corners of one smooth fan
constexpr float leastFacing = 0.5f;      ///< cosine between a corner's normal and its triangle
constexpr double needleShape = 0.01;     ///< doubled area by the square of the longest side
constexpr float sameNormal = 1 - 1e-6f;  ///< cosine between normals that needn't be told apart

/// The normals of the input's corners at vertices of curved regions where some corner has a normal of its own.
class InputCorners {
public:
    InputCorners() = default;
    InputCorners(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions,
                 std::span<const Plane> planes) {
        PageVector<uint8_t> hasOwn;  // by vertex
        hasOwn.assign(flat.positions.size(), uint8_t{0});
        for (size_t i = 0; i < input.chunks.size(); ++i)
            for (const CornerNormal& c : input.chunks[i].cornerNormals) {
                const uint32_t t = flat.parts[i].firstTriangle + c.corner / 3, region = regions.ofTriangle[t];
                if (planes[region].planar()) continue;
                const uint32_t v = flat.triangles[t][static_cast<int>(c.corner % 3)];
                corners_.push_back({v, region, c.normal});
                hasOwn[v] = 1;
            }
        std::stable_sort(corners_.begin(), corners_.end());
        addOthers(input, flat, regions, planes, hasOwn);
    }

    /// Those of a vertex on a region; none where all of them have the vertex's normal.
    std::span<const InputCorner> at(uint32_t vertex, uint32_t region) const {
        const auto found = std::equal_range(corners_.begin(), corners_.end(), InputCorner{vertex, region, {}});
        return {found.first, found.second};
    }

private:
    /// Corners with the vertex's normal count as well: one that differs, as of a sliver, doesn't speak for all.
    void addOthers(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions,
                   std::span<const Plane> planes, const PageVector<uint8_t>& hasOwn) {
        if (corners_.empty()) return;
        std::vector<InputCorner> others;
        for (size_t i = 0; i < input.chunks.size(); ++i) {
            const FlatMesh::Part& part = flat.parts[i];
            auto own = input.chunks[i].cornerNormals.begin();
            const auto end = input.chunks[i].cornerNormals.end();
            for (uint32_t local = 0; local < part.triangles; ++local) {
                const uint32_t t = part.firstTriangle + local, region = regions.ofTriangle[t];
                if (planes[region].planar()) continue;
                while (own != end && own->corner < 3 * local) ++own;
                for (uint32_t k = 0; k < 3; ++k) {
                    const uint32_t v = flat.triangles[t][static_cast<int>(k)];
                    const bool isOwn = own != end && own->corner == 3 * local + k;
                    if (isOwn) ++own;
                    if (hasOwn[v] && !isOwn && !at(v, region).empty())
                        others.push_back({v, region, normalOfVertex(input, flat, v)});
                }
            }
        }
        if (others.empty()) return;
        corners_.insert(corners_.end(), others.begin(), others.end());
        std::stable_sort(corners_.begin(), corners_.end());
    }

    std::vector<InputCorner> corners_;  ///< ascending
};

/// The mean of corners' normals where these are much the same, else of those that are to a triangle's normal, else
/// that.
Vec3f normalOf(std::span<const InputCorner> corners, Vec3f face) {
    Vec3f sum, near;
    for (const InputCorner& c : corners) {
        sum += c.normal;
        if (dot(c.normal, face) > sameDirection) near += c.normal;
    }
    sum = normalized(sum);
    const auto isNear = [&](const InputCorner& c) { return dot(c.normal, sum) > sameDirection; };
    if (std::all_of(corners.begin(), corners.end(), isNear)) return sum;
    return near == Vec3f{} ? face : normalized(near);
}

class Composer {
public:
    Composer(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions, std::span<const Plane> planes)
        : input_(input), flat_(flat), regions_(regions), planes_(planes) {
        bare_ = input.hasPositionsOnly();
        labelled_ =
            std::any_of(input.chunks.begin(), input.chunks.end(), [](const Chunk& c) { return !c.labels.empty(); });
        if (!bare_) corners_ = InputCorners(input, flat, regions, planes);
    }

    Mesh compose(std::span<const SimpleTriangle> triangles) {
        numberVertices(triangles);
        chunk_.triangles.reserve(triangles.size());
        for (const SimpleTriangle& t : triangles) {
            const Triangle& c = t.corners;
            if (!bare_)
                for (int i = 0; i < 3; ++i) setNormal(t, i);
            chunk_.triangles.push_back({number_[c.x], number_[c.y], number_[c.z]});
            if (!bare_) chunk_.origins.push_back(FlatMesh::originOf(regions_.keys[t.region]));
            if (labelled_) chunk_.labels.push_back(FlatMesh::labelOf(regions_.keys[t.region]));
        }
        Mesh mesh;
        mesh.chunks.push_back(std::move(chunk_));
        return mesh;
    }

private:
    static constexpr uint32_t unused = 0xffffffffu;

    void numberVertices(std::span<const SimpleTriangle> triangles) {
        number_.assign(flat_.positions.size(), unused);
        for (const SimpleTriangle& t : triangles)
            for (int i = 0; i < 3; ++i) number_[t.corners[i]] = 0;
        uint32_t count = 0;
        for (uint32_t v = 0; v < number_.size(); ++v) {
            if (number_[v] == unused) continue;
            number_[v] = count++;
            chunk_.positions.push_back(flat_.positions[v]);
        }
        if (!bare_) chunk_.normals.assign(count, Vec3f{});
    }

    /// The first corner at a vertex gives its normal; others that differ get their own.
    void setNormal(const SimpleTriangle& t, int corner) {
        const uint32_t v = t.corners[corner];
        const Vec3f wanted = normalAt(t, v);
        Vec3f& normal = chunk_.normals[number_[v]];
        if (normal == Vec3f{})
            normal = wanted;
        else if (!(dot(normal, wanted) > sameNormal))
            chunk_.cornerNormals.push_back(
                {static_cast<uint32_t>(3 * chunk_.triangles.size()) + static_cast<uint32_t>(corner), wanted});
    }

    Vec3f normalAt(const SimpleTriangle& t, uint32_t v) const {
        if (planes_[t.region].planar()) return planes_[t.region].normal.as<float>();
        const Vec3d a = flat_.positions[t.corners.x].as<double>(), ab = flat_.positions[t.corners.y].as<double>() - a,
                    ac = flat_.positions[t.corners.z].as<double>() - a, across = cross(ab, ac);
        const Vec3f face = normalized(across).as<float>();
        const std::span<const InputCorner> corners = corners_.at(v, t.region);
        const Vec3f wanted = corners.empty() ? normalOfVertex(input_, flat_, v) : normalOf(corners, face);
        // The vertex may have had a small face of the region alone. Needles take what is smooth: they face anywhere.
        const bool isNeedle =
            !(length(across) > needleShape * std::max({dot(ab, ab), dot(ac, ac), dot(ac - ab, ac - ab)}));
        return isNeedle || dot(wanted, face) > leastFacing ? wanted : face;
    }

    const Mesh& input_;
    const FlatMesh& flat_;
    const SurfaceRegions& regions_;
    const std::span<const Plane> planes_;
    InputCorners corners_;
    PageVector<uint32_t> number_;  ///< by vertex of the input
    Chunk chunk_;
    bool bare_, labelled_;
};

}  // namespace

Mesh composeMesh(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions, std::span<const Plane> planes,
                 std::span<const SimpleTriangle> triangles) {
    return Composer(input, flat, regions, planes).compose(triangles);
}

}  // namespace sgm::mesh
