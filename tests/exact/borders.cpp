#include <algorithm>
#include <cmath>

#include "tests/exact/exact_model.h"

namespace sgm::exact {
namespace {

constexpr double flatCosine = 0.99996;  ///< of half a degree: less than the sides of round solids turn
constexpr double beside_m = 1e-4;       ///< from an edge to where a face's owner is asked for
constexpr double step_m = 0.05;         ///< between questions along an edge

/// A triangle's edge, running from `a` to `b` as its triangle does.
struct Edge {
    uint32_t a, b, triangle;
    std::pair<uint32_t, uint32_t> key() const { return std::minmax(a, b); }
};

/// Both sides of every edge of a closed mesh, one after the other.
std::vector<Edge> edgesOf(const ExactModel& model) {
    std::vector<Edge> edges;
    for (uint32_t t = 0; t < model.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) edges.push_back({model.triangles[t][k], model.triangles[t][(k + 1) % 3], t});
    std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
        return std::pair(x.key(), x.triangle) < std::pair(y.key(), y.triangle);
    });
    return edges;
}

/// Looks up who owns a place on the surface.
class OwnerLookup {
public:
    OwnerLookup(const ExactModel& first, const Provenance& provenance)
        : first_(first), provenance_(provenance), looks_(looksOf(provenance)), tree_(first.points, first.triangles) {}

    uint32_t lookOf(uint32_t triangle) const { return looks_[provenance_.parts[first_.origins[triangle]].material]; }
    uint32_t lookAt(Vec3d p) const { return lookOf(tree_.nearest(p).triangle); }

private:
    const ExactModel& first_;
    const Provenance& provenance_;
    const std::vector<uint32_t> looks_;
    const TriangleTree tree_;
};

/// One edge between two faces that aren't in one plane.
struct Bend {
    Vec3d a, b, across[2];  ///< across: from the edge into either face

    bool differs(const OwnerLookup& owners, double share) const {
        const Vec3d p = a + (b - a) * share;
        return owners.lookAt(p + across[0] * beside_m) != owners.lookAt(p + across[1] * beside_m);
    }
    /// Appends the stretches of the edge where the two faces look different.
    void collect(const OwnerLookup& owners, std::vector<Segment>& borders) const {
        const double whole = length(b - a), margin = std::min(0.25, beside_m / whole);
        const int steps = static_cast<int>(std::ceil(whole / step_m));
        const auto at = [&](double share) { return a + (b - a) * share; };
        double last = margin, begin = 0;
        bool was = differs(owners, last);
        for (int i = 1; i <= steps; ++i) {
            const double next = margin + (1 - 2 * margin) * i / steps;
            if (differs(owners, next) != was) {
                double low = last, high = next;
                while ((high - low) * whole > beside_m)
                    (differs(owners, (low + high) / 2) == was ? low : high) = (low + high) / 2;
                if (was) borders.push_back({at(begin), at(high)});
                begin = high;
                was = !was;
            }
            last = next;
        }
        if (was) borders.push_back({at(begin), b});
    }
};

}  // namespace

std::vector<Segment> findBorders(const ExactModel& model, const ExactModel& first, const Provenance& provenance) {
    const OwnerLookup owners(first, provenance);
    std::vector<Segment> borders;
    // Along the edges of the clean model.
    const std::vector<Edge> edges = edgesOf(model);
    for (size_t i = 0; i + 1 < edges.size(); i += 2) {
        const Vec3d n = model.normals[edges[i].triangle], m = model.normals[edges[i + 1].triangle];
        const Vec3d a = model.points[edges[i].a], b = model.points[edges[i].b];
        if (dot(n, m) > flatCosine || a == b) continue;
        const Vec3d along = normalized(b - a);
        Bend{a, b, {normalized(cross(n, along)), normalized(cross(m, -along))}}.collect(owners, borders);
    }
    // Within flat faces, but not in films.
    const TriangleTree surface(model.points, model.triangles);
    const std::vector<Edge> owned = edgesOf(first);
    for (size_t i = 0; i + 1 < owned.size(); i += 2) {
        const uint32_t t = owned[i].triangle, u = owned[i + 1].triangle;
        if (dot(first.normals[t], first.normals[u]) <= flatCosine || owners.lookOf(t) == owners.lookOf(u)) continue;
        const Segment s{first.points[owned[i].a], first.points[owned[i].b]};
        const Plane at = surface.nearest((s.a + s.b) * 0.5).plane;
        if (length(at.point - (s.a + s.b) * 0.5) < 0.2 * beside_m && dot(at.normal, first.normals[t]) > 0)
            borders.push_back(s);
    }
    return borders;
}

double lengthOf(const std::vector<Segment>& segments) {
    double sum = 0;
    for (const Segment& s : segments) sum += length(s.b - s.a);
    return sum;
}

std::vector<uint32_t> looksOf(const Provenance& provenance) {
    std::vector<uint32_t> looks;
    for (const Material& m : provenance.materials) {
        const auto same =
            std::find_if(provenance.materials.begin(), provenance.materials.end(), [&](const Material& o) {
                return o.color == m.color && o.roughness == m.roughness && o.metallic == m.metallic;
            });
        looks.push_back(static_cast<uint32_t>(same - provenance.materials.begin()));
    }
    return looks;
}

}  // namespace sgm::exact
