// Surfaces whose faces are grids, as a mesher makes them, built from whole numbers.
// Enters: voxels or grids of points. Leaves: meshes with origins and labels, welded. Assumes gtest only in callers.
#pragma once

#include <functional>
#include <map>
#include <numbers>

#include "modeler/core/random.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// Collects triangles over welded points of a lattice.
class MeshBuilder {
public:
    /// The number of the point at a place of the lattice.
    uint32_t vertex(Vec3i at, Vec3d position) {
        const auto [entry, fresh] = numbers_.try_emplace({at.x, at.y, at.z}, static_cast<uint32_t>(numbers_.size()));
        if (fresh) {
            chunk_.positions.push_back(position.as<float>());
            chunk_.normals.push_back({});
        }
        return entry->second;
    }
    void triangle(uint32_t a, uint32_t b, uint32_t c, OriginId origin, Label label) {
        chunk_.triangles.push_back({a, b, c});
        chunk_.origins.push_back(origin);
        chunk_.labels.push_back(label);
    }
    /// Normals from the triangles: at a corner where labels or origins meet, that of its own piece.
    Mesh build() {
        std::map<std::tuple<uint32_t, OriginId, Label>, Vec3f> sums;
        const auto piece = [&](uint32_t v, size_t t) { return std::tuple(v, chunk_.origins[t], chunk_.labels[t]); };
        for (size_t t = 0; t < chunk_.triangles.size(); ++t) {
            const Triangle& c = chunk_.triangles[t];
            const Vec3f n =
                cross(chunk_.positions[c.y] - chunk_.positions[c.x], chunk_.positions[c.z] - chunk_.positions[c.x]);
            for (int i = 0; i < 3; ++i) sums[piece(c[i], t)] += n;
        }
        for (uint32_t t = 0; t < chunk_.triangles.size(); ++t)
            for (uint32_t i = 0; i < 3; ++i) {
                const uint32_t v = chunk_.triangles[t][static_cast<int>(i)];
                const Vec3f n = normalized(sums[piece(v, t)]);
                Vec3f& normal = chunk_.normals[v];
                if (normal == Vec3f{})
                    normal = n;
                else if (dot(normal, n) < 0.999f)
                    chunk_.cornerNormals.push_back({3 * t + i, n});
            }
        Mesh mesh;
        mesh.chunks.push_back(std::move(chunk_));
        return mesh;
    }

private:
    std::map<std::array<int32_t, 3>, uint32_t> numbers_;
    Chunk chunk_;
};

using Placing = std::function<Vec3d(Vec3d)>;
inline Vec3d asIs(Vec3d p) { return p; }

/// Turns about a slanted axis and moves away from the origin.
inline Placing turned(double angle) {
    const Mat3 m = Mat3::rotation({1, 2, 3}, angle);
    return [m](Vec3d p) { return m * p + Vec3d{3.7, -1.3, 0.9}; };
}

/// A set of unit cubes; `originAt` is 0 where there is none.
struct Voxels {
    Vec3i size;
    std::vector<OriginId> origins = std::vector<OriginId>(static_cast<size_t>(size.x) * size.y * size.z);
    bool holds(Vec3i at) const {
        return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
    }
    OriginId& at(Vec3i p) { return origins[static_cast<size_t>((p.z * size.y + p.y) * size.x + p.x)]; }
    OriginId originAt(Vec3i p) const { return holds(p) ? const_cast<Voxels*>(this)->at(p) : 0; }
};

/// Fills voxels until no two touch in an edge or a corner alone, inside or outside.
inline void makeManifold(Voxels& voxels) {
    const auto solid = [&](Vec3i p) { return voxels.originAt(p) != 0; };
    for (bool changed = true; changed;) {
        changed = false;
        for (int z = -1; z < voxels.size.z; ++z)
            for (int y = -1; y < voxels.size.y; ++y)
                for (int x = -1; x < voxels.size.x; ++x) {
                    bool in[8];
                    int count = 0;
                    const auto place = [&](int i) { return Vec3i{x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)}; };
                    for (int i = 0; i < 8; ++i) count += in[i] = solid(place(i));
                    // Of the eight around a corner, solid ones and empty ones must each hang together by faces.
                    const auto connected = [&](bool of) {
                        int reached = 0, first = 0;
                        while (first < 8 && in[first] != of) ++first;
                        if (first == 8) return true;
                        reached = 1 << first;
                        for (int round = 0; round < 8; ++round)
                            for (int i = 0; i < 8; ++i)
                                for (int axis = 0; axis < 3; ++axis)
                                    if ((reached >> i & 1) && in[i ^ 1 << axis] == of) reached |= 1 << (i ^ 1 << axis);
                        for (int i = 0; i < 8; ++i)
                            if (in[i] == of && !(reached >> i & 1)) return false;
                        return true;
                    };
                    if (count == 0 || count == 8 || (connected(true) && connected(false))) continue;
                    for (int i = 0; i < 8; ++i)
                        if (!in[i] && voxels.holds(place(i)) && !changed) voxels.at(place(i)) = 1, changed = true;
                }
    }
}

