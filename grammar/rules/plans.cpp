#include "grammar/rules/plans.h"

#include <algorithm>
#include <cmath>

#include "modeler/plan/shapes.h"

namespace sgm::rules {
namespace {

using Kind = PlanParameterKind;
using Arguments = std::span<const double>;

constexpr PlanParameter width{"width", Kind::Length, 0, "along x"};
constexpr PlanParameter depth{"depth", Kind::Length, 0, "along z"};
constexpr PlanParameter wing{"wing", Kind::Length, 0, "depth of the wings round the yard"};
constexpr PlanParameter radius{"radius", Kind::Length, 0, "of the circle round it; left out: it fills the scope",
                               false};

constexpr PlanParameter rectParameters[] = {width, depth};
constexpr PlanParameter ellParameters[] = {width,
                                           depth,
                                           {"wingX", Kind::Length, 0, "depth of the wing along x"},
                                           {"wingZ", Kind::Length, 0, "width of the wing along z"}};
constexpr PlanParameter teeParameters[] = {width,
                                           depth,
                                           {"bar", Kind::Length, 0, "depth of the bar along its -z side"},
                                           {"stem", Kind::Length, 0, "width of the stem"}};
constexpr PlanParameter yardParameters[] = {width, depth, wing};
constexpr PlanParameter ngonParameters[] = {{"sides", Kind::Count, 6, "3 or more"}, radius};
constexpr PlanParameter roundParameters[] = {{"sides", Kind::Count, 24, "that stand for the circle", false}, radius};
constexpr PlanParameter arcParameters[] = {{"inner", Kind::Length, 0, "radius of the inner side"},
                                           {"outer", Kind::Length, 0, "radius of the outer side"},
                                           {"from", Kind::Angle, 0, "where it begins, from +x towards +z"},
                                           {"to", Kind::Angle, 0, "where it ends"},
                                           {"segments", Kind::Count, 16, "chords along each side", false}};

int whole(double n) { return static_cast<int>(std::clamp(n, -1e6, 1e6)); }
/// A radius of 0 draws a circle of radius 1, which is then stretched into the scope.
double radiusOf(double r) { return r == 0 ? 1 : r; }

constexpr PlanRow table[] = {
    {"rect", "A rectangle.", "footprint rect(12, 8)", rectParameters,
     [](Arguments n) { return plan::rectangle(n[0], n[1]); }},
    {"ell", "An L: the rectangle less its quarter at +x +z.", "footprint ell(16, 12, 5, 6)", ellParameters,
     [](Arguments n) { return plan::ell(n[0], n[1], n[2], n[3]); }},
    {"tee", "A T: a bar along the -z side and a stem from its middle.", "footprint tee(16, 12, 5, 6)", teeParameters,
     [](Arguments n) { return plan::tee(n[0], n[1], n[2], n[3]); }},
    {"yard", "A U that is open towards +z.", "footprint yard(20, 16, 5)", yardParameters,
     [](Arguments n) { return plan::yard(n[0], n[1], n[2]); }},
    {"ring", "A rectangle with a court.", "footprint ring(30, 24, 7)", yardParameters,
     [](Arguments n) { return plan::ring(n[0], n[1], n[2]); }},
    {"ngon", "A regular polygon, one side towards -z.", "footprint ngon(8)", ngonParameters,
     [](Arguments n) { return plan::ngon(whole(n[0]), radiusOf(n[1])); }, 1},
    {"round", "A circle's area as a polygon.", "footprint round(24, 5m)", roundParameters,
     [](Arguments n) { return plan::round(whole(n[0]), radiusOf(n[1])); }, 1},
    {"arc", "A piece of a ring; its edges are tagged outer, inner and end.", "footprint arc(33m, 44m, 15deg, 130deg)",
     arcParameters, [](Arguments n) { return plan::arc(n[0], n[1], n[2], n[3], whole(n[4])); }},
};

}  // namespace

std::span<const PlanRow> planRows() { return table; }

const PlanRow* findPlan(std::string_view name) {
    const auto row = std::find_if(std::begin(table), std::end(table), [&](const PlanRow& r) { return r.name == name; });
    return row == std::end(table) ? nullptr : row;
}

}  // namespace sgm::rules
