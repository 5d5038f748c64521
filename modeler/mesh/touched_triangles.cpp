#include "modeler/mesh/touched_triangles.h"

#include <algorithm>
#include <iterator>

#include "modeler/mesh/one_chunk.h"

namespace sgm::mesh {
namespace {

/// Of the square of a triangle's longest edge: how far its area may face away, for rounding.
constexpr double foldedShare = 1e-6;

}  // namespace

TouchedTriangles::Touched TouchedTriangles::touch(uint32_t triangle, std::span<const CornerNormal> own) const {
    Touched touched{triangle, 0, {}, 0};
    Vec3d ofCreases;
    for (const CornerNormal& n : own) ofCreases += n.normal.as<double>(), touched.creases |= 1 << n.corner % 3;
    touched.outward = outwardOf(touched, ofCreases);
    touched.before = facing(touched);
    return touched;
}

void TouchedTriangles::find(const PageVector<uint32_t>& moveOf) {
    touched_.clear();
    for (size_t i = 0; i < mesh_.chunks.size(); ++i)
        visitTriangles(mesh_.chunks[i], [&](uint32_t t, std::span<const CornerNormal> own) {
            const uint32_t triangle = flat_.parts[i].firstTriangle + t;
            const Triangle& corners = flat_.triangles[triangle];
            if (moveOf[corners.x] == none && moveOf[corners.y] == none && moveOf[corners.z] == none) return;
            touched_.push_back(touch(triangle, own));
        });
}

void TouchedTriangles::add(uint32_t triangle) {
    const auto isBefore = [](uint32_t t, const FlatMesh::Part& p) { return t < p.firstTriangle; };
    const auto part = std::prev(std::upper_bound(flat_.parts.begin(), flat_.parts.end(), triangle, isBefore));
    const Chunk& chunk = mesh_.chunks[static_cast<size_t>(part - flat_.parts.begin())];
    const auto at = std::lower_bound(touched_.begin(), touched_.end(), triangle,
                                     [](const Touched& touched, uint32_t t) { return touched.triangle < t; });
    touched_.insert(at, touch(triangle, cornerNormalsOf(chunk, triangle - part->firstTriangle)));
}

TouchedTriangles::Touched* TouchedTriangles::of(uint32_t triangle) {
    const auto at = std::lower_bound(touched_.begin(), touched_.end(), triangle,
                                     [](const Touched& touched, uint32_t t) { return touched.triangle < t; });
    return at != touched_.end() && at->triangle == triangle ? &*at : nullptr;
}

std::vector<uint32_t> TouchedTriangles::folded() const {
    std::vector<uint32_t> found;
    for (const Touched& touched : touched_) {
        const double now = facing(touched);
        if (now < touched.before && now < -foldedShare * longestSquare(touched.triangle))
            found.push_back(touched.triangle);
    }
    return found;
}

bool TouchedTriangles::isFlat(const Touched& touched) const {
    return !(facing(touched) > foldedShare * longestSquare(touched.triangle));
}

/// The mean of the normals at corners inside its piece, which the surface as it is doesn't mislead; where all lie on
/// creases, of those.
Vec3d TouchedTriangles::outwardOf(const Touched& touched, Vec3d ofCreases) const {
    Vec3d inside;
    for (int i = 0; i < 3; ++i)
        if (!(touched.creases >> i & 1))
            inside += normalOfVertex(mesh_, flat_, flat_.triangles[touched.triangle][i]).as<double>();
    return normalized(touched.creases == 7 ? ofCreases : inside);
}

double TouchedTriangles::facing(const Touched& touched) const {
    const Triangle& t = flat_.triangles[touched.triangle];
    const Vec3d a = flat_.positions[t.x].as<double>();
    return dot(cross(flat_.positions[t.y].as<double>() - a, flat_.positions[t.z].as<double>() - a), touched.outward);
}

double TouchedTriangles::longestSquare(uint32_t triangle) const {
    const Triangle& t = flat_.triangles[triangle];
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d d = (flat_.positions[t[(i + 1) % 3]] - flat_.positions[t[i]]).as<double>();
        most = std::max(most, dot(d, d));
    }
    return most;
}

}  // namespace sgm::mesh
