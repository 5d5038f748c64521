#include "grammar/derive/map_values.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/builder.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/plan/edit.h"
#include "modeler/town/noise.h"

namespace sgm::derive {

using rules::Expr;
using rules::Fn;
using rules::Value;

namespace {

plan::Vec2 planPlaceOf(const Place& place) { return {place.scope.centre.x, place.scope.centre.z}; }

}  // namespace

Value ofPlace(Fn fn, const Expr& expr, const Place& place) {
    const plan::Vec2 p = planPlaceOf(place);
    if (fn == Fn::Bump) {
        const Value centre = evaluate(expr.args[0], place);
        return Value::number(town::bump(p, {centre.n[0], centre.n[1]}, number(expr.args[1], place)));
    }
    const double size_m = std::max(1e-3, number(expr.args[0], place)),
                 octaves = std::clamp(number(expr.args[1], place), 1.0, 12.0);
    const double seed = expr.args.size() > 2 ? std::clamp(number(expr.args[2], place), -1e15, 1e15) : 0;
    return Value::number(
        town::fbmNoise(p, size_m, static_cast<int>(octaves), static_cast<uint64_t>(static_cast<int64_t>(seed))));
}

Value ofMap(const Expr& expr, const Place& place) {
    if (!place.builder) return {};
    const rules::Map& map = place.builder->derivation().grammar->maps[expr.index];
    if (place.builder->derivation().isPlaced) {
        place.builder->monitor().fail(
            Error::Kind::Input,
            fmt::format("the map '{}' is of the ground, and an object that 'place' puts stands on none: "
                        "hand its value down as a parameter, 'place … {{ share = {} }}'",
                        map.name, map.name),
            expr.span);
        return {};
    }
    return map.formula ? evaluate(*map.formula, place) : rules::valueAt(map.picture, planPlaceOf(place));
}

Value meanOf(const Expr& value, const Place& place) {
    constexpr int steps = 16;  // along each side of the plan's box
    if (!place.tree) return Value::number(0);
    const plan::Footprint land = footprintOf(place.scope, place.tree->footprints);
    const plan::Box2 box = bounds(land);
    Place there = place;
    Value mean = evaluate(value, place);
    if (mean.kind == Value::Kind::Bool) mean = Value::number(mean.num());
    const auto ask = [&](plan::Vec2 p) {
        there.scope.centre = place.scope.centre + place.scope.axes * Vec3d{p.x, 0, p.z};
        return number(value, there);
    };
    double sum = 0;
    int count = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const plan::Vec2 p = box.lo + plan::Vec2{box.size().x * (i + .5) / steps, box.size().z * (k + .5) / steps};
            if (contains(land, p)) sum += ask(p), ++count;
        }
    if (count > 0) mean.n[0] = sum / count;
    mean.integer = false;
    return mean;
}

std::optional<bool> isOfClass(const Expr& comparison, const Place& place) {
    const Expr &asked = comparison.args[0], &word = comparison.args[1];
    if (!place.builder || place.builder->derivation().isPlaced || asked.kind != Expr::Kind::Map ||
        word.kind != Expr::Kind::Constant || word.value.kind != Value::Kind::Word)
        return std::nullopt;
    const rules::Map& map = place.builder->derivation().grammar->maps[asked.index];
    if (map.formula || map.picture.words.empty()) return std::nullopt;
    return rules::wordAt(map.picture, planPlaceOf(place)) == word.value.text;
}

}  // namespace sgm::derive
