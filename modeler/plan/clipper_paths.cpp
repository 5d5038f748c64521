#include "modeler/plan/clipper_paths.h"

#include <polyclipping/clipper.hpp>

#include <algorithm>

#include "modeler/plan/edge_match.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

constexpr double near_m = 1.001e-3, straight_m = 1e-5, leastArea_m2 = 1e-5;
constexpr double offsetMitreLimit = 4;

ClipperLib::Path pathFrom(const LatticePath& points) {
    ClipperLib::Path path;
    path.reserve(points.size());
    for (const LatticePoint p : points) path.emplace_back(p.x, p.z);
    return path;
}

ClipperLib::Paths pathsFrom(const LatticePaths& all) {
    ClipperLib::Paths paths;
    paths.reserve(all.size());
    for (const LatticePath& points : all) paths.push_back(pathFrom(points));
    return paths;
}

Ring ringFrom(const ClipperLib::Path& path, bool isCourt) {
    std::vector<Vec2> points;
    points.reserve(path.size());
    for (const ClipperLib::IntPoint& p : path) points.push_back(metres(LatticePoint{p.X, p.Y}));
    Ring ring = ringOf(std::move(points));
    return (signedArea(ring) < 0) == isCourt ? ring : reversed(ring);
}

/// Whether a court lies in an outline that it may touch: told by a point of it that is apart from the outline.
bool liesIn(const Ring& court, const Footprint& outline) {
    constexpr double apart_m = 1e-4;
    double farthest = -1;
    Vec2 witness;
    for (size_t i = 0; i < court.size() && farthest < apart_m; ++i)
        for (const Vec2 p : {court.from(i), (court.from(i) + court.to(i)) * 0.5})
            if (const double away = distanceToEdges(outline, p); away > farthest) farthest = away, witness = p;
    return contains(outline, witness);
}

/// Outlines run counter-clockwise and courts clockwise; a court belongs to the least outline around it. Clipper's own
/// tree takes cubic time where many edges coincide.
Footprint footprintFrom(const ClipperLib::Paths& paths) {
    Footprint result;
    std::vector<std::pair<double, Box2>> outlines;
    for (const ClipperLib::Path& path : paths)
        if (path.size() >= 3 && ClipperLib::Orientation(path)) {
            result.polygons.push_back({ringFrom(path, false), {}});
            outlines.emplace_back(signedArea(result.polygons.back().outer), bounds(result.polygons.back().outer));
        }
    for (const ClipperLib::Path& path : paths) {
        if (path.size() < 3 || ClipperLib::Orientation(path)) continue;
        Ring court = ringFrom(path, true);
        const Box2 within = bounds(court);
        constexpr double rounding_m = 1e-5;
        size_t home = outlines.size();
        for (size_t i = 0; i < outlines.size(); ++i) {
            const auto& [size, box] = outlines[i];
            if (within.lo.x < box.lo.x - rounding_m || within.hi.x > box.hi.x + rounding_m ||
                within.lo.z < box.lo.z - rounding_m || within.hi.z > box.hi.z + rounding_m)
                continue;
            if (home < outlines.size() && outlines[home].first <= size) continue;
            if (liesIn(court, footprintOf({result.polygons[i].outer, {}}))) home = i;
        }
        if (home < outlines.size()) result.polygons[home].courts.push_back(std::move(court));
    }
    return result;
}

ClipperLib::ClipType typeOf(PathBoolean how) {
    switch (how) {
        case PathBoolean::Difference:
            return ClipperLib::ctDifference;
        case PathBoolean::Intersection:
            return ClipperLib::ctIntersection;
        case PathBoolean::Union:
            break;
    }
    return ClipperLib::ctUnion;
}

Footprint executed(ClipperLib::ClipType how, const LatticePaths& subject, const LatticePaths& clip,
                   ClipperLib::PolyFillType fill) {
    ClipperLib::Clipper clipper;
    clipper.PreserveCollinear(true);
    clipper.StrictlySimple(true);
    clipper.AddPaths(pathsFrom(subject), ClipperLib::ptSubject, true);
    if (!clip.empty()) clipper.AddPaths(pathsFrom(clip), ClipperLib::ptClip, true);
    ClipperLib::Paths found;
    clipper.Execute(how, found, fill, fill);
    return footprintFrom(found);
}

/// Without rings around next to nothing.
void dropSlivers(Footprint& footprint) {
    const auto thin = [](const Ring& ring) { return std::abs(signedArea(ring)) < leastArea_m2; };
    std::erase_if(footprint.polygons, [&](const Polygon& p) { return thin(p.outer); });
    for (Polygon& polygon : footprint.polygons) std::erase_if(polygon.courts, thin);
}

bool isSound(const Footprint& footprint) { return footprint.empty() || !firstFault(footprint); }

}  // namespace

LatticePaths pathsOf(const Footprint& footprint) {
    LatticePaths paths;
    const auto add = [&](const Ring& ring) {
        LatticePath& path = paths.emplace_back();
        path.reserve(ring.size());
        for (const Vec2 p : ring.points) path.push_back(latticePoint(p));
    };
    for (const Polygon& polygon : footprint.polygons) {
        add(polygon.outer);
        for (const Ring& court : polygon.courts) add(court);
    }
    return paths;
}

Footprint booleanOf(PathBoolean how, const LatticePaths& subject, const LatticePaths& clip) {
    return executed(typeOf(how), subject, clip, ClipperLib::pftNonZero);
}

Footprint evenOddOf(const LatticePaths& paths) {
    return executed(ClipperLib::ctUnion, paths, {}, ClipperLib::pftEvenOdd);
}

Footprint offsetOf(const LatticePaths& paths, double distance_m) {
    if (distance_m == 0) return booleanOf(PathBoolean::Union, paths, {});
    ClipperLib::ClipperOffset clipper(offsetMitreLimit);
    clipper.AddPaths(pathsFrom(paths), ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    ClipperLib::Paths found;
    clipper.Execute(found, distance_m * unitsPerMetre);
    return footprintFrom(found);
}

Footprint bandOf(const LatticePath& path, double half_m, bool closed) {
    ClipperLib::ClipperOffset clipper(offsetMitreLimit);
    clipper.AddPath(pathFrom(path), ClipperLib::jtMiter, closed ? ClipperLib::etClosedLine : ClipperLib::etOpenButt);
    ClipperLib::Paths found;
    clipper.Execute(found, half_m * unitsPerMetre);
    return footprintFrom(found);
}

Footprint tidied(Footprint footprint) {
    const auto clean = [](Footprint f) {
        f = cleaned(f, near_m, straight_m);
        dropSlivers(f);
        return f;
    };
    const Footprint first = clean(footprint);
    if (isSound(first)) return first;
    // Rings that touch, or that cleaning has made cross: a little smaller they are apart, and what is thinner is gone.
    Footprint apart;
    for (const double by : {2e-4, 8e-4, 3e-3, 1e-2}) {
        const Footprint simple = booleanOf(PathBoolean::Union, pathsOf(first), {});
        apart = offsetOf(pathsOf(offsetOf(pathsOf(simple), -by)), by > 2e-4 ? by / 2 : 0);
        apart.tags = footprint.tags;
        matchEdges(apart, sourcesOf(first));
        apart = clean(apart);
        if (isSound(apart)) return apart;
    }
    std::erase_if(apart.polygons, [](const Polygon& polygon) { return !isSound(footprintOf(polygon)); });
    return isSound(apart) ? apart : Footprint{{}, footprint.tags};
}

}  // namespace sgm::plan
