#include "grammar/rules/maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/make.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

constexpr int likeness = 12;         // of 255, by channel
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

}  // namespace

Value valueAt(const MapPicture& picture, plan::Vec2 p) {
    const double u = p.x / picture.over_m.x + .5, v = p.z / picture.over_m.z + .5;
    if (picture.words.empty()) return interpolate(picture.black, picture.white, picture.raster->greyAt(u, v));
    const auto color = picture.raster->colorAt(u, v);
    const auto nearest = std::min_element(
        picture.classes.begin(), picture.classes.end(),
        [&](const auto& a, const auto& b) { return differenceOf(a.color, color) < differenceOf(b.color, color); });
    const bool found =
        nearest != picture.classes.end() && (!picture.otherwise || differenceOf(nearest->color, color) <= likeness);
    return makeWord(picture.words[found ? nearest->word : picture.otherwise.value_or(0)]);
}

void Checker::declareMap(const syntax::MapDecl& decl) {
    if (twice(seenMaps_, decl.name, "map")) return;
    if (params_.contains(decl.name.text))
        diagnostics_.error(decl.name.span, fmt::format("'{}' is a parameter already", decl.name.text));
    maps_.emplace(decl.name.text, static_cast<uint32_t>(grammar_.maps.size()));
    Map map;
    map.name = decl.name.text;
    map.span = decl.span;
    grammar_.maps.push_back(std::move(map));
    mapIsKnown_.push_back(false);
    mapCost_.push_back(1);
}

void Checker::mapClasses(const syntax::MapDecl& decl, MapPicture& picture) {
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
    if (decl.range) diagnostics_.error(decl.range->span, "a map has a range or classes, not both", "leave 'as …' out");
}

/// `as 0m..80m`: what black and white stand for.
void Checker::mapRange(const syntax::MapDecl& decl, MapPicture& picture) {
    if (!decl.range || decl.range->kind == Written::Kind::Error) return;
    const auto end = [&](size_t i) {
        return decl.range->kind == Written::Kind::Range ? plain(decl.range->args[i], false) : std::nullopt;
    };
    const auto black = end(0), white = end(1);
    if (!black || !white || black->kind != Value::Kind::Number || white->kind != Value::Kind::Number) {
        diagnostics_.error(decl.range->span, "the range of a map is two numbers", "write 'as 0..1' or 'as 0m..80m'");
        return;
    }
    picture.black = *black, picture.white = *white;
    picture.black.integer = picture.white.integer = false;
}

void Checker::mapPicture(const syntax::MapDecl& decl, Map& map) {
    MapPicture& picture = map.picture;
    picture.raster = readFile(load_.picture, decl.file);
    const auto said = picture.raster ? picture.raster->extent_m : std::nullopt;
    const auto over = decl.over ? plain(*decl.over, false) : std::nullopt;
    const bool two = over && over->kind == Value::Kind::Vector && over->count == 2 && over->n[0] > 0 && over->n[1] > 0;
    if (!decl.over && said)
        picture.over_m = *said;
    else if (!two && (!decl.over || decl.over->kind != Written::Kind::Error))
        diagnostics_.error(decl.over ? decl.over->span : decl.name.span,
                           "a map from a file says how much ground it covers", "write 'over (2km, 2km)' behind it");
    if (two) picture.over_m = {over->n[0], over->n[1]};
    if (!decl.classes.empty())
        mapClasses(decl, picture);
    else
        mapRange(decl, picture);
    if (picture.words.empty())
        map.like = interpolate(picture.black, picture.white, .5);
    else
        map.like = makeWord(picture.words[0]);
}

void Checker::maps(const syntax::Ast& ast) {
    for (const auto& decl : ast.maps) {
        const auto found = maps_.find(decl.name.text);
        if (found == maps_.end() || grammar_.maps[found->second].span.begin != decl.span.begin) continue;
        Map& map = grammar_.maps[found->second];
        if (!decl.formula) {
            mapPicture(decl, map);
        } else {
            for (const auto* extra : {&decl.range, &decl.over})
                if (*extra)
                    diagnostics_.error((*extra)->span, "a map that is a formula needs neither range nor extent",
                                       "leave it out");
            Place place(Place::Where::Guard);
            place.ofMap = true;
            Typed formula = expression(place, *decl.formula);
            if (formula.type.known && !formula.type.numeric() && formula.type.like.kind != Value::Kind::Bool)
                failed(decl.formula->span,
                       fmt::format("a map is made of numbers, but this is {}", describe(formula.type)));
            map.like = formula.type.like;
            mapCost_[found->second] = costOf(formula.expr);
            if (mapCost_[found->second] > mostCost)
                diagnostics_.error(decl.formula->span, "this map asks others too often: each asks those above it again",
                                   "ask a map once, and multiply what it says");
            map.formula = std::move(formula.expr);
        }
        mapIsKnown_[found->second] = true;
    }
}

double Checker::costOf(const Expr& e) const {
    double cost = e.kind == Expr::Kind::Map ? mapCost_[e.index] : 1;
    for (const Expr& arg : e.args) cost += costOf(arg);
    return cost;
}

/// The value of a map where the shape stands.
Typed Checker::mapValue(Place& place, const Written& e, uint32_t index) {
    if (place.where < Place::Where::Guard || place.where == Place::Where::Expect)
        return failed(e.span, fmt::format("'{}' is a map, and there is no place here where it could be asked", e.text));
    if (!mapIsKnown_[index])
        return failed(e.span, fmt::format("the map '{}' is declared further down", e.text),
                      "a map asks those above it");
    Typed result;
    result.expr.kind = Expr::Kind::Map;
    result.expr.span = e.span;
    result.expr.index = index;
    const Map& map = grammar_.maps[index];
    result.type = Type::of(map.like);
    if (!map.picture.words.empty()) result.type.words = &map.picture.words;
    return result;
}

/// mean(people): over the plan of the shape's scope.
Typed Checker::meanCall(Place& place, const Written& e) {
    if (place.ofMap || place.where < Place::Where::Guard || place.where == Place::Where::Expect)
        return failed(e.span, "'mean' is over the plan of a shape, and there is none here",
                      "ask in a rule, where a shape stands");
    Typed value = expression(place, e.args[0]);
    if (value.type.known && !value.type.numeric() && value.type.like.kind != Value::Kind::Bool)
        return failed(e.args[0].span, fmt::format("a mean is one of numbers, but this is {}", describe(value.type)),
                      "ask 'mean(land == park)' for the share of a class");
    Typed result;
    result.type = value.type.like.kind == Value::Kind::Bool ? Type::number() : value.type;
    result.expr = makeCall(Expr::Kind::Call, Fn::Mean, e.span, {});
    result.expr.args.push_back(std::move(value.expr));
    return result;
}

}  // namespace sgm::rules
