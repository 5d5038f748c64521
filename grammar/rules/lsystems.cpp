// L-systems: settings, axiom and productions.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/letters.h"
#include "grammar/rules/make.h"
#include "grammar/rules/words.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {
namespace {

struct LsystemSetting {
    std::string_view name;
    Expr Lsystem::*field;
    Want want;
    double fallback, lo, hi;
    std::string_view text;
};

constexpr LsystemSetting rows[] = {
    {"passes", &Lsystem::passes, Want::Count, 1, 0, 100, "0 … 100"},
    {"angle", &Lsystem::angle, Want::Angle, 1.5707963267948966, -radians(360), radians(360), "a turn, at most 360deg"},
    {"step", &Lsystem::step, Want::Length, 1, 1e-3, 1e4, "1 mm … 10 km"},
    {"shrink", &Lsystem::shrink, Want::Length, 0, 0, 1e4, "0 … 10 km"},
};

char checkLetter(CheckContext& ctx, const syntax::Name& name) {
    if (name.empty()) return 0;
    if (name.text.size() != 1)
        ctx.diagnostics.error(name.span, fmt::format("a production is about one letter, not '{}'", name.text));
    return name.text[0];
}

/// Letters with their numbers: a turn takes an angle, what steps or widens a length.
void checkModules(CheckContext& ctx, Place& place, const std::vector<syntax::LsystemDecl::Module>& written,
                  std::vector<Lsystem::Module>& out) {
    constexpr std::string_view turns = "+-&^\\/", lengths = "FGfg!";
    for (const auto& module : written) {
        Lsystem::Module& m = out.emplace_back();
        m.letter = module.letter;
        for (size_t i = 0; i < module.args.size(); ++i) {
            const bool first = i == 0;
            const Want want = first && turns.find(m.letter) != turns.npos       ? Want::Angle
                              : first && lengths.find(m.letter) != lengths.npos ? Want::Length
                                                                                : Want::Anything;
            place.enter(fmt::format("{}.{}", m.letter, i));
            m.args.push_back(checkExpression(ctx, place, module.args[i], want, fmt::format("'{}'", module.letter)));
        }
    }
}

/// Brackets of a text of letters belong together.
void checkBrackets(CheckContext& ctx, const std::vector<syntax::LsystemDecl::Module>& written,
                   syntax::SourceSpan span) {
    int open = 0;
    for (const auto& module : written) {
        open += module.letter == '[' ? 1 : module.letter == ']' ? -1 : 0;
        if (open < 0) break;
    }
    if (open == 0) return;
    ctx.diagnostics.error(span, open < 0 ? "a ']' here has no '[' before it" : "a '[' here is never closed",
                          "'[' begins a branch, and ']' takes the turtle back to where it began");
}

void checkProduction(CheckContext& ctx, const syntax::LsystemDecl::Production& written, Lsystem& out) {
    if (written.symbol.empty()) return;
    Lsystem::Production& p = out.productions.emplace_back();
    p.span = written.span;
    p.letter = checkLetter(ctx, written.symbol);
    p.before = checkLetter(ctx, written.before);
    p.behind = checkLetter(ctx, written.behind);
    p.parameters = static_cast<uint32_t>(written.parameters.size());
    Place place(Place::Where::Guard);
    for (const syntax::Name& name : written.parameters) {
        if (ctx.names.params.contains(name.text) || ctx.names.lets.contains(name.text))
            ctx.diagnostics.error(
                name.span,
                fmt::format("'{}' is a value of the file: the letter's number needs another name", name.text));
        place.locals.push_back({name.text, place.frame++, Type::unknown()});
    }
    place.enter("when");
    if (written.when) p.when = checkExpression(ctx, place, *written.when, Want::Truth, "'when'");
    checkModules(ctx, place, written.modules, p.modules);
    checkBrackets(ctx, written.modules, written.span);
    if (!written.weight) return;
    const auto weight = plainValue(ctx, *written.weight, false);
    if (weight && !(weight->kind == Value::Kind::Number && weight->num() >= 0))
        ctx.diagnostics.error(written.weight->span, "the weight of a production is a number no less than 0");
    else if (weight)
        p.weight = weight->num();
}

void checkLsystem(CheckContext& ctx, const syntax::LsystemDecl& decl) {
    const auto found = std::find_if(ctx.grammar.lsystems.begin(), ctx.grammar.lsystems.end(),
                                    [&](const Lsystem& l) { return l.name == decl.name.text; });
    if (found == ctx.grammar.lsystems.end() || found->span.begin != decl.span.begin) return;
    Lsystem& out = *found;
    Place place(Place::Where::Look);
    for (const LsystemSetting& setting : rows)
        out.*setting.field = makeConstant(decl.span, Value::number(setting.fallback));
    for (const syntax::Setting& written : decl.settings) {
        if (written.name.empty()) continue;  // the parser spoke of it
        const auto row =
            std::find_if(std::begin(rows), std::end(rows), [&](const auto& s) { return s.name == written.name.text; });
        if (row == std::end(rows)) {
            std::vector<std::string> known;
            for (const LsystemSetting& s : rows) known.emplace_back(s.name);
            ctx.diagnostics.error(
                written.name.span,
                fmt::format("an lsystem has no '{}', but {}", written.name.text, fmt::join(known, ", ")),
                nearestHint(written.name.text, known));
            continue;
        }
        place.enter("lsystem." + written.name.text);
        Expr value = checkExpression(ctx, place, written.value, row->want, fmt::format("'{}'", row->name));
        if (const auto number = fold(value, ctx.params.defaults);
            number && !(number->num() >= row->lo && number->num() <= row->hi))
            ctx.diagnostics.error(written.value.span,
                                  fmt::format("'{}' is {}, but must be {}", row->name, toText(*number), row->text));
        out.*row->field = std::move(value);
    }
    Place letters(Place::Where::Guard);
    checkModules(ctx, letters, decl.axiomModules, out.axiom);
    checkBrackets(ctx, decl.axiomModules, decl.axiom.span);
    if (out.axiom.empty() && decl.axiom.kind == syntax::Expr::Kind::Text)
        ctx.diagnostics.error(decl.axiom.span, "an axiom has at least one letter", "write 'axiom \"F+F+F+F\"'");
    for (const auto& written : decl.productions) checkProduction(ctx, written, out);
    if (!ctx.diagnostics.hasErrors()) warnOfUnusedProductions(out, ctx.diagnostics);
}

}  // namespace

/// Declares the name, so that rules above it may use it.
void declareLsystem(CheckContext& ctx, const syntax::LsystemDecl& decl) {
    if (isDeclaredTwice(ctx, ctx.seen.lsystems, decl.name, "lsystem")) return;
    Lsystem out;
    out.name = decl.name.text;
    out.span = decl.span;
    ctx.grammar.lsystems.push_back(std::move(out));
}

void checkLsystems(CheckContext& ctx, const syntax::Ast& ast) {
    for (const auto& decl : ast.lsystems) checkLsystem(ctx, decl);
}

}  // namespace sgm::rules
