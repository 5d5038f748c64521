// Starts and rules: their symbols, conditions and bodies.
#include <fmt/format.h>

#include <cctype>
#include <utility>

#include "grammar/rules/bodies.h"
#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

void checkRule(CheckContext& ctx, const syntax::RuleDecl& decl) {
    if (!isNonTerminal(decl.symbol.text)) {
        ctx.diagnostics.error(
            decl.symbol.span,
            fmt::format("rules rewrite shapes whose names begin with a capital, and '{}' doesn't", decl.symbol.text),
            fmt::format("write '{}{}'", static_cast<char>(std::toupper(decl.symbol.text[0])),
                        decl.symbol.text.substr(1)));
        return;
    }
    Rule out;
    out.span = decl.span;
    out.symbolSpan = decl.symbol.span;
    out.symbol = declareSymbol(ctx, decl.symbol);
    out.besideWins = versionOf(ctx.grammar, decl.span) >= 2 && !decl.beside.empty();
    out.name = decl.name.text;
    if (out.name.empty()) out.name = fmt::format("{}#{}", decl.symbol.text, ++ctx.names.unnamedRules[out.symbol]);
    Place guard(Place::Where::Guard);
    const auto condition = [&](const std::optional<Written>& e, const char* word, Want want) -> std::optional<Expr> {
        guard.enter(word);
        return e ? std::optional(checkExpression(ctx, guard, *e, want, fmt::format("'{}'", word))) : std::nullopt;
    };
    out.when = condition(decl.when, "when", Want::Truth);
    out.weight = condition(decl.weight, "weight", Want::Number);
    out.repeat = condition(decl.repeat, "repeat", Want::Count);
    if (out.weight)
        if (const auto weight = fold(*out.weight, ctx.params.defaults); weight && weight->num() < 0)
            ctx.diagnostics.error(out.weight->span, fmt::format("a weight is no less than 0, not {}", toText(*weight)));
    const auto symbolOf = [&](const syntax::Name& name) {
        if (name.empty()) return none;
        if (const auto symbol = findReferenced(ctx, name.text)) return *symbol;
        failUnknown(ctx, name.span, name.text, fmt::format("there is no shape called '{}'", name.text),
                    nearestHint(name.text, symbolNames(ctx, false)));
        return none;
    };
    out.beside = symbolOf(decl.beside);
    out.after = symbolOf(decl.after);
    if (out.after == out.symbol && out.after != none)
        ctx.diagnostics.error(decl.after.span, fmt::format("'{}' would wait for itself", decl.after.text));
    Place place(out.repeat ? Place::Where::Chain : Place::Where::Body);
    if (out.repeat) {
        out.stepLocal = place.frame++;
        place.locals.push_back({"i", out.stepLocal, Type::number(Unit::None, true), true});
    }
    out.body = checkBody(ctx, place, decl.body);
    out.morphic = std::exchange(place.morphs, false);
    if (decl.finally_) {
        if (!out.repeat)
            ctx.diagnostics.error(decl.finally_->span, "'finally' closes a chain, and there is none here",
                                  "give the rule a 'repeat'");
        place.where = Place::Where::Finally;
        place.locals.clear();
        out.finally_ = checkBody(ctx, place, *decl.finally_);
        out.finallyMorphic = place.morphs;
    }
    out.locals = place.frame;
    ctx.names.rules.emplace(out.name, static_cast<uint32_t>(ctx.grammar.rules.size()));
    ctx.grammar.symbols[out.symbol].rules.push_back(static_cast<uint32_t>(ctx.grammar.rules.size()));
    ctx.grammar.rules.push_back(std::move(out));
}

void checkStart(CheckContext& ctx, const syntax::StartDecl& decl) {
    if (!isNonTerminal(decl.symbol.text)) {
        ctx.diagnostics.error(decl.symbol.span,
                              fmt::format("a start's name begins with a capital, and '{}' doesn't", decl.symbol.text));
        return;
    }
    Place place(Place::Where::Body);
    Start out;
    out.span = decl.span;
    out.symbol = declareSymbol(ctx, decl.symbol);
    out.body = checkBody(ctx, place, decl.body);
    out.locals = place.frame;
    if (out.body.grows)
        ctx.diagnostics.error(decl.body.span, "a start begins with a shape: nothing stands yet that could grow",
                              "leave the operator out");
    for (const auto& chain : out.body.siblings)
        for (const Element& e : chain)
            if (e.op == Operator::None && e.content.solid()) expectBounded(ctx, *e.content.solid(), "a start");
    ctx.grammar.starts.push_back(std::move(out));
}

}  // namespace

void checkProductions(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.starts) checkStart(ctx, decl);
    for (const auto& decl : ast.rules) checkRule(ctx, decl);
}

}  // namespace sgm::rules
