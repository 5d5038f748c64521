#include "grammar/rules/maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/make.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

constexpr int likeness = 12;  // of 255, by channel

constexpr double mostCost = 10'000;  // expressions that one answer of a map may take

std::array<uint8_t, 3> bytesOf(const Written& color) {
    const auto hex = static_cast<uint32_t>(color.number);
    return {static_cast<uint8_t>(hex >> 16), static_cast<uint8_t>(hex >> 8), static_cast<uint8_t>(hex)};
}

/// The greatest difference of a channel.
int differenceOf(const std::array<uint8_t, 3>& a, const std::array<uint8_t, 3>& b) {
    int most = 0;
    for (size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
}

void checkClasses(CheckContext& ctx, const syntax::MapDecl& decl, MapPicture& picture) {
    const auto wordOf = [&](const std::string& word) {
        const auto at = std::find(picture.words.begin(), picture.words.end(), word);
        if (at == picture.words.end()) picture.words.push_back(word);
        return static_cast<uint32_t>(std::find(picture.words.begin(), picture.words.end(), word) -
                                     picture.words.begin());
    };
    for (const auto& c : decl.classes) {
        if (c.color && c.color->kind != Written::Kind::Color) continue;  // the parser spoke of it
        const uint32_t word = wordOf(c.word.text);
        if (c.color)
            picture.classes.push_back({bytesOf(*c.color), word});
        else
            picture.otherwise = word;
    }
    if (decl.range)
        ctx.diagnostics.error(decl.range->span, "a map has a range or classes, not both", "leave 'as …' out");
}

/// `as 0m..80m`: what black and white stand for.
void checkMapRange(CheckContext& ctx, const syntax::MapDecl& decl, MapPicture& picture) {
    if (!decl.range || decl.range->kind == Written::Kind::Error) return;
    const auto end = [&](size_t i) {
        return decl.range->kind == Written::Kind::Range ? plainValue(ctx, decl.range->args[i], false) : std::nullopt;
    };
    const auto black = end(0), white = end(1);
    if (!black || !white || black->kind != Value::Kind::Number || white->kind != Value::Kind::Number) {
        ctx.diagnostics.error(decl.range->span, "the range of a map is two numbers", "write 'as 0..1' or 'as 0m..80m'");
        return;
    }
    picture.black = *black, picture.white = *white;
    picture.black.integer = picture.white.integer = false;
}

void checkPicture(CheckContext& ctx, const syntax::MapDecl& decl, Map& map) {
    MapPicture& picture = map.picture;
    picture.raster = ctx.files.readPicture(decl.file);
    const auto said = picture.raster ? picture.raster->extent_m : std::nullopt;
    const auto over = decl.over ? plainValue(ctx, *decl.over, false) : std::nullopt;
    const bool two = over && over->kind == Value::Kind::Vector && over->count == 2 && over->n[0] > 0 && over->n[1] > 0;
    if (!decl.over && said)
        picture.over_m = *said;
    else if (!two && (!decl.over || decl.over->kind != Written::Kind::Error))
        ctx.diagnostics.error(decl.over ? decl.over->span : decl.name.span,
                              "a map from a file says how much ground it covers", "write 'over (2km, 2km)' behind it");
    if (two) picture.over_m = {over->n[0], over->n[1]};
    if (!decl.classes.empty())
        checkClasses(ctx, decl, picture);
    else
        checkMapRange(ctx, decl, picture);
    if (picture.words.empty())
        map.like = interpolate(picture.black, picture.white, .5);
    else
        map.like = makeWord(picture.words[0]);
}

double costOf(CheckContext& ctx, const Expr& e) {
    double cost = e.kind == Expr::Kind::Map ? ctx.maps.cost[e.index] : 1;
    for (const Expr& arg : e.args) cost += costOf(ctx, arg);
    return cost;
}

}  // namespace

const std::string& wordAt(const MapPicture& picture, plan::Vec2 p) {
    const auto color = picture.raster->colorAt(p.x / picture.over_m.x + .5, p.z / picture.over_m.z + .5);
    std::optional<uint32_t> nearest;
    int least = picture.otherwise ? likeness + 1 : std::numeric_limits<int>::max();
    for (const MapPicture::Class& known : picture.classes)
        if (const int difference = differenceOf(known.color, color); difference < least)
            nearest = known.word, least = difference;
    return picture.words[nearest.value_or(picture.otherwise.value_or(0))];
}

