// Attributes: uses of operations, checked as their rows ask.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::rules {

using Written = syntax::Expr;

namespace {

/// What other programs call faces.
constexpr std::pair<std::string_view, std::string_view> sides[] = {
    {"top", "+y"},  {"up", "+y"},    {"bottom", "-y"}, {"down", "-y"},      {"right", "+x"},
    {"left", "-x"}, {"front", "+z"}, {"back", "-z"},   {"middle", "centre"}};

}  // namespace

/// A joint by name, or a value that is a direction: a local, or one that `with` sets.
Expr Checker::joint(Place& place, const Written& e) {
    const bool local =
        std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == e.text; });
    const bool inherited = withNames_.contains(e.text) && !jointNames_.contains(e.text);
    if (e.kind == Written::Kind::Name && axisNumber(e.text) < 0 && !local && !inherited) {
        Expr word = makeConstant(e.span, makeWord(e.text));
        if (jointNames_.contains(e.text)) return word;
        std::vector<std::string> known(jointNames_.begin(), jointNames_.end());
        for (const auto& l : place.locals) known.push_back(l.name);
        std::string hint = nearest(e.text, known);
        if (hint.empty() && (e.text == "x" || e.text == "y" || e.text == "z"))
            hint = fmt::format("write '+{0}' or '-{0}'", e.text);
        for (const auto& [side, axis] : sides)
            if (e.text == side) hint = fmt::format("joints are +x -x +y -y +z -z and centre; here '{}'", axis);
        if (hint.empty()) hint = "joints are +x -x +y -y +z -z, centre, and those that a terminal declares";
        unknown(e.span, e.text, fmt::format("unknown joint '{}'", e.text), std::move(hint));
        return word;
    }
    if (e.kind != Written::Kind::Choose) return expression(place, e, Want::Axis, "a joint");
    Expr chosen = chance(place, e);
    for (size_t i = 0; i + 1 < e.args.size(); i += 2) {
        chosen.args.push_back(weight(place, e.args[i]));
        chosen.args.push_back(joint(place, e.args[i + 1]));
    }
    return chosen;
}

/// Operations that speak of another one come last: it may stand behind them.
std::vector<Attribute> Checker::attributes(Place& place, Element& element,
                                           const std::vector<syntax::Attribute>& written) {
    std::vector<Attribute> result;
    OperationChecker checker(*this, place, element, result);
    std::vector<const Operation*> seen;
    for (const syntax::Attribute& a : written) {
        if (!a.operation->repeatable && std::find(seen.begin(), seen.end(), a.operation) != seen.end())
            diagnostics_.error(a.span, fmt::format("'{}' is given twice", a.name.text), "say it once");
        seen.push_back(a.operation);
    }
    using Phase = Operation::Phase;
    for (const bool details : {false, true})
        for (const syntax::Attribute& a : written)
            if (a.operation->phase != Phase::Content && (a.operation->phase == Phase::Detail) == details)
                a.operation->check ? a.operation->check(checker, a) : checker.checkArguments(a);
    return result;
}

}  // namespace sgm::rules
