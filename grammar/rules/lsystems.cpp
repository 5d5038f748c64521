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
    Place letters(Place::Where::Guard);
    modules(letters, decl.axiomModules, out.axiom);
    if (out.axiom.empty() && decl.axiom.kind == syntax::Expr::Kind::Text)
        diagnostics_.error(decl.axiom.span, "an axiom has at least one letter", "write 'axiom \"F+F+F+F\"'");
    for (const auto& written : decl.productions) production(written, out);
}

char Checker::letter(const syntax::Name& name) {
    if (name.empty()) return 0;
    if (name.text.size() != 1)
        diagnostics_.error(name.span, fmt::format("a production is about one letter, not '{}'", name.text));
    return name.text[0];
}

/// Letters with their numbers: a turn takes an angle, what steps or widens a length.
void Checker::modules(Place& place, const std::vector<syntax::LsystemDecl::Module>& written,
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
            m.args.push_back(expression(place, module.args[i], want, fmt::format("'{}'", module.letter)));
        }
    }
}

void Checker::production(const syntax::LsystemDecl::Production& written, Lsystem& out) {
    if (written.symbol.empty()) return;
    Lsystem::Production& p = out.productions.emplace_back();
    p.span = written.span;
    p.letter = letter(written.symbol);
    p.before = letter(written.before);
    p.behind = letter(written.behind);
    p.parameters = static_cast<uint32_t>(written.parameters.size());
    Place place(Place::Where::Guard);
    for (const syntax::Name& name : written.parameters) {
        if (params_.contains(name.text) || lets_.contains(name.text))
            diagnostics_.error(
                name.span,
                fmt::format("'{}' is a value of the file: the letter's number needs another name", name.text));
        place.locals.push_back({name.text, place.frame++, Type::unknown()});
    }
    place.enter("when");
    if (written.when) p.when = expression(place, *written.when, Want::Truth, "'when'");
    modules(place, written.modules, p.modules);
    if (!written.weight) return;
    const auto weight = plain(*written.weight, false);
    if (weight && !(weight->kind == Value::Kind::Number && weight->num() >= 0))
        diagnostics_.error(written.weight->span, "the weight of a production is a number no less than 0");
    else if (weight)
        p.weight = weight->num();
}

void Checker::lsystems(const syntax::Ast& ast) {
    for (const auto& decl : ast.lsystems) lsystem(decl);
}

}  // namespace sgm::rules
