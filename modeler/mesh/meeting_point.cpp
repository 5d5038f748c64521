#include "modeler/mesh/meeting_point.h"

#include <algorithm>
#include <array>

namespace sgm::mesh {
namespace {

constexpr double settledShare = 0.02;  ///< of the distance of the planes' points: what is this near stays
constexpr double leastSine = 0.05;     ///< between planes that meet in a point

}  // namespace

Vec3f meetingPoint(std::span<const PlaneAt> planes, Vec3f near) {
    const Vec3d from = near.as<double>();
    std::array<Vec3d, 3> basis{};
    std::array<double, 3> ways{};
    size_t n = 0;
    double size = 0;
    for (const PlaneAt& plane : planes) {
        if (n == 3) break;
        Vec3d direction = plane.normal;
        double way = dot(plane.normal, plane.point - from);
        for (size_t i = 0; i < n; ++i) {
            const double share = dot(plane.normal, basis[i]);
            direction -= basis[i] * share;
            way -= share * ways[i];
        }
        size = std::max(size, length(plane.point - from));
        const double rest = length(direction);
        if (!(rest > leastSine)) continue;
        basis[n] = direction * (1 / rest);
        ways[n++] = way / rest;
    }
    Vec3d found = from;
    for (size_t i = 0; i < n; ++i) found += basis[i] * ways[i];
    const double way = length(found - from);
    return way > settledShare * size && way <= size ? found.as<float>() : near;
}

}  // namespace sgm::mesh
