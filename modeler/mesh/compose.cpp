#include "modeler/mesh/compose.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// The normals of the input's corners at a vertex on one curved region.
struct CornerSum {
    uint32_t vertex, region;
    Vec3f normal;        ///< at last their mean
    bool smooth = true;  ///< whether they are much the same

    friend bool operator<(const CornerSum& a, const CornerSum& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.region < b.region;
    }
};

constexpr float sameDirection = 0.9f;    ///< cosine between corners of one smooth fan
constexpr float sameNormal = 1 - 1e-6f;  ///< cosine between normals that needn't be told apart

/// Ascending.
std::vector<CornerSum> cornerSums(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions,
                                  std::span<const Plane> planes) {
    std::vector<CornerSum> all;
    for (size_t i = 0; i < input.chunks.size(); ++i)
        for (const CornerNormal& c : input.chunks[i].cornerNormals) {
            const uint32_t t = flat.parts[i].firstTriangle + c.corner / 3, region = regions.ofTriangle[t];
            if (!planes[region].planar())
                all.push_back({flat.triangles[t][static_cast<int>(c.corner % 3)], region, c.normal});
        }
    std::stable_sort(all.begin(), all.end());
    std::vector<CornerSum> sums;
    for (size_t begin = 0, end; begin < all.size(); begin = end) {
        CornerSum sum = all[begin];
        for (end = begin + 1; end < all.size() && !(all[begin] < all[end]); ++end) sum.normal += all[end].normal;
        sum.normal = normalized(sum.normal);
        for (size_t i = begin; i < end; ++i) sum.smooth &= dot(all[i].normal, sum.normal) > sameDirection;
        sums.push_back(sum);
    }
    return sums;
}

class Composer {
public:
    Composer(const Mesh& input, const FlatMesh& flat, const SurfaceRegions& regions, std::span<const Plane> planes)
        : input_(input), flat_(flat), regions_(regions), planes_(planes) {
        bare_ = input.hasPositionsOnly();
        labelled_ =
            std::any_of(input.chunks.begin(), input.chunks.end(), [](const Chunk& c) { return !c.labels.empty(); });
        if (!bare_) corners_ = cornerSums(input, flat, regions, planes);
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
        const CornerSum wanted{v, t.region, {}};
        const auto at = std::lower_bound(corners_.begin(), corners_.end(), wanted);
        if (at == corners_.end() || wanted < *at) return inputNormal(v);
        if (at->smooth) return at->normal;
        const Vec3d a = flat_.positions[t.corners.x].as<double>(), b = flat_.positions[t.corners.y].as<double>(),
                    c = flat_.positions[t.corners.z].as<double>();
        return normalized(cross(b - a, c - a)).as<float>();
    }

    Vec3f inputNormal(uint32_t v) const {
        const auto after = [](uint32_t vertex, const FlatMesh::Part& p) { return vertex < p.firstVertex; };
        auto part = std::upper_bound(flat_.parts.begin(), flat_.parts.end(), v, after);
        --part;
        return input_.chunks[static_cast<size_t>(part - flat_.parts.begin())].normals[v - part->firstVertex];
    }

    const Mesh& input_;
    const FlatMesh& flat_;
    const SurfaceRegions& regions_;
    const std::span<const Plane> planes_;
    std::vector<CornerSum> corners_;
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
