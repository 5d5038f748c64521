#include "tests/exact/quality.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "modeler/mesh/validate.h"

namespace sgm::exact {
namespace {

constexpr double creaseCosine = 0.984807753012208;  // of 10 degrees

/// A mesh in three arrays, with a look a triangle.
struct Soup {
    std::vector<Vec3d> points;
    std::vector<Corners> triangles;
    std::vector<uint32_t> looks;
};

Soup soupOf(const mesh::Mesh& mesh, const Provenance& provenance) {
    const std::vector<uint32_t> looks = looksOf(provenance);
    Soup soup;
    for (const mesh::Chunk& c : mesh.chunks) {
        for (const Vec3f& p : c.positions) soup.points.push_back(p.as<double>());
        for (size_t t = 0; t < c.triangles.size(); ++t) {
            soup.triangles.push_back(c.inMesh(c.triangles[t]));
            const OriginId origin = t < c.origins.size() ? c.origins[t] : 0;
            soup.looks.push_back(looks[provenance.parts[origin < provenance.parts.size() ? origin : 0].material]);
        }
    }
    return soup;
}

std::vector<Vec3d> usedPoints(const Soup& soup) {
    std::vector<bool> used(soup.points.size(), false);
    for (const Corners& t : soup.triangles) used[t.x] = used[t.y] = used[t.z] = true;
    std::vector<Vec3d> points;
    for (size_t v = 0; v < used.size(); ++v)
        if (used[v]) points.push_back(soup.points[v]);
    return points;
}

/// A triangle's edge.
struct Edge {
    uint32_t a, b, t;
    auto key() const { return std::pair(a, b); }
};

/// The edges of all triangles, those of equal ends beside each other.
std::vector<Edge> edgesOf(const Soup& soup) {
    std::vector<Edge> edges;
    edges.reserve(3 * soup.triangles.size());
    for (uint32_t t = 0; t < soup.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = soup.triangles[t][k], b = soup.triangles[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), t});
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& x, const Edge& y) { return std::pair(x.key(), x.t) < std::pair(y.key(), y.t); });
    return edges;
}

/// The triangle's unit normal; zero where it is lower than `least_m`, so that rounding decides where it looks.
Vec3d normalOf(const Soup& soup, uint32_t t, double least_m) {
    const Vec3d a = soup.points[soup.triangles[t].x], b = soup.points[soup.triangles[t].y],
                c = soup.points[soup.triangles[t].z];
    const Vec3d twice = cross(b - a, c - a);
    const double base = std::max({length(b - a), length(c - b), length(a - c)});
    return length(twice) > least_m * base ? normalized(twice) : Vec3d{};
}

/// What lies along the mesh's edges: its own creases, and the length between two looks.
struct Along {
    std::vector<Segment> creases;
    double border_m = 0;
};

Along alongEdges(const Soup& soup, double cell_m) {
    Along along;
    const std::vector<Edge> edges = edgesOf(soup);
    for (size_t i = 0; i + 1 < edges.size(); ++i) {
        if (edges[i].key() != edges[i + 1].key()) continue;
        const Segment s{soup.points[edges[i].a], soup.points[edges[i].b]};
        if (soup.looks[edges[i].t] != soup.looks[edges[i + 1].t]) along.border_m += length(s.b - s.a);
        const Vec3d n = normalOf(soup, edges[i].t, 1e-3 * cell_m), m = normalOf(soup, edges[i + 1].t, 1e-3 * cell_m);
        if (dot(n, n) > 0 && dot(m, m) > 0 && dot(n, m) < creaseCosine) along.creases.push_back(s);
    }
    return along;
}

