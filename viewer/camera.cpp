#include <array>
#include <cmath>

#include "viewer/offscreen.h"

namespace sgm::viewer {
namespace {

std::array<Vec3d, 8> corners(const Box3f& box) {
    std::array<Vec3d, 8> points;
    for (size_t i = 0; i < 8; ++i)
        points[i] =
            Vec3f{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z}.as<double>();
    return points;
}

}  // namespace

Camera frame(const Box3f& bounds, double aspect) {
    constexpr double fill = 0.86;  // share of the picture that the box may take
    const Vec3d towardsEye = normalized(Vec3d{0.55, 0.42, 0.85});
    const Vec3d right = normalized(cross(Vec3d{0, 1, 0}, towardsEye)), up = cross(towardsEye, right);
    Camera camera;
    const double tanUp = std::tan(camera.fieldOfView / 2) * fill, tanRight = tanUp * aspect;
    camera.at = bounds.centre().as<double>();
    double distance = 1;
    // Moving the centre changes the perspective a little: a few rounds settle it.
    for (int round = 0; round < 6; ++round) {
        distance = 0;
        for (const Vec3d& corner : corners(bounds)) {
            const Vec3d v = corner - camera.at;
            distance = std::max({distance, std::abs(dot(v, right)) / tanRight + dot(v, towardsEye),
                                 std::abs(dot(v, up)) / tanUp + dot(v, towardsEye)});
        }
        Box3d seen;
        for (const Vec3d& corner : corners(bounds)) {
            const Vec3d v = corner - camera.at;
            const double depth = distance - dot(v, towardsEye);
            seen = hull(seen, Vec3d{dot(v, right) / depth, dot(v, up) / depth, 0});
        }
        camera.at += (right * seen.centre().x + up * seen.centre().y) * distance;
    }
    camera.eye = camera.at + towardsEye * distance;
    return camera;
}

}  // namespace sgm::viewer
