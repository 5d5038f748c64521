// The parameters of blocks, mouldings and roofs over footprints.
// Enters: nothing. Leaves: lists that rows of the primitive table name. For the source of that table alone.
#pragma once

#include "modeler/core/conventions.h"
#include "modeler/field/primitives.h"

namespace sgm::field::plan_parameters {

using Kind = ParameterKind;

// Roofs over a footprint.
inline constexpr PrimitiveParameter pitch{"pitch",  Kind::Angle,   35 * pi / 180,
                                          pi / 180, 85 * pi / 180, "slope of its planes from the level"};
inline constexpr PrimitiveParameter overhang{"overhang", Kind::Length, 0, 0, 20, "metres that the eaves stand out"};
inline constexpr PrimitiveParameter fascia{"fascia", Kind::Length, 0, 0, 5, "height of the upright board at the eaves"};
inline constexpr PrimitiveParameter thickness(std::string_view name, double fallback, double lo, double hi,
                                              std::string_view doc) {
    return {name, Kind::Length, fallback, lo, hi, doc, {}, false, true};
}
inline constexpr PrimitiveParameter cover =
    thickness("cover", 0, 0, 5, "thickness of a roof that is open below; 0 fills it");
inline constexpr PrimitiveParameter ends{
    "ends",
    Kind::Choice,
    0,
    0,
    3,
    "which walls go up to the ridge: where it ends over them, those toward x or z, or all",
    "auto|x|z|all"};
inline constexpr PrimitiveParameter lower{"lower",  Kind::Angle,   70 * pi / 180,
                                          pi / 180, 89 * pi / 180, "slope of the lower planes"};
inline constexpr PrimitiveParameter breakAt{"height", Kind::Length, 3,
                                            .01,      100,          "height at which the upper planes begin"};
inline constexpr PrimitiveParameter upper{"upper",  Kind::Angle,   22 * pi / 180,
                                          pi / 180, 85 * pi / 180, "slope of the upper planes"};
inline constexpr PrimitiveParameter hipParameters[] = {pitch, overhang, fascia, cover};
inline constexpr PrimitiveParameter gableParameters[] = {pitch, overhang, fascia, cover, ends};
inline constexpr PrimitiveParameter halfHipParameters[] = {
    pitch, overhang, fascia,
    cover, ends,     {"share", Kind::Share, .5, 0, 1, "of a gable's height at which its hip begins"}};
inline constexpr PrimitiveParameter mansardParameters[] = {lower, breakAt, upper, overhang, fascia, cover};
inline constexpr PrimitiveParameter gambrelParameters[] = {lower, breakAt, upper, overhang, fascia, cover, ends};
inline constexpr PrimitiveParameter saltboxParameters[] = {
    {"front", Kind::Angle, 45 * pi / 180, pi / 180, 85 * pi / 180, "slope of planes toward +z"},
    {"back", Kind::Angle, 25 * pi / 180, pi / 180, 85 * pi / 180, "slope of the others"},
    overhang,
    fascia,
    cover,
    ends};
inline constexpr PrimitiveParameter shedParameters[] = {
    pitch,
    overhang,
    fascia,
    cover,
    {"to", Kind::Choice, 0, 0, 3, "the side toward which it rises", "back|front|left|right"}};
inline constexpr PrimitiveParameter butterflyParameters[] = {
    pitch, overhang, fascia, cover, {"valley", Kind::Choice, 0, 0, 1, "the direction of its valley", "x|z"}};
inline constexpr PrimitiveParameter flatParameters[] = {
    {"slab", Kind::Length, .3, .001, 20, "thickness of the roof"},
    {"parapet", Kind::Length, .9, 0, 20, "height of the parapet above it; 0 for none"},
    thickness("thickness", .25, .001, 20, "of the parapet")};
inline constexpr PrimitiveParameter pyramidRoofParameters[] = {
    {"overhang", Kind::Length, 0, 0, 20,
     "metres that the eaves of its flattest slope stand out; steeper ones come down as far and stand out less"},
    fascia};
inline constexpr PrimitiveParameter curvedRoofParameters[] = {
    {"overhang", Kind::Length, 0, 0, 20,
     "metres that the board at the eaves stands out; nothing without a fascia, for the curve comes to nothing there"},
    fascia};

inline constexpr double noPoint = 1000;  // metres: a point of a moulding that was left out
inline constexpr PrimitiveParameter point(std::string_view name, std::string_view doc) {
    return {name, Kind::Point, noPoint, -100, noPoint, doc, {}, true};
}
inline constexpr PrimitiveParameter mouldingParameters[] = {
    point("a",
          "metres outward of the outline (inward where negative) and up; three points or more, or none for a band"),
    point("b", "the next one"),
    point("c", "the next one, if there is one"),
    point("d", "the next one, if there is one"),
    point("e", "the next one, if there is one"),
    point("f", "the next one, if there is one"),
    point("g", "the next one, if there is one"),
    point("h", "the next one, if there is one"),
    point("i", "the next one, if there is one"),
    point("j", "the next one, if there is one"),
    point("k", "the next one, if there is one"),
    point("l", "the next one, if there is one")};
inline constexpr PrimitiveParameter out(double fallback) {
    return {"out", Kind::Length, fallback, .001, 20, "how far it stands out"};
}
inline constexpr PrimitiveParameter inside{
    "inside", Kind::Length, .1, .001, 20, "how far it reaches behind the outline, into the wall"};
inline constexpr PrimitiveParameter corniceParameters[] = {
    out(.4), {"form", Kind::Choice, 0, 0, 4, "its curve from below", "cyma|cove|ovolo|steps|slope"}, inside};
inline constexpr PrimitiveParameter plinthParameters[] = {
    out(.12), {"slope", Kind::Share, .2, 0, 1, "of its height that leans back to the wall"}, inside};
inline constexpr PrimitiveParameter stringParameters[] = {out(.08), inside};
inline constexpr PrimitiveParameter gutterParameters[] = {out(.16),
                                                          thickness("thickness", .02, .001, 1, "of its sheet")};
inline constexpr PrimitiveParameter shellParameters[] = {
    thickness("wall", .3, .001, 20, "thickness of the walls"),
    {"floor", Kind::Length, .2, 0, 20, "of the floor; 0 for none"},
    {"ceiling", Kind::Length, 0, 0, 20, "of the ceiling; 0 for none"}};
inline constexpr PrimitiveParameter taperParameters[] = {
    {"lean", Kind::Angle, 5 * pi / 180, -80 * pi / 180, 80 * pi / 180, "of the sides, inward; outward where negative"}};

}  // namespace sgm::field::plan_parameters