/// Whether the exact surface nearest to `p` is flat, and the solid and the air there at least two cells thick.
bool isFlatAndThick(const TriangleTree& exact, const ExactModel& model, Vec3d p, double cell_m) {
    const auto [at, triangle] = exact.nearest(p);
    if (model.round[triangle]) return false;
    const double off_m = 1e-3 * cell_m;
    const auto own = [off_m, &at = at](const Plane& plane) { return plane.distance(at.point) < 0.1 * off_m; };
    const Vec3d off = at.normal * off_m;
    return std::min(exact.hit(at.point - off, -at.normal, own), exact.hit(at.point + off, at.normal, own)) >=
           2 * cell_m;
}

/// Distances in cells from points every half cell along the mesh's creases to the nearest exact one, but where the
/// nearest feature, or the surface itself, is thin, for there a mesh tears, and where it is round, for there it bends.
std::vector<double> strays(const std::vector<Segment>& creases, const ExactModel& model, const CreaseSamples& samples,
                           double cell_m) {
    std::vector<double> found;
    if (model.creases.empty() || samples.thick.empty()) return found;
    std::vector<Segment> exact;
    for (const Crease& c : model.creases) exact.push_back(c.segment);
    const SegmentTree nearest(exact);
    const TriangleTree surface(model.points, model.triangles);
    const PointTree thick(samples.thick);
    const PointTree thin(samples.thin.empty() ? std::vector<Vec3d>{{1e30, 1e30, 1e30}} : samples.thin);
    // Enough of them for three digits of a mean.
    const size_t stride = 1 + creases.size() / 200'000;
    for (size_t k = 0; k < creases.size(); k += stride) {
        const Segment& s = creases[k];
        const Vec3d way = s.b - s.a;
        const int count = std::max(1, static_cast<int>(std::ceil(length(way) / (0.5 * cell_m))));
        for (int i = 0; i < count; ++i) {
            const Vec3d p = s.a + way * ((i + 0.5) / count);
            if (thick.distance(p) < thin.distance(p) && isFlatAndThick(surface, model, p, cell_m))
                found.push_back(nearest.distance(p) / cell_m);
        }
    }
    return found;
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    double sum = 0;
    for (const double v : values) sum += v;
    const size_t rank = std::min(values.size() - 1, static_cast<size_t>(0.99 * static_cast<double>(values.size())));
    return {sum / static_cast<double>(values.size()), values[rank], values.back(), values.size()};
}

Quality measureQuality(const mesh::Mesh& mesh, const Provenance& provenance, const ExactModel& model, double cell_m,
                       bool count) {
    Quality quality;
    quality.cell_m = cell_m;
    const Soup soup = soupOf(mesh, provenance);
    const CreaseSamples samples = sampleCreases(model, cell_m);
    quality.thickShare = samples.thickShare();

    const TriangleTree surface(soup.points, soup.triangles);
    std::vector<double> distances;
    for (const Vec3d p : samples.thick) distances.push_back(surface.distance(p) / cell_m);
    quality.crease = spreadOf(distances);
    for (const Vec3d p : samples.thin) distances.push_back(surface.distance(p) / cell_m);
    quality.everyCrease = spreadOf(std::move(distances));

    const PointTree vertices(usedPoints(soup));
    distances.clear();
    for (const Vec3d p : thickCorners(model, samples, cell_m)) distances.push_back(vertices.distance(p) / cell_m);
    quality.corner = spreadOf(std::move(distances));
    distances.clear();
    for (const Corner& c : model.corners) distances.push_back(vertices.distance(c.point) / cell_m);
    quality.everyCorner = spreadOf(std::move(distances));

    const Along along = alongEdges(soup, cell_m);
    quality.stray = spreadOf(strays(along.creases, model, samples, cell_m));
    quality.border_m = along.border_m;

    const mesh::MeshFigures figures = mesh::measure(mesh);
    quality.volumeError = figures.volume_m3 / model.volume_m3 - 1;
    quality.boundaryEdges = figures.boundaryEdges;
    quality.nonmanifoldEdges = figures.nonmanifoldEdges;
    if (count) quality.crossings = crossingPairs(soup.points, soup.triangles);
    return quality;
}

}  // namespace sgm::exact
