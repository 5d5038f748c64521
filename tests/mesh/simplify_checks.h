// What every simplified mesh must be.
// Enters: a mesh before and after. Leaves: failed expectations.
#pragma once

#include <gtest/gtest.h>

#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"

namespace sgm::mesh {

inline Mesh simplified(const Mesh& mesh, double tolerance_m = 0, int threads = 2) {
    auto result = simplify(mesh, SimplifyOptions{.tolerance_m = tolerance_m, .threads = threads}, nullptr);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(*result) : Mesh{};
}

/// Closed, a 2-manifold, free of crossings, of the same topology, and of a volume that differs by a share at most.
inline void expectSound(const Mesh& before, const Mesh& after, double volume = 1e-5) {
    const MeshFigures is = measure(after), was = measure(before);
    EXPECT_EQ(is.boundaryEdges, 0u);
    EXPECT_EQ(is.nonmanifoldEdges, 0u);
    EXPECT_EQ(is.euler, was.euler);
    EXPECT_EQ(is.components, was.components);
    EXPECT_NEAR(is.volume_m3 / was.volume_m3, 1, volume);
    const auto judged = validate(after);
    ASSERT_TRUE(judged.ok());
    EXPECT_TRUE(judged->closed);
    EXPECT_FALSE(judged->selfIntersects);
}

/// The squared distance of a point from a triangle (Ericson, "Real-Time Collision Detection", 2004), in m².
inline double squaredDistance(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    const auto squared = [&](Vec3d q) { return dot(p - q, p - q); };
    if (d1 <= 0 && d2 <= 0) return squared(a);
    const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return squared(b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared(a + ab * (d1 / (d1 - d3)));
    const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return squared(c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared(a + ac * (d2 / (d2 - d6)));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return squared(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const double sum = va + vb + vc;
    return squared(a + ab * (vb / sum) + ac * (vc / sum));
}

/// The greatest distance of a mesh of one chunk from another: of its vertices, edges' middles and triangles' middles.
inline double farthestFrom(const Mesh& from, const Mesh& to) {
    const Chunk &a = from.chunks[0], &b = to.chunks[0];
    struct Corners {
        Vec3d x, y, z;
        Box3d box;
    };
    std::vector<Corners> triangles;
    for (const Triangle& t : b.triangles) {
        const Vec3d x = b.positions[t.x].as<double>(), y = b.positions[t.y].as<double>(),
                    z = b.positions[t.z].as<double>();
        triangles.push_back({x, y, z, hull(hull(Box3d{x, x}, y), z)});
    }
    double most = 0;
    size_t nearest = 0;  // of the point before: a good guess
    const auto see = [&](Vec3d p) {
        double least = squaredDistance(p, triangles[nearest].x, triangles[nearest].y, triangles[nearest].z);
        for (size_t i = 0; i < triangles.size() && least > most; ++i) {
            const Vec3d off = max(max(triangles[i].box.lo - p, p - triangles[i].box.hi), Vec3d{});
            if (dot(off, off) >= least) continue;
            const double d = squaredDistance(p, triangles[i].x, triangles[i].y, triangles[i].z);
            if (d < least) least = d, nearest = i;
        }
        most = std::max(most, least);
    };
    for (const Triangle& t : a.triangles) {
        const Vec3d x = a.positions[t.x].as<double>(), y = a.positions[t.y].as<double>(),
                    z = a.positions[t.z].as<double>();
        for (const Vec3d p : {x, (x + y) / 2, (y + z) / 2, (z + x) / 2, (x + y + z) / 3}) see(p);
    }
    return std::sqrt(most);
}

inline void expectWithin(const Mesh& before, const Mesh& after, double tolerance_m) {
    EXPECT_LE(farthestFrom(before, after), tolerance_m * 1.001);
    EXPECT_LE(farthestFrom(after, before), tolerance_m * 1.001);
}

}  // namespace sgm::mesh
