// L-systems: settings, axiom and productions.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/make.h"

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
    {"angle", &Lsystem::angle, Want::Angle, 1.5707963267948966, -7, 7, "a turn, at most 360deg"},
    {"step", &Lsystem::step, Want::Length, 1, 1e-3, 1e4, "1 mm … 10 km"},
    {"shrink", &Lsystem::shrink, Want::Length, 0, 0, 1e4, "0 … 10 km"},
};

}  // namespace

/// Declares the name, so that rules above it may use it.
void Checker::declareLsystem(const syntax::LsystemDecl& decl) {
    if (twice(seenLsystems_, decl.name, "lsystem")) return;
    Lsystem out;
    out.name = decl.name.text;
    out.span = decl.span;
    grammar_.lsystems.push_back(std::move(out));
}

void Checker::lsystem(const syntax::LsystemDecl& decl) {
    const auto found = std::find_if(grammar_.lsystems.begin(), grammar_.lsystems.end(),
                                    [&](const Lsystem& l) { return l.name == decl.name.text; });
    if (found == grammar_.lsystems.end() || found->span.begin != decl.span.begin) return;
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
            diagnostics_.error(written.name.span,
                               fmt::format("an lsystem has no '{}', but {}", written.name.text, fmt::join(known, ", ")),
                               nearest(written.name.text, known));
            continue;
        }
        place.enter("lsystem." + written.name.text);
        Expr value = expression(place, written.value, row->want, fmt::format("'{}'", row->name));
        if (const auto number = fold(value, defaults_);
            number && !(number->num() >= row->lo && number->num() <= row->hi))
            diagnostics_.error(written.value.span,
                               fmt::format("'{}' is {}, but must be {}", row->name, toText(*number), row->text));
        out.*row->field = std::move(value);
    }
    out.axiom = decl.axiom.text;
    if (out.axiom.empty() && decl.axiom.kind == syntax::Expr::Kind::Text)
        diagnostics_.error(decl.axiom.span, "an axiom has at least one letter", "write 'axiom \"F+F+F+F\"'");
    for (const auto& production : decl.productions) {
        if (production.symbol.text.size() != 1) {
            diagnostics_.error(production.symbol.span,
                               fmt::format("a production rewrites one letter, not '{}'", production.symbol.text));
            continue;
        }
        Lsystem::Production& p = out.productions.emplace_back();
        p.span = production.span;
        p.letter = production.symbol.text[0];
        p.text = production.text.text;
        if (!production.weight) continue;
        const auto weight = plain(*production.weight, false);
        if (weight && !(weight->kind == Value::Kind::Number && weight->num() >= 0))
            diagnostics_.error(production.weight->span, "the weight of a production is a number no less than 0");
        else if (weight)
            p.weight = weight->num();
    }
}

void Checker::lsystems(const syntax::Ast& ast) {
    for (const auto& decl : ast.lsystems) lsystem(decl);
}

}  // namespace sgm::rules
