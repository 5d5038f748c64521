#include "grammar/rules/roads.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/conventions.h"
#include "modeler/town/own_streets.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

constexpr RoadField fields[] = {
    {"pull", &Roads::pull, Want::Number,
     "what highways seek: the density of people; where it is greatest growth begins"},
    {"spread", &Roads::spread, Want::Truth, "where streets grow on"},
    {"water", &Roads::water, Want::Truth, "where roads need bridges, and nothing is built"},
    {"park", &Roads::park, Want::Truth, "where neither roads nor lots may be"},
    {"height", &Roads::height, Want::Length, "of the ground, which `slope` limits along a road"},
    {"grid", &Roads::grid, Want::Number, "of the field: weight of the directions of `axis`; 1 where none is said"},
    {"rings", &Roads::rings, Want::Number, "of the field: weight of rings and rays about `centre`"},
    {"shore", &Roads::shore, Want::Number, "of the field: weight of the banks of water, within `reach` of it"},
    {"contours", &Roads::contours, Want::Number,
     "of the field: weight of the level lines of `height`, whole where it is as steep as `slope`"},
};

constexpr RoadField points[] = {
    {"from", &Roads::from, Want::Anything, "where growth begins, (x, z); else where `pull` is greatest"},
    {"centre", &Roads::centre, Want::Anything, "the middle of the radial pattern; else where growth begins"},
};

constexpr std::string_view patterns[] = {"grown", "raster", "radial", "field"}, turns[] = {"left", "right", "both"},
                           ends[] = {"prune", "join", "keep"};

constexpr RoadWord words[] = {
    {"pattern", &Roads::pattern, patterns,
     "highways seek what pulls them, or all roads follow a raster, or rings and rays, or a tensor field of the weights "
     "above"},
    {"turns", &Roads::turns, turns, "to which side streets branch, seen from above"},
    {"ends", &Roads::ends, ends, "dead ends are taken away, prolonged to the next road or taken away, or kept"},
};

Want wantOf(town::RoadParameter::Unit unit) {
    using Unit = town::RoadParameter::Unit;
    return unit == Unit::Length  ? Want::Length
           : unit == Unit::Angle ? Want::Angle
           : unit == Unit::Count ? Want::Count
                                 : Want::Number;
}

Expr checkRoadWord(CheckContext& ctx, Place& place, const Written& e, const RoadWord& row) {
    const std::vector<std::string> known(row.words.begin(), row.words.end());
    if (e.kind == Written::Kind::Name && std::find(known.begin(), known.end(), e.text) != known.end() &&
        !ctx.names.params.contains(e.text))
        return makeConstant(e.span, makeWord(e.text));
    if (e.kind == Written::Kind::Name && !ctx.names.params.contains(e.text)) {
        failUnknown(ctx, e.span, e.text,
                    fmt::format("'{}' is one of {}, not '{}'", row.name, fmt::join(known, ", "), e.text),
                    nearestHint(e.text, known));
        return makeUnreadable(e.span);
    }
    Typed value = checkExpression(ctx, place, e);
    const auto* offered = value.type.words;
    const bool good = offered && std::all_of(offered->begin(), offered->end(), [&](const std::string& w) {
                          return std::find(known.begin(), known.end(), w) != known.end();
                      });
    if (!good && value.type.known)
        ctx.diagnostics.error(
            e.span, fmt::format("'{}' is one of {}, not {}", row.name, fmt::join(known, ", "), describe(value.type)));
    return std::move(value.expr);
}

Expr checkRoadPoint(CheckContext& ctx, Place& place, const Written& e, std::string_view name) {
    Typed point = checkExpression(ctx, place, e);
    const Value& like = point.type.like;
    const auto length = [](Unit u) { return u == Unit::None || u == Unit::Metre; };
    if (point.type.known &&
        !(like.kind == Value::Kind::Vector && like.count == 2 && length(like.units[0]) && length(like.units[1])))
        ctx.diagnostics.error(e.span, fmt::format("'{}' is a place (x, z), not {}", name, describe(point.type)),
                              "write '(-120m, 40m)'");
    return std::move(point.expr);
}

