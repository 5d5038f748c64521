#include <cmath>
#include <map>

#include "modeler/core/conventions.h"
#include "viewer/render/camera.h"
#include "viewer/render/samples.h"

namespace sgm::render {
namespace {

/// Three-quarter from above, as near as the points allow, their projection centred.
Camera framePoints(const std::vector<Vec3d>& points, const Box3d& box, double aspect) {
    constexpr double fill = 0.84;  // share of the picture that the points may take; the rest is for the shadow
    const Vec3d towardsEye = normalized(Vec3d{0.58, 0.38, 0.85});
    const Vec3d right = normalized(cross(Vec3d{0, 1, 0}, towardsEye)), up = cross(towardsEye, right);
    Camera camera;
    const double tanUp = std::tan(camera.fieldOfView / 2) * fill, tanRight = tanUp * aspect;
    camera.at = box.centre();
    double distance = 1;
    // Moving the centre changes the perspective a little: a few rounds settle it.
    for (int round = 0; round < 6; ++round) {
        distance = 0;
        for (const Vec3d& point : points) {
            const Vec3d v = point - camera.at;
            distance = std::max({distance, std::abs(dot(v, right)) / tanRight + dot(v, towardsEye),
                                 std::abs(dot(v, up)) / tanUp + dot(v, towardsEye)});
        }
        Box3d seen;
        for (const Vec3d& point : points) {
            const Vec3d v = point - camera.at;
            const double depth = distance - dot(v, towardsEye);
            seen = hull(seen, Vec3d{dot(v, right) / depth, dot(v, up) / depth, 0});
        }
        camera.at += (right * seen.centre().x + up * seen.centre().y) * distance;
    }
    camera.eye = camera.at + towardsEye * distance;
    return camera;
}

/// Places on a coarse grid that hold the solid or nearly so; none where the bounds are no box.
std::vector<Vec3d> solidPoints(const eval::Tape& tape, const Box3f& bounds) {
    std::vector<Vec3d> points;
    if (bounds.empty() || !bounds.finite() || !(maxComponent(bounds.size()) > 0)) return points;
    const Samples grid = sample(tape, bounds);
    for (const Vec3f& place : grid.placesBelow(0.3f * grid.cell)) points.push_back(place.as<double>());
    return points;
}

}  // namespace

Camera frame(const Box3f& bounds, double aspect) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(Vec3f{i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y,
                                i & 4 ? bounds.hi.z : bounds.lo.z}
                              .as<double>());
    return framePoints(corners, bounds.as<double>(), aspect);
}

Camera frame(const eval::Tape& tape, const Box3f& bounds, double aspect) {
    const std::vector<Vec3d> points = solidPoints(tape, bounds);
    return points.empty() ? frame(bounds, aspect) : framePoints(points, bounds.as<double>(), aspect);
}

Camera frameTurning(const eval::Tape& tape, const Box3f& bounds, double aspect) {
    const Vec3d axis = bounds.as<double>().centre();
    std::map<double, double> radiusAt;  // by height: what turns sweeps rings
    for (const Vec3d& p : solidPoints(tape, bounds)) {
        double& radius = radiusAt[p.y];
        radius = std::max(radius, std::hypot(p.x - axis.x, p.z - axis.z));
    }
    std::vector<Vec3d> points;
    for (const auto& [height, radius] : radiusAt)
        for (int i = 0; i < 64; ++i)
            points.push_back(
                {axis.x + radius * std::cos(i * pi / 32), height, axis.z + radius * std::sin(i * pi / 32)});
    return points.empty() ? frame(bounds, aspect) : framePoints(points, bounds.as<double>(), aspect);
}

Camera turned(Camera camera, double angle) {
    const Vec3d out = camera.eye - camera.at;
    const double c = std::cos(angle), s = std::sin(angle);
    camera.eye = camera.at + Vec3d{c * out.x + s * out.z, out.y, c * out.z - s * out.x};
    return camera;
}

}  // namespace sgm::render