/// The surface of voxels, each face a grid of `cuts` squares along; labels are the faces' planes.
inline Mesh surfaceOf(const Voxels& voxels, int cuts, const Placing& place = asIs) {
    MeshBuilder builder;
    for (int z = 0; z < voxels.size.z; ++z)
        for (int y = 0; y < voxels.size.y; ++y)
            for (int x = 0; x < voxels.size.x; ++x)
                for (int side = 0; side < 6; ++side) {
                    const Vec3i at{x, y, z};
                    const OriginId origin = voxels.originAt(at);
                    const int axis = side % 3, up = side / 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
                    Vec3i beyond = at;
                    beyond[axis] += up ? 1 : -1;
                    if (origin == 0 || voxels.originAt(beyond) != 0) continue;
                    const Label label = static_cast<Label>(2 * (3 * (at[axis] + up) + axis) + up);
                    const auto corner = [&](int i, int j) {
                        Vec3i p = at * cuts;
                        p[axis] += up * cuts, p[u] += i, p[v] += j;
                        return builder.vertex(p, place(p.as<double>() / cuts));
                    };
                    for (int i = 0; i < cuts; ++i)
                        for (int j = 0; j < cuts; ++j) {
                            uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                                     d = corner(i, j + 1);
                            if (!up) std::swap(b, d);
                            builder.triangle(a, b, c, origin, label);
                            builder.triangle(a, c, d, origin, label);
                        }
                }
    return builder.build();
}

/// A box of voxels of one origin.
inline Voxels block(Vec3i size, OriginId origin = 1) {
    Voxels v{size};
    std::fill(v.origins.begin(), v.origins.end(), origin);
    return v;
}

/// Random voxels of `origins` kinds, made manifold.
inline Voxels randomVoxels(int side, int originKinds, double filled, uint64_t key) {
    Voxels v{{side, side, side}};
    for (size_t i = 0; i < v.origins.size(); ++i) {
        const uint64_t k = combine(key, i);
        if (uniform(combine(k, 1)) < filled)
            v.origins[i] = 1 + static_cast<OriginId>(uniform(combine(k, 2)) * originKinds);
    }
    makeManifold(v);
    return v;
}

/// A point of a profile in the half-plane x ≥ 0, and what the surface from there to the next one is.
struct ProfilePoint {
    double x, y;
    OriginId origin = 1;
    Label label = 0;
};

/// The profile's edges cut into `cuts` each.
inline std::vector<ProfilePoint> cutFinely(const std::vector<ProfilePoint>& profile, int cuts, bool closed) {
    std::vector<ProfilePoint> fine;
    for (size_t i = 0; i + (closed ? 0 : 1) < profile.size(); ++i) {
        const ProfilePoint &a = profile[i], &b = profile[(i + 1) % profile.size()];
        for (int k = 0; k < cuts; ++k) {
            const double t = static_cast<double>(k) / cuts;
            fine.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.origin, a.label});
        }
    }
    if (!closed) fine.push_back(profile.back());
    return fine;
}

/// The surface that a profile sweeps about the y axis; it runs upwards outside. An open profile begins and ends on the
/// axis, a closed one returns from its last point to its first.
inline Mesh revolved(const std::vector<ProfilePoint>& profile, int sectors, bool closed, const Placing& place = asIs) {
    MeshBuilder builder;
    const auto point = [&](size_t i, int k) {
        const ProfilePoint& p = profile[i % profile.size()];
        const double angle = 2 * std::numbers::pi * (k % sectors) / sectors;
        return builder.vertex({static_cast<int>(i % profile.size()), p.x > 0 ? k % sectors : 0, 0},
                              place({p.x * std::cos(angle), p.y, -p.x * std::sin(angle)}));
    };
    for (size_t i = 0; i + (closed ? 0 : 1) < profile.size(); ++i) {
        const ProfilePoint &p = profile[i], &q = profile[(i + 1) % profile.size()];
        for (int k = 0; k < sectors; ++k) {
            const uint32_t a = point(i, k), b = point(i, k + 1), c = point(i + 1, k + 1), d = point(i + 1, k);
            if (p.x > 0) builder.triangle(a, b, c, p.origin, p.label);
            if (q.x > 0) builder.triangle(a, c, d, p.origin, p.label);
        }
    }
    return builder.build();
}

inline Mesh cylinder(double radius, double height, int rings, int sectors, const Placing& place = asIs) {
    return revolved(
        cutFinely({{0, 0, 1, 1}, {radius, 0, 1, 2}, {radius, height, 1, 3}, {0, height, 1, 3}}, rings, false), sectors,
        false, place);
}

inline Mesh sphere(int rings, int sectors, Label lower = 0, Label upper = 0) {
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= rings; ++i) {
        const double angle = std::numbers::pi * i / rings;
        profile.push_back({i % rings == 0 ? 0 : std::sin(angle), -std::cos(angle), 1, 3 * i < rings ? lower : upper});
    }
    return revolved(profile, sectors, false);
}

inline Mesh ring(double radius, double tube, int around, int sectors) {
    std::vector<ProfilePoint> profile;
    for (int i = 0; i < around; ++i) {
        const double angle = 2 * std::numbers::pi * i / around;
        profile.push_back({radius + tube * std::cos(angle), tube * std::sin(angle)});
    }
    return revolved(profile, sectors, true);
}

}  // namespace sgm::mesh
