// Mouldings, shells and leaning blocks over the footprint of their scope (modeler/field/footprint.h).
#include <algorithm>
#include <cmath>
#include <vector>

#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "modeler/field/combine.h"
#include "modeler/field/footprint.h"
#include "modeler/field/plan_of.h"
#include "modeler/field/plan_solids.h"
#include "modeler/field/solids.h"
#include "modeler/plan/validate.h"

namespace sgm::field {
namespace {

using plan::Vec2;

constexpr double leftOut_m = 999;  ///< a point beyond is none

/// The points of a free moulding that were given; without any a plain band.
std::vector<Vec2> pointsOf(std::span<const Argument> arguments) {
    std::vector<Vec2> points;
    for (const Argument& a : arguments)
        if (a.value[0] < leftOut_m && a.value[1] < leftOut_m) points.push_back({a.value[0], a.value[1]});
    if (points.empty()) points = {{-.1, 0}, {.2, 0}, {.2, .3}, {-.1, .3}};
    return points;
}

/// A profile swept round, nothing where it is none: `profileFault` has told so.
Field swept(const PrimitiveInput& in, std::span<const Vec2> profile) {
    const PlanOf plan(in);
    const Quantity foot{-in.half.y, -in.halfValue.y};
    auto field = moulding(*plan, profile, foot, combine(in.path, hashText("moulding")));
    return field.ok() ? *field : nothing(in.p.x.graph());
}

/// Points of a curve from s = 0 to 1, in (share of what stands out, share of the height).
template <class Curve>
void add(std::vector<Vec2>& points, Vec2 lo, Vec2 hi, Curve curve) {
    constexpr int pieces = 8;
    for (int i = 0; i <= pieces; ++i) {
        const Vec2 at = curve(i / static_cast<double>(pieces));
        points.push_back({lo.x + (hi.x - lo.x) * at.x, lo.z + (hi.z - lo.z) * at.z});
    }
}

/// The outer line of a cornice from below, without its foot and its top at the wall.
std::vector<Vec2> corniceLine(int form) {
    std::vector<Vec2> line;
    const Vec2 lo{.15, .15}, hi{.92, .72};
    line.push_back({.15, 0});
    switch (form) {
        case 1:
            add(line, lo, hi, [](double s) { return Vec2{1 - std::cos(s * pi / 2), std::sin(s * pi / 2)}; });
            break;
        case 2:
            add(line, lo, hi, [](double s) { return Vec2{std::sin(s * pi / 2), 1 - std::cos(s * pi / 2)}; });
            break;
        case 3:
            for (const Vec2 p : {Vec2{.15, .3}, {.5, .3}, {.5, .6}, {.92, .6}, {.92, .72}}) line.push_back(p);
            break;
        case 4:
            line.push_back(lo);
            line.push_back(hi);
            break;
        default:
            add(line, lo, hi, [](double s) { return Vec2{(1 - std::cos(s * pi)) / 2, s}; });
    }
    for (const Vec2 p : {Vec2{1, .72}, {1, 1}}) line.push_back(p);
    return line;
}

/// A line in shares, closed behind the outline, in metres.
std::vector<Vec2> profileOf(const PrimitiveInput& in, std::span<const Vec2> line, double inside_m) {
    const double out_m = in.arguments[0].value[0], height_m = 2 * in.halfValue.y;
    std::vector<Vec2> profile{{-inside_m, 0}};
    for (const Vec2 p : line) profile.push_back({p.x * out_m, p.z * height_m});
    profile.push_back({-inside_m, height_m});
    return profile;
}

}  // namespace

std::string profileFault(const Primitive& row, std::span<const Argument> arguments) {
    if (row.name != "moulding") return {};
    const std::vector<Vec2> points = pointsOf(arguments);
    if (points.size() < 3) return "a moulding has three points or more";
    const plan::Footprint section = plan::footprintOf(plan::polygonOf(points));
    const auto fault = plan::firstFault(section);
    return fault ? "profile of the moulding: " + plan::sentenceOf(*fault, section) : std::string();
}

double standsOut_m(const Primitive& row, std::span<const Argument> arguments, double height_m) {
    if (row.plan == PlanUse::None) return 0;
    double out_m = 0, fascia_m = 1;
    if (row.name == "moulding")
        for (const Vec2 p : pointsOf(arguments)) out_m = std::max(out_m, p.x);
    for (size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view name = row.parameters[i].name;
        const double value = arguments[i].value[0];
        if (name == "out" || name == "overhang") out_m = std::max(out_m, value);
        if (name == "lean" && value < 0) out_m = std::max(out_m, height_m * std::tan(-value));
        if (name == "fascia") fascia_m = value;
    }
    // The curve of a dome comes to nothing at its eaves: only a board stands out there.
    const bool isCurved = row.name == "domeRoof" || row.name == "bellRoof";
    return isCurved && fascia_m <= 0 ? 0 : out_m;
}

namespace solids {

Field taperBlock(const PrimitiveInput& in) {
    const PlanOf plan(in);
    const Argument& lean = in.arguments[0];
    return field::taperedPrism(*plan, {-in.half.y, -in.halfValue.y}, {in.half.y, in.halfValue.y},
                               {lean.node[0], lean.value[0]}, combine(in.path, hashText("taper")));
}

Field shellBlock(const PrimitiveInput& in) {
    const PlanOf plan(in);
    const auto number = [&](size_t i) { return Quantity{in.arguments[i].node[0], in.arguments[i].value[0]}; };
    return field::shell(*plan, {-in.half.y, -in.halfValue.y}, {in.half.y, in.halfValue.y}, number(0), number(1),
                        number(2), combine(in.path, hashText("shell")));
}

Field moulding(const PrimitiveInput& in) { return swept(in, pointsOf(in.arguments)); }

Field corniceMoulding(const PrimitiveInput& in) {
    const std::vector<Vec2> line = corniceLine(static_cast<int>(in.arguments[1].value[0]));
    return swept(in, profileOf(in, line, in.arguments[2].value[0]));
}

Field plinthMoulding(const PrimitiveInput& in) {
    const double slope = in.arguments[1].value[0];
    std::vector<Vec2> line{{1, 0}};
    if (slope < 1) line.push_back({1, 1 - slope});
    if (slope > 0)
        line.push_back({0, 1});
    else
        line.back() = {1, 1};
    return swept(in, profileOf(in, line, in.arguments[2].value[0]));
}

Field stringMoulding(const PrimitiveInput& in) {
    constexpr Vec2 line[] = {{0, 0}, {1, .3}, {1, .7}, {0, 1}};
    return swept(in, profileOf(in, line, in.arguments[1].value[0]));
}

Field sillMoulding(const PrimitiveInput& in) {
    constexpr Vec2 line[] = {{.8, 0}, {.8, .15}, {1, .15}, {1, .6}, {0, 1}};
    return swept(in, profileOf(in, line, in.arguments[1].value[0]));
}

// The trough is as wide as it stands out; its back lies at the outline and reaches behind it by the sheet's thickness.
Field gutterMoulding(const PrimitiveInput& in) {
    const double out_m = in.arguments[0].value[0], height_m = 2 * in.halfValue.y,
                 sheet_m = std::min({in.arguments[1].value[0], out_m / 3, height_m / 3});
    constexpr int pieces = 12;
    std::vector<Vec2> profile;
    const auto arc = [&](double in_m, int i) {
        const double a = pi * i / pieces, r = out_m / 2 - in_m;
        return Vec2{out_m / 2 - std::cos(a) * r, height_m - std::sin(a) * (height_m - in_m)};
    };
    for (int i = 0; i <= pieces; ++i) profile.push_back(arc(0, i));
    for (int i = pieces; i >= 0; --i) profile.push_back(arc(sheet_m, i));
    for (Vec2& p : profile) p.x -= sheet_m / 2;
    return swept(in, profile);
}

}  // namespace solids

}  // namespace sgm::field
