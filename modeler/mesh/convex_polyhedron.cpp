#include "modeler/mesh/convex_polyhedron.h"

#include <algorithm>
#include <cmath>

namespace sgm::mesh {
namespace {

using field::HalfSpace;
using Face = ConvexPolyhedron::Face;

constexpr double onPlane_m = 1e-7;  ///< corners as near as this lie on a plane
constexpr double samePlane_m = 1e-6;

double height(const HalfSpace& plane, Vec3d p) { return dot(plane.normal, p) - plane.offset; }

bool near(Vec3d a, Vec3d b) { return dot(a - b, a - b) < onPlane_m * onPlane_m; }

/// The part of a face below the plane; corners on it go to `rim` as well.
std::vector<Vec3d> clippedCorners(const std::vector<Vec3d>& corners, const HalfSpace& by, std::vector<Vec3d>& rim) {
    std::vector<Vec3d> kept;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i], b = corners[(i + 1) % corners.size()];
        const double ha = height(by, a), hb = height(by, b);
        if (ha <= onPlane_m) kept.push_back(a);
        if (std::abs(ha) <= onPlane_m) rim.push_back(a);
        if ((ha > onPlane_m && hb < -onPlane_m) || (ha < -onPlane_m && hb > onPlane_m)) {
            const Vec3d crossing = a + (b - a) * (ha / (ha - hb));
            kept.push_back(crossing);
            rim.push_back(crossing);
        }
    }
    if (kept.size() < 3) kept.clear();
    return kept;
}

/// Corners of a convex polygon in the plane, in order about it, each once; fewer than three are none.
std::vector<Vec3d> ordered(std::vector<Vec3d> corners, Vec3d normal) {
    Vec3d middle;
    for (const Vec3d& p : corners) middle += p / static_cast<double>(corners.size());
    const Vec3d across = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d u = normalized(cross(normal, across)), v = cross(normal, u);
    const auto angle = [&](Vec3d p) { return std::atan2(dot(p - middle, v), dot(p - middle, u)); };
    std::stable_sort(corners.begin(), corners.end(), [&](Vec3d a, Vec3d b) { return angle(a) < angle(b); });
    std::vector<Vec3d> once;
    for (const Vec3d& p : corners)
        if (once.empty() || !near(once.back(), p)) once.push_back(p);
    while (once.size() > 1 && near(once.front(), once.back())) once.pop_back();
    if (once.size() < 3) once.clear();
    return once;
}

HalfSpace opposite(const HalfSpace& plane) { return {-plane.normal, -plane.offset}; }

bool samePlane(const HalfSpace& a, const HalfSpace& b) {
    return dot(a.normal, b.normal) > 1 - 1e-9 && std::abs(a.offset - b.offset) < samePlane_m;
}

/// Both pieces as one, where they lie to both sides of a plane and are convex together.
std::optional<ConvexPolyhedron> joined(const ConvexPolyhedron& a, const ConvexPolyhedron& b) {
    if (intersection(a.bounds().inflated(samePlane_m), b.bounds()).empty()) return {};
    for (const Face& wall : a.faces()) {
        const auto facing = std::find_if(b.faces().begin(), b.faces().end(),
                                         [&](const Face& f) { return samePlane(f.plane, opposite(wall.plane)); });
        if (facing == b.faces().end()) continue;
        field::ConvexPart around;
        for (const ConvexPolyhedron* piece : {&a, &b})
            for (const Face& f : piece->faces())
                if (&f != &wall && &f != &*facing) around.push_back(f.plane);
        // Only where neither reaches beyond the other's other faces are the two all that these half-spaces hold.
        const auto whole = ConvexPolyhedron::of(around, hull(a.bounds(), b.bounds()));
        if (!whole) continue;
        const double parts = a.volume_m3() + b.volume_m3();
        if (std::abs(whole->volume_m3() - parts) < 1e-6 * parts) return whole;
    }
    return {};
}

}  // namespace

ConvexPolyhedron::ConvexPolyhedron(const Box3d& box) : bounds_(box) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {true, false}) {
            Vec3d normal;
            normal[axis] = upper ? 1 : -1;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::vector<Vec3d> corners;
            for (int i = 0; i < 4; ++i) {
                Vec3d p;
                p[axis] = upper ? box.hi[axis] : box.lo[axis];
                const int turn = upper ? i : 3 - i;
                p[u] = turn == 1 || turn == 2 ? box.hi[u] : box.lo[u];
                p[v] = turn >= 2 ? box.hi[v] : box.lo[v];
                corners.push_back(p);
            }
            faces_.push_back({{normal, upper ? box.hi[axis] : -box.lo[axis]}, corners});
        }
}

std::optional<ConvexPolyhedron> ConvexPolyhedron::of(const field::ConvexPart& part, const Box3d& box) {
    std::optional<ConvexPolyhedron> left(box);
    for (const HalfSpace& plane : part) {
        left = left->clipped(plane);
        if (!left) return {};
    }
    return left;
}