Value valueAt(const MapPicture& picture, plan::Vec2 p) {
    if (!picture.words.empty()) return makeWord(wordAt(picture, p));
    const double u = p.x / picture.over_m.x + .5, v = p.z / picture.over_m.z + .5;
    return interpolate(picture.black, picture.white, picture.raster->greyAt(u, v));
}

void declareMap(CheckContext& ctx, const syntax::MapDecl& decl) {
    if (isDeclaredTwice(ctx, ctx.seen.maps, decl.name, "map")) return;
    if (ctx.names.params.contains(decl.name.text))
        ctx.diagnostics.error(decl.name.span, fmt::format("'{}' is a parameter already", decl.name.text));
    ctx.names.maps.emplace(decl.name.text, static_cast<uint32_t>(ctx.grammar.maps.size()));
    Map map;
    map.name = decl.name.text;
    map.span = decl.span;
    ctx.grammar.maps.push_back(std::move(map));
    ctx.maps.isKnown.push_back(false);
    ctx.maps.cost.push_back(1);
}

void checkMaps(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.maps) {
        const auto found = ctx.names.maps.find(decl.name.text);
        if (found == ctx.names.maps.end() || ctx.grammar.maps[found->second].span.begin != decl.span.begin) continue;
        Map& map = ctx.grammar.maps[found->second];
        if (!decl.formula) {
            checkPicture(ctx, decl, map);
        } else {
            for (const auto* extra : {&decl.range, &decl.over})
                if (*extra)
                    ctx.diagnostics.error((*extra)->span, "a map that is a formula needs neither range nor extent",
                                          "leave it out");
            Place place(Place::Where::Guard);
            place.ofMap = true;
            Typed formula = checkExpression(ctx, place, *decl.formula);
            if (formula.type.known && !formula.type.numeric() && formula.type.like.kind != Value::Kind::Bool)
                fail(ctx, decl.formula->span,
                     fmt::format("a map is made of numbers, but this is {}", describe(formula.type)));
            map.like = formula.type.like;
            ctx.maps.cost[found->second] = costOf(ctx, formula.expr);
            if (ctx.maps.cost[found->second] > mostCost)
                ctx.diagnostics.error(decl.formula->span,
                                      "this map asks others too often: each asks those above it again",
                                      "ask a map once, and multiply what it says");
            map.formula = std::move(formula.expr);
        }
        ctx.maps.isKnown[found->second] = true;
    }
}

/// The value of a map where the shape stands.
Typed checkMapName(CheckContext& ctx, Place& place, const Written& e, uint32_t index) {
    if (place.where < Place::Where::Guard || place.where == Place::Where::Expect)
        return fail(ctx, e.span,
                    fmt::format("'{}' is a map, and there is no place here where it could be asked", e.text));
    if (!ctx.maps.isKnown[index])
        return fail(ctx, e.span, fmt::format("the map '{}' is declared further down", e.text),
                    "a map asks those above it");
    Typed result;
    result.expr.kind = Expr::Kind::Map;
    result.expr.span = e.span;
    result.expr.index = index;
    const Map& map = ctx.grammar.maps[index];
    result.type = Type::of(map.like);
    if (!map.picture.words.empty()) result.type.words = &map.picture.words;
    return result;
}

/// mean(people): over the plan of the shape's scope.
Typed checkMean(CheckContext& ctx, Place& place, const Written& e) {
    if (place.ofMap || place.where < Place::Where::Guard || place.where == Place::Where::Expect)
        return fail(ctx, e.span, "'mean' is over the plan of a shape, and there is none here",
                    "ask in a rule, where a shape stands");
    Typed value = checkExpression(ctx, place, e.args[0]);
    if (value.type.known && !value.type.numeric() && value.type.like.kind != Value::Kind::Bool)
        return fail(ctx, e.args[0].span, fmt::format("a mean is one of numbers, but this is {}", describe(value.type)),
                    "ask 'mean(land == park)' for the share of a class");
    Typed result;
    result.type = value.type.like.kind == Value::Kind::Bool ? Type::number() : value.type;
    result.expr = makeCall(Expr::Kind::Call, Fn::Mean, e.span, {});
    result.expr.args.push_back(std::move(value.expr));
    return result;
}

}  // namespace sgm::rules
