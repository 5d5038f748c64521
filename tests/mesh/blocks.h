// Blocks of solids, straight and turned, for tests of crisp meshes.
// Enters: places, sizes, angles. Leaves: fields.
#pragma once

#include "modeler/field/solids.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {

/// Coordinates of a graph in a frame turned about three axes.
inline field::Point turned(field::Graph& g, Vec3f centre, double degrees) {
    const double a = degrees * 3.14159265358979 / 180;
    const Mat3 m =
        Mat3::rotation({1, 0, 0}, a) * Mat3::rotation({0, 1, 0}, 0.7 * a) * Mat3::rotation({0, 0, 1}, 1.3 * a);
    const field::Point p = shifted(g, centre);
    const auto along = [&](Vec3d axis) {
        const Vec3f d = axis.as<float>();
        return p.x * g.literal(d.x) + p.y * g.literal(d.y) + p.z * g.literal(d.z);
    };
    return {along(m.x), along(m.y), along(m.z)};
}

inline field::Field block(field::Graph& g, Vec3f centre, Vec3f half, double degrees = 0) {
    const field::Point h{g.slot(half.x), g.slot(half.y), g.slot(half.z)};
    const float reach = length(half);
    const Vec3f r{reach, reach, reach};
    const field::NodeRef value =
        field::solids::boxDistance(degrees == 0 ? shifted(g, centre) : turned(g, centre, degrees), h);
    return {value, degrees == 0 ? Box3f{centre - half, centre + half} : Box3f{centre - r, centre + r}, 1, 0.5f};
}

}  // namespace sgm::mesh