void checkRoadNumber(CheckContext& ctx, Place& place, const syntax::Setting& written, const town::RoadParameter& row,
                     Roads& out) {
    Expr value = checkExpression(ctx, place, written.value, wantOf(row.unit), fmt::format("'{}'", row.name));
    if (const auto number = fold(value, ctx.params.defaults);
        number && !(number->num() >= row.lo && number->num() <= row.hi))
        ctx.diagnostics.error(written.value.span,
                              fmt::format("'{}' is {}, but must be {}", row.name, toText(*number), row.range));
    out.numbers.emplace_back(&row, std::move(value));
}

/// Warns of heights that are a grey picture without `as`: hills of 1 m are hardly meant.
void warnOfUnscaledHeights(CheckContext& ctx, const Expr& height) {
    if (height.kind != Expr::Kind::Map) return;
    const Map& map = ctx.grammar.maps[height.index];
    const bool isGrey = map.picture.raster && map.picture.words.empty() && map.picture.raster->numbers.empty();
    if (isGrey && map.like.units[0] == Unit::None && map.picture.black.num() == 0 && map.picture.white.num() == 1)
        ctx.diagnostics.warning(height.span, "the picture's heights are 0m where it is black and 1m where it is white",
                                "say the heights behind the picture, as in 'as 0m..80m'");
}

void checkRoadSetting(CheckContext& ctx, Place& place, const syntax::Setting& written, Roads& out) {
    const std::string& name = written.name.text;
    place.enter("roads." + name);
    for (const RoadField& row : fields)
        if (row.name == name) {
            out.*row.field = checkExpression(ctx, place, written.value, row.want, fmt::format("'{}'", name));
            if (name == "height") warnOfUnscaledHeights(ctx, *(out.*row.field));
            return;
        }
    for (const RoadField& row : points)
        if (row.name == name) {
            out.*row.field = checkRoadPoint(ctx, place, written.value, name);
            return;
        }
    for (const RoadWord& row : words)
        if (row.name == name) {
            out.*row.field = checkRoadWord(ctx, place, written.value, row);
            return;
        }
    for (const town::RoadParameter& row : town::roadParameters())
        if (row.name == name) return checkRoadNumber(ctx, place, written, row, out);
    std::vector<std::string> known;
    for (const RoadField& row : fields) known.emplace_back(row.name);
    for (const RoadField& row : points) known.emplace_back(row.name);
    for (const RoadWord& row : words) known.emplace_back(row.name);
    for (const town::RoadParameter& row : town::roadParameters()) known.emplace_back(row.name);
    const std::string near = nearestHint(name, known);
    ctx.diagnostics.error(written.name.span, fmt::format("roads have no '{}'", name),
                          near.empty() ? fmt::format("what they have: {}", fmt::join(known, ", ")) : near);
}

}  // namespace

std::span<const RoadField> roadFields() { return fields; }

std::span<const RoadField> roadPoints() { return points; }

std::span<const RoadWord> roadWords() { return words; }

void declareRoads(CheckContext& ctx, const syntax::RoadsDecl& decl) {
    if (isDeclaredTwice(ctx, ctx.seen.roads, decl.name, "roads")) return;
    Roads out;
    out.name = decl.name.text;
    out.span = decl.span;
    if (decl.file) {  // `from "streets.geojson"`: what is there before roads grow
        out.streetsSpan = decl.file->span;
        out.streets = ctx.files.readStreets(*decl.file);
    }
    ctx.grammar.roads.push_back(std::move(out));
}

void checkRoads(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.roads) {
        const auto found = std::find_if(ctx.grammar.roads.begin(), ctx.grammar.roads.end(),
                                        [&](const Roads& r) { return r.name == decl.name.text; });
        if (found == ctx.grammar.roads.end() || found->span.begin != decl.span.begin) continue;
        std::map<std::string, SourceSpan> seen;
        Place place(Place::Where::Guard);
        for (const syntax::Setting& written : decl.settings)
            if (!written.name.empty() && !isDeclaredTwice(ctx, seen, written.name, "setting"))
                checkRoadSetting(ctx, place, written, *found);
    }
}

}  // namespace sgm::rules
