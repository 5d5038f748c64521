// Points of a planar region in two dimensions, without rounding. For triangulate*.cpp alone: includes CGAL.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "modeler/core/vec.h"
#include "modeler/mesh/triangulate.h"

namespace sgm::mesh {

using PlaneKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PlanePoint = PlaneKernel::Point_2;

/// Drops the coordinate in which the normal is longest, so that what is counter-clockwise seen against it stays so.
class PlaneProjection {
public:
    explicit PlaneProjection(Vec3d normal) {
        // Regions of one plane, turned by 45°, must not choose apart by rounding: earlier axes win near ties.
        const double x = std::abs(normal.x), y = std::abs(normal.y) * 0.97, z = std::abs(normal.z) * 0.94;
        const int dropped = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
        u_ = (dropped + 1) % 3, v_ = (dropped + 2) % 3;
        if (normal[dropped] < 0) std::swap(u_, v_);
    }
    PlanePoint operator()(Vec3f p) const { return {p[u_], p[v_]}; }

private:
    int u_, v_;
};

/// The triangles of a polygon of few vertices that doesn't touch itself, ear by ear; false where it does or has no
/// area.
bool cutEars(std::span<const uint32_t> loop, std::span<const Vec3f> positions, const PlaneProjection& project,
             std::vector<Triangle>& triangles);

}  // namespace sgm::mesh
