#include "grammar/rules/functions.h"

#include <algorithm>
#include <array>

namespace sgm::rules {
namespace {

constexpr uint8_t many = 16;
constexpr std::array<Function, 29> table = {{
    {"min", Fn::Min, 1, many, Signature::Alike, "the least of its arguments, or of one vector's components"},
    {"max", Fn::Max, 1, many, Signature::Alike, "the greatest of its arguments, or of one vector's components"},
    {"abs", Fn::Abs, 1, 1, Signature::Alike, "without its sign"},
    {"floor", Fn::Floor, 1, 1, Signature::Alike, "the whole number below"},
    {"ceil", Fn::Ceil, 1, 1, Signature::Alike, "the whole number above"},
    {"round", Fn::Round, 1, 1, Signature::Alike, "the nearest whole number"},
    {"clamp", Fn::Clamp, 3, 3, Signature::Alike, "clamp(x, lo, hi): x, no less than lo and no more than hi"},
    {"sqrt", Fn::Sqrt, 1, 1, Signature::Root, "square root; of an area it is a length; 0 of a negative number"},
    {"sin", Fn::Sin, 1, 1, Signature::Angle, "sine of an angle"},
    {"cos", Fn::Cos, 1, 1, Signature::Angle, "cosine of an angle"},
    {"tan", Fn::Tan, 1, 1, Signature::Angle, "tangent of an angle"},
    {"atan2", Fn::Atan2, 2, 2, Signature::Alike,
     "atan2(rise, run): the angle whose tangent is rise / run, from -180deg to 180deg"},
    {"pow", Fn::Pow, 2, 2, Signature::Plain, "pow(x, y): x to the power of y; 0 where that is no number"},
    {"lerp", Fn::Lerp, 3, 3, Signature::Lerp, "lerp(a, b, t): from a (t = 0) to b (t = 1)"},
    {"if", Fn::If, 3, 3, Signature::If, "if(condition, a, b): a where the condition holds, else b"},
    {"rotX", Fn::RotX, 1, 1, Signature::Angle, "rotation about x"},
    {"rotY", Fn::RotY, 1, 1, Signature::Angle, "rotation about y"},
    {"rotZ", Fn::RotZ, 1, 1, Signature::Angle, "rotation about z"},
    {"rgb", Fn::Rgb, 3, 3, Signature::Plain, "rgb(r, g, b): a colour from shares 0 … 1, as in #rrggbb"},
    {"bump", Fn::Bump, 2, 2, Signature::Place,
     "bump((x, z), radius): 1 at that place of the plan, falling to 0 at the radius"},
    {"fbm", Fn::Fbm, 2, 3, Signature::Place,
     "fbm(size, octaves, seed): smooth noise over the plan, -1 … 1; the seed is 0 unless said"},
    {"mean", Fn::Mean, 1, 1, Signature::Mean,
     "mean(value): the mean of a map, or of whatever depends on the place, over the plan of the shape's scope"},
    {"overlaps", Fn::Overlaps, 1, 1, Signature::Symbol,
     "overlaps(Name), in a rule's 'when': whether a shape of that name shares volume with this one"},
    {"touches", Fn::Touches, 1, 1, Signature::Symbol, "touches(Name): whether one meets it or shares volume with it"},
    {"inside", Fn::Inside, 1, 1, Signature::Symbol, "inside(Name): whether one holds it whole"},
    {"outlines", Fn::FileNumber, 1, 1, Signature::File,
     "outlines(\"lots.geojson\"): how many outlines a file has, for `for k in 1..outlines(…)`"},
    {"value", Fn::FileNumber, 2, 2, Signature::Property,
     "value(\"height\", 8m): the number that a file says of the outline on which the shape stands, else the second"},
    {"word", Fn::FileWord, 2, 2, Signature::Property,
     "word(\"roof:shape\", gabled): the word that a file says of it, else the second"},
    {"count", Fn::Count, 1, 1, Signature::Symbol, "count(Name): how many shapes of that name there are"},
}};

}  // namespace

std::span<const Function> functions() { return table; }

const Function* findFunction(std::string_view name) {
    const auto row = std::find_if(table.begin(), table.end(), [&](const Function& f) { return f.name == name; });
    return row == table.end() ? nullptr : &*row;
}

}  // namespace sgm::rules
