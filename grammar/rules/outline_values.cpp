#include "grammar/rules/outline_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "grammar/rules/measure_text.h"
#include "grammar/rules/traverse.h"

namespace sgm::rules {
namespace {

std::string_view nameOf(Unit unit) {
    switch (unit) {
        case Unit::Metre:
            return "length";
        case Unit::Angle:
            return "angle";
        default:
            return "number";
    }
}

/// 'feature 5 of "lots.geojson"', 'line 12 of "lots.svg"'.
std::string placeIn(const std::string& file, uint64_t place) {
    const bool hasLines = file.ends_with(".svg") || file.ends_with(".obj");
    return fmt::format("{} {} of \"{}\"", hasLines ? "line" : "feature", place, file);
}

bool holdsFile(const PlanExpr& plan) {
    return plan.kind == PlanExpr::Kind::File || std::ranges::any_of(plan.parts, holdsFile);
}

const Expr* findValue(const Expr& e) {
    const auto fn = static_cast<Fn>(e.index);
    if (e.kind == Expr::Kind::Call && (fn == Fn::FileNumber || fn == Fn::FileWord)) return &e;
    for (const Expr& arg : e.args)
        if (const Expr* found = findValue(arg)) return found;
    return nullptr;
}

/// Whether the element brings an outline of a file; `asked` is the first value behind it in the same element.
bool bringsFile(const Element& e, const Expr*& asked) {
    bool brings = false;
    for (const auto* list : {&e.prefix, &e.attributes})
        for (const Attribute& a : *list) {
            for (const Expr& arg : a.args)
                if (brings && !asked) asked = findValue(arg);
            brings = brings || (a.plan && holdsFile(*a.plan));
        }
    return brings;
}

}  // namespace

void warnOfUnreadValues(CheckContext& ctx) {
    std::set<std::pair<size_t, std::string>> told;
    for (const OutlineValue& asked : ctx.outlineValues)
        for (size_t file = 0; file < ctx.grammar.outlines.size(); ++file) {
            if (!ctx.grammar.outlines[file]) continue;
            const plan::Feature* first = nullptr;
            std::string text;
            size_t count = 0;
            for (const plan::Feature& feature : ctx.grammar.outlines[file]->list) {
                const auto* said = feature.find(asked.property);
                const auto* word = said ? std::get_if<std::string>(said) : nullptr;
                if (!word || word->empty() || readMeasure(*word, asked.unit)) continue;
                if (count++ == 0) first = &feature, text = *word;
            }
            if (!first || !told.insert({file, asked.property}).second) continue;
            const std::string more = count > 1 ? fmt::format(" (and {} more)", count - 1) : "";
            ctx.diagnostics.warning(
                asked.span,
                fmt::format("{}{} says \"{}\": \"{}\", which is no {}, so the default holds",
                            placeIn(ctx.files.outlinesName(file), first->place), more, asked.property, text,
                            nameOf(asked.unit)),
                asked.unit == Unit::Metre ? "files say metres as 6.5, or a unit: m, km, cm, mm, ft, ', in"
                : asked.unit == Unit::Angle
                    ? "files say degrees as 12.5, or '12.5 deg'"
                    : "files say numbers as 6.5, with nothing behind them; word(\"…\", …) reads words");
        }
}

void findValuesOfOwnOutline(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    size_t files = 0;
    const auto count = [&](const Element& e) {
        const Expr* asked = nullptr;
        files += bringsFile(e, asked);
    };
    const auto tell = [&](const Expr& asked) {
        diagnostics.warning(asked.span,
                            "what the file says reaches the rules below this shape, and not the shape that brings the "
                            "outline: this is always the default",
                            "write 'footprint file(…) Lot', and ask in 'rule Lot -> extrude (value(…)) …'");
    };
    const std::function<void(const Body&)> visit = [&](const Body& body) {
        for (const auto& chain : body.siblings)
            for (const Element& e : chain) {
                const Expr* asked = nullptr;
                const bool brings = bringsFile(e, asked);
                if (asked) tell(*asked);
                if (!brings) forEachInnerBody(e, visit);  // below, another outline is found
            }
    };
    for (const Start& start : grammar.starts) {
        visit(start.body);
        forEachElement(start.body, count);
    }
    for (const Rule& rule : grammar.rules) forEachElement(rule.body, count);
    if (files != 1) return;
    for (const Rule& rule : grammar.rules) visit(rule.body);
}

}  // namespace sgm::rules
