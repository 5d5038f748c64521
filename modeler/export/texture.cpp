#include "modeler/export/texture.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/export/surface.h"
#include "modeler/image/texture_axes.h"
#include "modeler/image/texture_frame.h"

namespace sgm::exporter {
namespace {

/// A share of the area of a smooth piece by which its triangles' normals may lean away from their mean: rounding.
constexpr double flatness = 1e-3;
/// Cosine of the angle within which two triangles lie in one plane.
constexpr double inPlane = .99996;
/// The triangles of one origin and label: the face of a box, the side of a roof, or something curved.
struct SmoothPiece {
    Vec3d normal;  ///< twice the area, then the unit normal of a flat one
    double bent = 0, area = 0;
    bool flat = false;
    std::vector<Vec3d>
        planes{};       ///< of one that isn't flat: the sums of those of its triangles that lie in a plane each
    double beyond = 0;  ///< twice the area of triangles in other planes

    /// Counts a triangle to its plane. `c` has twice its area as length.
    void addToPlane(Vec3d c) {
        constexpr size_t most = 16;
        if (Vec3d* plane = planeOf(c))
            *plane += c;
        else if (planes.size() < most)
            planes.push_back(c);
        else
            beyond += length(c);
    }
    Vec3d* planeOf(Vec3d c) {
        const auto at = std::find_if(planes.begin(), planes.end(),
                                     [&](Vec3d p) { return dot(c, p) >= inPlane * length(c) * length(p); });
        return at == planes.end() ? nullptr : &*at;
    }
    /// Nearly all of it lies in a few planes: coarse cells let faces run over their edges to the next ones.
    bool isFaceted() const { return beyond < area / 5; }
};

/// Distinct axes, by their numbers in steps that no eye sees.
class AxesTable {
public:
    uint32_t index(const image::TextureMap& map, std::vector<ChartAxes>& all) {
        uint64_t key = 0;
        const auto note = [&](double x) { key = combine(key, static_cast<uint64_t>(std::llround(x * 4096))); };
        for (const Vec3d& axis : {map.u, map.v})
            for (int i = 0; i < 3; ++i) note(axis[i]);
        for (const size_t i : {0u, 1u}) note(map.begin_m[i]), note(map.stretch[i]);
        const auto [at, fresh] = known_.try_emplace(key, static_cast<uint32_t>(all.size()));
        if (fresh) {
            ChartAxes axes{map.u.as<float>(), map.v.as<float>()};
            for (const size_t i : {0u, 1u}) {
                axes.begin_m[i] = static_cast<float>(map.begin_m[i]);
                axes.stretch[i] = static_cast<float>(map.stretch[i]);
            }
            all.push_back(axes);
        }
        return at->second;
    }

private:
    std::unordered_map<uint64_t, uint32_t> known_;
};

/// Charts by the scopes of the parts that own the triangles.
class ScopeCharts {
public:
    ScopeCharts(const mesh::Mesh& mesh, const Provenance& provenance)
        : mesh_(mesh), provenance_(provenance), vertices_(mesh) {}

    TextureCharts run() {
        forTriangles([&](OriginId, Vec3d, Vec3d c, SmoothPiece* piece) {
            if (piece) piece->normal += c, piece->area += length(c);
        });
        std::unordered_map<uint64_t, double> areas;
        for (auto& [key, piece] : pieces_) areas[key] = length(piece.normal), piece.normal = normalized(piece.normal);
        forTriangles([&](OriginId, Vec3d, Vec3d c, SmoothPiece* piece) {
            if (piece)
                piece->bent +=
                    length(c - piece->normal * dot(c, piece->normal)) + std::max(0.0, -dot(c, piece->normal));
        });
        for (auto& [key, piece] : pieces_) piece.flat = piece.bent <= flatness * areas[key];
        forTriangles([&](OriginId origin, Vec3d, Vec3d c, SmoothPiece* piece) {
            if (piece && !piece->flat && partOf(origin).hasFlatFaces) piece->addToPlane(c);
        });
        charts_.ofTriangle.reserve(mesh_.triangleCount());
        forTriangles([&](OriginId origin, Vec3d at, Vec3d c, SmoothPiece* piece) {
            charts_.ofTriangle.push_back(chartOf(origin, at, c, piece));
        });
        return std::move(charts_);
    }

private:
    /// Calls visit(origin, a corner, cross product of the edges, its piece or null) for every triangle.
    template <class Visit>
    void forTriangles(Visit visit) {
        for (const mesh::Chunk& chunk : mesh_.chunks) {
            uint64_t last = 0;
            SmoothPiece* piece = nullptr;
            for (size_t i = 0; i < chunk.triangles.size(); ++i) {
                const mesh::Triangle t = chunk.inMesh(chunk.triangles[i]);
                const Vec3d a = vertices_.position(t.x).as<double>();
                const Vec3d c =
                    cross(vertices_.position(t.y).as<double>() - a, vertices_.position(t.z).as<double>() - a);
                const OriginId origin = chunk.origins[i];
                if (!chunk.labels.empty()) {
                    const uint64_t key = uint64_t{origin} << 32 | chunk.labels[i];
                    if (!piece || key != last) piece = &pieces_[last = key];
                }
                visit(origin, a, c, piece);
            }
        }
    }

    const Part& partOf(OriginId origin) const {
        return provenance_.parts[origin < provenance_.parts.size() ? origin : 0];
    }

    uint32_t chartOf(OriginId origin, Vec3d point, Vec3d c, SmoothPiece* piece) {
        const Part& part = partOf(origin);
        const bool isFaceted = piece && !piece->flat && part.hasFlatFaces && piece->isFaceted();
        const bool flat = piece && (piece->flat || isFaceted);
        Vec3d normal = flat ? piece->normal : c;
        if (isFaceted) {
            const Vec3d* plane = piece->planeOf(c);
            normal = normalized(plane ? *plane : c);
        }
        return table_.index(image::mapFace(part.textureFrame.get(), part.pose.axes,
                                           provenance_.materials[part.material].texture.get(), flat, normal, point),
                            charts_.axes);
    }

    const mesh::Mesh& mesh_;
    const Provenance& provenance_;
    Vertices vertices_;
    std::unordered_map<uint64_t, SmoothPiece> pieces_;  ///< by origin << 32 | label
    AxesTable table_;
    TextureCharts charts_;
};

TextureCharts boxCharts(const mesh::Mesh& mesh) {
    TextureCharts charts;
    for (int axis = 0; axis < 6; ++axis) {
        const image::TextureAxes along = image::axesAgainst(axis);
        charts.axes.push_back({along.u.as<float>(), along.v.as<float>()});
    }
    Vertices vertices(mesh);
    charts.ofTriangle.reserve(mesh.triangleCount());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const mesh::Triangle& local : chunk.triangles) {
            const mesh::Triangle t = chunk.inMesh(local);
            const Vec3f a = vertices.position(t.x), b = vertices.position(t.y), c = vertices.position(t.z);
            charts.ofTriangle.push_back(static_cast<uint32_t>(image::nearestAxis(cross(b - a, c - a))));
        }
    return charts;
}

}  // namespace

TextureCharts chartTexture(std::string_view kind, const mesh::Mesh& mesh, const Provenance& provenance) {
    if (kind == "none") return {};
    return kind == "box" ? boxCharts(mesh) : ScopeCharts(mesh, provenance).run();
}

}  // namespace sgm::exporter
