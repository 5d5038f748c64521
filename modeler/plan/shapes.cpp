#include "modeler/plan/shapes.h"

#include <fmt/format.h>

#include <optional>

#include "modeler/core/conventions.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

constexpr double leastLength_m = 2e-3, mostLength_m = 1e5;

/// The error of a length out of its range.
std::optional<Error> outOf(std::string_view shape, std::string_view parameter, double value, double lo, double hi) {
    if (value >= lo && value <= hi) return {};
    return Error{Error::Kind::Input, fmt::format("'{}' of {} is {:.6g} m, it must lie from {:.6g} to {:.6g} m",
                                                 parameter, shape, value, lo, hi)};
}

std::optional<Error> badSize(std::string_view shape, double width, double depth) {
    if (auto e = outOf(shape, "width", width, leastLength_m, mostLength_m)) return e;
    return outOf(shape, "depth", depth, leastLength_m, mostLength_m);
}

/// An inner measure that must leave something of `whole`.
std::optional<Error> badPart(std::string_view shape, std::string_view parameter, double value, double whole) {
    return outOf(shape, parameter, value, leastLength_m, whole - leastLength_m);
}

Footprint outlined(std::vector<Vec2> points) { return footprintOf(polygonOf(std::move(points))); }

Result<Footprint> regular(std::string_view shape, int sides, double radius, double scale) {
    if (sides < 3 || sides > 10'000)
        return Error{Error::Kind::Input, fmt::format("{} of {} sides: there must be 3 to 10,000", shape, sides)};
    if (auto e = outOf(shape, "radius", radius, leastLength_m * sides, mostLength_m / 2)) return *e;
    std::vector<Vec2> points;
    for (int i = 0; i < sides; ++i) {  // the side from the last point to the first faces −z
        const double angle = -pi / 2 + 2 * pi * (i + 0.5) / sides;
        points.push_back({radius * scale * std::cos(angle), radius * scale * std::sin(angle)});
    }
    return outlined(std::move(points));
}

}  // namespace

Result<Footprint> rectangle(double width_m, double depth_m) {
    if (auto e = badSize("rectangle", width_m, depth_m)) return *e;
    const double x = width_m / 2, z = depth_m / 2;
    return outlined({{-x, -z}, {x, -z}, {x, z}, {-x, z}});
}

Result<Footprint> ell(double width_m, double depth_m, double wingX_m, double wingZ_m) {
    if (auto e = badSize("ell", width_m, depth_m)) return *e;
    if (auto e = badPart("ell", "wing along x", wingX_m, depth_m)) return *e;
    if (auto e = badPart("ell", "wing along z", wingZ_m, width_m)) return *e;
    const double x = width_m / 2, z = depth_m / 2;
    return outlined({{-x, -z}, {x, -z}, {x, -z + wingX_m}, {-x + wingZ_m, -z + wingX_m}, {-x + wingZ_m, z}, {-x, z}});
}

Result<Footprint> tee(double width_m, double depth_m, double bar_m, double stem_m) {
    if (auto e = badSize("tee", width_m, depth_m)) return *e;
    if (auto e = badPart("tee", "bar", bar_m, depth_m)) return *e;
    if (auto e = badPart("tee", "stem", stem_m, width_m)) return *e;
    const double x = width_m / 2, z = depth_m / 2, s = stem_m / 2, b = -z + bar_m;
    return outlined({{-x, -z}, {x, -z}, {x, b}, {s, b}, {s, z}, {-s, z}, {-s, b}, {-x, b}});
}

Result<Footprint> yard(double width_m, double depth_m, double wing_m) {
    if (auto e = badSize("yard", width_m, depth_m)) return *e;
    if (auto e = badPart("yard", "wing", wing_m, std::min(width_m / 2, depth_m))) return *e;
    const double x = width_m / 2, z = depth_m / 2, w = wing_m;
    return outlined({{-x, -z}, {x, -z}, {x, z}, {x - w, z}, {x - w, -z + w}, {-x + w, -z + w}, {-x + w, z}, {-x, z}});
}

Result<Footprint> ring(double width_m, double depth_m, double wing_m) {
    if (auto e = badSize("ring", width_m, depth_m)) return *e;
    if (auto e = badPart("ring", "wing", wing_m, std::min(width_m, depth_m) / 2)) return *e;
    Result<Footprint> whole = rectangle(width_m, depth_m);
    const uint32_t tag = whole->tag("court");
    const double x = width_m / 2 - wing_m, z = depth_m / 2 - wing_m;
    whole->polygons[0].courts.push_back(ringOf({{-x, -z}, {-x, z}, {x, z}, {x, -z}}, {tag, EdgeSource::Court}));
    return whole;
}

Result<Footprint> ngon(int sides, double radius_m) { return regular("ngon", sides, radius_m, 1); }

Result<Footprint> round(int sides, double radius_m) {
    const double n = std::max(sides, 3);
    return regular("round", sides, radius_m, std::sqrt(2 * pi / n / std::sin(2 * pi / n)));
}

Result<Footprint> arc(double inner_m, double outer_m, double from, double to, int segments) {
    if (auto e = outOf("arc", "outer radius", outer_m, 2 * leastLength_m, mostLength_m / 2)) return *e;
    if (auto e = outOf("arc", "inner radius", inner_m, leastLength_m, outer_m - leastLength_m)) return *e;
    if (segments < 1 || segments > 10'000)
        return Error{Error::Kind::Input, fmt::format("arc of {} segments: there must be 1 to 10,000", segments)};
    const double sweep = to - from;
    const double least = std::max(1e-6, segments * leastLength_m / inner_m);
    const double most = 2 * pi - leastLength_m / inner_m;
    if (!(std::abs(sweep) >= least) || std::abs(sweep) > most)
        return Error{Error::Kind::Input,
                     fmt::format("arc over {:.6g} degrees: there must be more than {:.3g} and less than {:.6g}",
                                 degrees(sweep), degrees(least), degrees(most))};
    if (std::abs(sweep) / segments >= pi)
        return Error{Error::Kind::Input, "arc of too few segments: each must span less than 180 degrees"};
    Footprint result;
    const uint32_t outer = result.tag("outer"), inner = result.tag("inner"), end = result.tag("end");
    const double begin = std::min(from, to), step = std::abs(sweep) / segments;
    Ring outline;
    for (int i = 0; i <= segments; ++i) {
        const double angle = begin + step * i;
        outline.points.push_back({outer_m * std::cos(angle), outer_m * std::sin(angle)});
        outline.edges.push_back({i < segments ? outer : end, EdgeSource::Side});
    }
    for (int i = segments; i >= 0; --i) {
        const double angle = begin + step * i;
        outline.points.push_back({inner_m * std::cos(angle), inner_m * std::sin(angle)});
        outline.edges.push_back({i > 0 ? inner : end, EdgeSource::Side});
    }
    result.polygons.push_back({std::move(outline), {}});
    return checked(std::move(result));
}

}  // namespace sgm::plan
