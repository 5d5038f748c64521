// Attributes: uses of operations, checked as their rows ask.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/bodies.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

/// What other programs call faces.
constexpr std::pair<std::string_view, std::string_view> sides[] = {
    {"top", "+y"},  {"up", "+y"},    {"bottom", "-y"}, {"down", "-y"},      {"right", "+x"},
    {"left", "-x"}, {"front", "+z"}, {"back", "-z"},   {"middle", "centre"}};

}  // namespace

/// The letter of a direction that is written in a capital, '-X': a minus and a name to the parser; 0 for anything else.
static char axisBehindMinus(const CheckContext& ctx, const Place& place, const Written& e) {
    if (e.kind != Written::Kind::Unary || e.text != "-" || e.args[0].kind != Written::Kind::Name) return 0;
    const std::string& name = e.args[0].text;
    const bool isLocal =
        std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == name; });
    const bool isAxis = (name == "X" || name == "Y" || name == "Z") && !ctx.names.inherited.contains(name);
    return isAxis && !isLocal ? static_cast<char>(name[0] - 'A' + 'a') : 0;
}

/// A joint by name, or a value that is a direction: a local, or one that `with` sets.
Expr checkJoint(CheckContext& ctx, Place& place, const Written& e) {
    if (const char axis = axisBehindMinus(ctx, place, e)) {
        ctx.diagnostics.error(e.span, fmt::format("unknown joint '{}'", e.span.text()),
                              fmt::format("write '-{}'", axis));
        return makeConstant(e.span, makeWord("centre"));
    }
    const bool local =
        std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == e.text; });
    const bool inherited = ctx.names.inherited.contains(e.text) && !ctx.names.joints.contains(e.text);
    if (e.kind == Written::Kind::Name && axisNumber(e.text) < 0 && !local && !inherited) {
        Expr word = makeConstant(e.span, makeWord(e.text));
        if (ctx.names.joints.contains(e.text)) return word;
        std::vector<std::string> known(ctx.names.joints.begin(), ctx.names.joints.end());
        for (const auto& l : place.locals) known.push_back(l.name);
        std::string hint = nearestHint(e.text, known);
        if (e.text.size() == 1 && std::string_view("xyzXYZ").find(e.text) != std::string_view::npos)
            hint = fmt::format("write '+{0}' or '-{0}'", static_cast<char>(std::tolower(e.text[0])));
        for (const auto& [side, axis] : sides)
            if (e.text == side) hint = fmt::format("joints are +x -x +y -y +z -z and centre; here '{}'", axis);
        if (hint.empty()) hint = "joints are +x -x +y -y +z -z, centre, and those that a terminal declares";
        failUnknown(ctx, e.span, e.text, fmt::format("unknown joint '{}'", e.text), std::move(hint));
        return word;
    }
    if (e.kind != Written::Kind::Choose) return checkExpression(ctx, place, e, Want::Axis, "a joint");
    Expr chosen = makeDraw(place, e);
    for (size_t i = 0; i + 1 < e.args.size(); i += 2) {
        chosen.args.push_back(checkWeight(ctx, place, e.args[i]));
        chosen.args.push_back(checkJoint(ctx, place, e.args[i + 1]));
    }
    return chosen;
}

Expr checkMaterial(CheckContext& ctx, Place& place, const Written& e) {
    const auto isOther = [&](const std::string& word) {
        const auto local = [&](const auto& l) { return l.name == word; };
        return std::any_of(place.locals.begin(), place.locals.end(), local) || ctx.names.params.contains(word) ||
               ctx.names.lets.contains(word) || ctx.names.inherited.contains(word);
    };
    const auto symbol = ctx.names.symbols.find(e.text);
    const bool known = symbol != ctx.names.symbols.end() && ctx.grammar.symbols[symbol->second].terminal;
    if (e.kind == Written::Kind::Name && !known && !isOther(e.text)) {
        std::vector<std::string> names;
        for (const Symbol& s : ctx.grammar.symbols)
            if (s.terminal) names.push_back(s.name);
        std::string hint = nearestHint(e.text, names);
        if (const std::string file = ctx.files.declaring(e.text); !file.empty())
            hint = fmt::format("it is declared in {0}: write 'use \"{0}\"'", file);
        if (hint.empty()) hint = fmt::format("write 'material {} color #c2b59b' above", e.text);
        return failUnknown(ctx, e.span, e.text, fmt::format("there is no material '{}'", e.text), std::move(hint)).expr;
    }
    place.material = true;
    Typed value = checkExpression(ctx, place, e);
    place.material = false;
    if (value.type.known && value.type.like.kind != Value::Kind::Word)
        return fail(ctx, e.span, fmt::format("'of' takes a material, but this is {}", describe(value.type)),
                    value.type.like.kind == Value::Kind::Color ? fmt::format("write 'color {}'", e.span.text())
                                                               : std::string())
            .expr;
    if (value.type.words)
        for (const std::string& word : *value.type.words)
            if (findMaterial(ctx.grammar, word) == none)
                return fail(ctx, e.span, fmt::format("'{}' may be '{}', and there is no such material", e.text, word))
                    .expr;
    return std::move(value.expr);
}

/// Operations that speak of another one come last: it may stand behind them.
std::vector<Attribute> checkAttributes(CheckContext& ctx, Place& place, Element& element,
                                       const std::vector<syntax::Attribute>& written) {
    std::vector<Attribute> result;
    OperationChecker checker(ctx, place, element, result);
    std::vector<const Operation*> seen;
    for (const syntax::Attribute& a : written) {
        const bool again =
            a.operation->traits.repeatable || (a.operation->traits.stacks && versionOf(ctx.grammar, a.span) >= 2);
        if (!again && std::find(seen.begin(), seen.end(), a.operation) != seen.end())
            ctx.diagnostics.error(a.span, fmt::format("'{}' is given twice", a.name.text),
                                  a.operation->traits.stacks
                                      ? "say it once; 'grammar 2' takes several, one after the other"
                                      : "say it once");
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
