#include "modeler/field/convex.h"

#include <cmath>

#include "modeler/core/conventions.h"

namespace sgm::field::convex {
namespace {

/// Sides of what is round about one axis.
int sidesOf(Roundness roundness) { return roundness == Roundness::Fine ? 12 : 8; }

/// How far from the axis the sides of a regular polygon lie that has the area of the unit circle.
double apothem(int n) { return std::sqrt(pi / n / std::tan(pi / n)); }

/// dot(direction, u) ≤ offset in shares u = p / half of the half-sizes.
HalfSpace scaled(Vec3d direction, double offset, Vec3d half) {
    const Vec3d normal{direction.x / half.x, direction.y / half.y, direction.z / half.z};
    const double l = length(normal);
    return {normal / l, offset / l};
}

Vec3d around(int i, int n) {
    const double angle = 2 * pi * (i + 0.5) / n;
    return {std::cos(angle), 0, std::sin(angle)};
}

/// Faces of what is round about a point, evenly about y in rings, with fewer of them near the poles.
struct Sphere {
    std::vector<Vec3d> directions{{0, 1, 0}, {0, -1, 0}};
    double share;  ///< where the planes lie about a unit ball so that what they bound has the ball's volume

    explicit Sphere(Roundness roundness) : share(roundness == Roundness::Fine ? 0.9800 : 0.9510) {
        if (roundness == Roundness::Fine) {
            for (const double latitude : {-60.0, 60.0}) addRing(6, latitude);
            for (const double latitude : {-30.0, 30.0}) addRing(12, latitude);
            addRing(16, 0);
        } else {
            for (const double latitude : {-45.0, 45.0}) addRing(6, latitude);
            addRing(8, 0);
        }
    }

private:
    void addRing(int faces, double latitude_deg) {
        const double up = radians(latitude_deg);
        for (int i = 0; i < faces; ++i)
            directions.push_back(around(i, faces) * std::cos(up) + Vec3d{0, std::sin(up), 0});
    }
};

HalfSpace foot(Vec3d half) { return {{0, -1, 0}, half.y}; }

}  // namespace

std::vector<ConvexPart> cube(Vec3d half, std::span<const double>, Roundness) {
    ConvexPart part;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            Vec3d normal;
            normal[axis] = sign;
            part.push_back({normal, half[axis]});
        }
    return {part};
}

std::vector<ConvexPart> ellipsoid(Vec3d half, std::span<const double>, Roundness roundness) {
    const Sphere sphere(roundness);
    ConvexPart part;
    for (const Vec3d& d : sphere.directions) part.push_back(scaled(d, sphere.share, half));
    return {part};
}

// The tube's sections at both ends of a part are ellipses; every side is a plane that touches them both.
std::vector<ConvexPart> torus(Vec3d half, std::span<const double> arguments, Roundness roundness) {
    const int parts = sidesOf(roundness), tubeSides = roundness == Roundness::Fine ? 8 : 6;
    const double tube = arguments[0], turn = pi / parts;
    const double wider = apothem(parts) / std::cos(turn);  // moves the ring's corners out, for the arcs' area
    std::vector<ConvexPart> all;
    for (int i = 0; i < parts; ++i) {
        const Vec3d out = around(i, parts), along{-out.z, 0, out.x};
        ConvexPart part{scaled(along * std::cos(turn) - out * std::sin(turn), 0, half),
                        scaled(-along * std::cos(turn) - out * std::sin(turn), 0, half)};
        for (int k = 0; k < tubeSides; ++k) {
            const double angle = 2 * pi * (k + 0.5) / tubeSides, a = std::cos(angle) / tube, b = std::sin(angle);
            const double across = a * std::cos(turn) * wider;
            part.push_back(scaled(out * a + Vec3d{0, b, 0},
                                  across * (1 - tube) + apothem(tubeSides) * std::hypot(across * tube, b), half));
        }
        all.push_back(part);
    }
    return all;
}

std::vector<ConvexPart> cylinder(Vec3d half, std::span<const double>, Roundness roundness) {
    const int sides = sidesOf(roundness);
    ConvexPart part{{{0, 1, 0}, half.y}, foot(half)};
    for (int i = 0; i < sides; ++i) part.push_back(scaled(around(i, sides), apothem(sides), half));
    return {part};
}

std::vector<ConvexPart> cone(Vec3d half, std::span<const double>, Roundness roundness) {
    const int sides = sidesOf(roundness);
    ConvexPart part{foot(half)};
    for (int i = 0; i < sides; ++i)
        part.push_back(scaled(around(i, sides) * (2 / apothem(sides)) + Vec3d{0, 1, 0}, 1, half));
    return {part};
}

// A segment along y with a ball of radius r about each point, in coordinates in which the least half-size r is 1.
std::vector<ConvexPart> capsule(Vec3d half, std::span<const double>, Roundness roundness) {
    const double r = minComponent(half);
    const Sphere sphere(roundness);
    ConvexPart part;
    for (const Vec3d& d : sphere.directions)
        part.push_back(scaled({d.x, d.y * half.y / r, d.z}, sphere.share + std::abs(d.y) * (half.y / r - 1), half));
    return {part};
}

std::vector<ConvexPart> pyramid(Vec3d half, std::span<const double>, Roundness) {
    return {{foot(half), scaled({2, 1, 0}, 1, half), scaled({-2, 1, 0}, 1, half), scaled({0, 1, 2}, 1, half),
             scaled({0, 1, -2}, 1, half)}};
}

std::vector<ConvexPart> prism(Vec3d half, std::span<const double>, Roundness) {
    return {{foot(half),
             scaled({2, 1, 0}, 1, half),
             scaled({-2, 1, 0}, 1, half),
             {{0, 0, 1}, half.z},
             {{0, 0, -1}, half.z}}};
}

std::vector<ConvexPart> wedge(Vec3d half, std::span<const double>, Roundness) {
    return {{foot(half), {{-1, 0, 0}, half.x}, {{0, 0, 1}, half.z}, {{0, 0, -1}, half.z}, scaled({1, 1, 0}, 0, half)}};
}

std::vector<ConvexPart> halfspace(Vec3d, std::span<const double>, Roundness) { return {{{{0, 1, 0}, 0}}}; }

}  // namespace sgm::field::convex
