#include "grammar/lower/met_segments.h"

#include <cmath>

#include "grammar/lower/mesh_positions.h"
#include "modeler/mesh/box_finder.h"

namespace sgm::lower {
namespace {

constexpr double beside = 1e-3;  ///< of a triangle, within which a segment that passes its edge meets it

/// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997. False where the segment is parallel to
/// the triangle.
bool meets(Vec3d from, Vec3d to, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d way = to - from, u = b - a, v = c - a, p = cross(way, v), s = from - a, q = cross(s, u);
    const double det = dot(u, p);
    if (det == 0) return false;
    const double alongU = dot(s, p) / det, alongV = dot(way, q) / det, along = dot(v, q) / det;
    return alongU >= -beside && alongV >= -beside && alongU + alongV <= 1 + beside && along >= 0 && along <= 1;
}

}  // namespace

std::vector<uint8_t> segmentsThatMeet(const mesh::Mesh& mesh, std::span<const std::array<Vec3f, 2>> segments,
                                      const Progress* progress) {
    std::vector<uint8_t> met(segments.size(), 0);
    if (segments.empty()) return met;
    std::vector<Box3f> boxes;
    for (const auto& [from, to] : segments) boxes.push_back(hull(Box3f{from, from}, to));
    const mesh::BoxFinder finder(boxes);
    const std::vector<const Vec3f*> positions = positionsOf(mesh);
    std::vector<uint32_t> near;
    for (const mesh::Chunk& c : mesh.chunks) {
        if (cancelled(progress)) break;
        for (const mesh::Triangle& t : c.triangles) {
            const mesh::Triangle corners = c.inMesh(t);
            const Vec3f p = *positions[corners.x], q = *positions[corners.y], r = *positions[corners.z];
            finder.find(hull(hull(Box3f{p, p}, q), r), near);
            for (const uint32_t i : near)
                if (!met[i])
                    met[i] = meets(segments[i][0].as<double>(), segments[i][1].as<double>(), p.as<double>(),
                                   q.as<double>(), r.as<double>());
        }
    }
    return met;
}

}  // namespace sgm::lower
