#include "grammar/rules/figures.h"

#include <algorithm>
#include <array>

namespace sgm::rules {
namespace {

constexpr std::array<std::string_view, 12> figureWords{"bonds",   "overlaps", "shapes",   "terminals",
                                                       "classic", "morphic",  "floating", "roads",
                                                       "blocks",  "lots",     "places",   "objects"};

}  // namespace

std::optional<Typed> findFigure(const Grammar& grammar, const syntax::Expr& e) {
    Typed result;
    result.expr.kind = Expr::Kind::Figure;
    result.expr.span = e.span;
    const auto figure = std::find(figureWords.begin(), figureWords.end(), e.text);
    if (figure != figureWords.end()) {
        result.expr.index = static_cast<uint32_t>(figure - figureWords.begin());
        result.type = Type::number(Unit::None, true);
        return result;
    }
    const auto& all = grammar.reports;
    const auto report = std::find_if(all.begin(), all.end(), [&](const Report& r) { return r.name == e.text; });
    if (report == all.end()) return std::nullopt;
    result.expr.index = static_cast<uint32_t>(Figure::Report);
    result.expr.value = Value::number(static_cast<double>(report - all.begin()));
    result.type = Type::of(report->like);
    return result;
}

std::vector<std::string> figureNames(const Grammar& grammar) {
    std::vector<std::string> names(figureWords.begin(), figureWords.end());
    for (const Report& report : grammar.reports) names.push_back(report.name);
    return names;
}

}  // namespace sgm::rules