std::optional<ConvexPolyhedron> ConvexPolyhedron::clipped(const HalfSpace& by) const {
    if (support(by.normal) <= by.offset + onPlane_m) return *this;
    if (-support(-by.normal) >= by.offset - onPlane_m) return {};
    ConvexPolyhedron left;
    std::vector<Vec3d> rim;
    for (const Face& face : faces_) {
        std::vector<Vec3d> corners = clippedCorners(face.corners, by, rim);
        if (!corners.empty()) left.faces_.push_back({face.plane, std::move(corners)});
    }
    if (std::vector<Vec3d> cap = ordered(std::move(rim), by.normal); !cap.empty()) left.faces_.push_back({by, cap});
    if (!left.settle()) return {};
    return left;
}

/// Drops faces without area; false where it is too thin to count.
bool ConvexPolyhedron::settle() {
    std::erase_if(faces_, [](Face& face) {
        face.corners = ordered(std::move(face.corners), face.plane.normal);
        return face.corners.empty();
    });
    bounds_ = {};
    for (const Face& face : faces_)
        for (const Vec3d& p : face.corners) bounds_ = hull(bounds_, p);
    return faces_.size() >= 4 && std::all_of(faces_.begin(), faces_.end(), [&](const Face& face) {
               return face.plane.offset + support(-face.plane.normal) >= leastThickness_m;
           });
}

double ConvexPolyhedron::support(Vec3d direction) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const Face& face : faces_)
        for (const Vec3d& p : face.corners) most = std::max(most, dot(direction, p));
    return most;
}

double ConvexPolyhedron::volume_m3() const {
    double six = 0;
    const Vec3d apex = bounds_.centre();
    for (const Face& face : faces_)
        for (size_t i = 2; i < face.corners.size(); ++i)
            six += dot(face.corners[0] - apex, cross(face.corners[i - 1] - apex, face.corners[i] - apex));
    return six / 6;
}

bool ConvexPolyhedron::within(const std::vector<Face>& faces) const {
    return std::all_of(faces.begin(), faces.end(),
                       [&](const Face& face) { return support(face.plane.normal) <= face.plane.offset + samePlane_m; });
}

void ConvexPolyhedron::triangulate(std::vector<Vec3f>& positions, std::vector<Triangle>& triangles) const {
    std::vector<Vec3d> corners;
    const auto numberOf = [&](Vec3d p) {
        const auto known = std::find_if(corners.begin(), corners.end(),
                                        [&](Vec3d c) { return dot(c - p, c - p) < samePlane_m * samePlane_m; });
        if (known != corners.end()) return static_cast<uint32_t>(known - corners.begin());
        corners.push_back(p);
        return static_cast<uint32_t>(corners.size() - 1);
    };
    for (const Face& face : faces_) {
        std::vector<uint32_t> loop;
        for (const Vec3d& p : face.corners)
            if (const uint32_t n = numberOf(p); loop.empty() || (loop.back() != n && loop.front() != n))
                loop.push_back(n);
        for (size_t i = 2; i < loop.size(); ++i) triangles.push_back({loop[0], loop[i - 1], loop[i]});
    }
    for (const Vec3d& p : corners) positions.push_back(p.as<float>());
}

std::vector<ConvexPolyhedron> subtracted(const ConvexPolyhedron& whole, const field::ConvexPart& part) {
    std::optional<ConvexPolyhedron> rest = whole;
    field::ConvexPart planes;
    for (const HalfSpace& plane : part) {
        if (-whole.support(-plane.normal) >= plane.offset - onPlane_m) return {whole};
        if (whole.support(plane.normal) > plane.offset + onPlane_m) planes.push_back(plane);
    }
    for (const HalfSpace& plane : planes) {
        rest = rest->clipped(plane);
        if (!rest) return {whole};
    }
    // The largest piece first: few and large pieces, and slivers only where the part itself has them.
    std::vector<ConvexPolyhedron> pieces;
    rest = whole;
    while (!planes.empty()) {
        std::optional<ConvexPolyhedron> largest;
        size_t at = 0;
        for (size_t i = 0; i < planes.size(); ++i) {
            auto piece = rest->clipped(opposite(planes[i]));
            if (piece && (!largest || piece->volume_m3() > largest->volume_m3())) largest = std::move(piece), at = i;
        }
        if (!largest) break;
        rest = rest->clipped(planes[at]);
        pieces.push_back(std::move(*largest));
        planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(at));
        if (!rest) break;
    }
    return pieces;
}

void joinConvex(std::vector<ConvexPolyhedron>& pieces) {
    for (size_t before = 0; before != pieces.size();) {
        before = pieces.size();
        for (size_t i = 0; i < pieces.size(); ++i)
            for (size_t j = i + 1; j < pieces.size(); ++j) {
                auto one = joined(pieces[i], pieces[j]);
                if (!one) continue;
                pieces[i] = std::move(*one);
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j--));
            }
    }
}

}  // namespace sgm::mesh
