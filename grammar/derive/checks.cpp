// A grammar's own tests: `check START { settings } expect EXPR`.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/derive.h"
#include "grammar/derive/expressions.h"
#include "grammar/derive/support.h"
#include "grammar/rules/params.h"
#include "modeler/core/stopwatch.h"

namespace sgm::derive {
namespace {

using rules::Expr;
using rules::Figure;

/// Areas of those layers in the plan.
double countOf(const Derivation& d, std::initializer_list<std::string_view> layers) {
    const auto& all = d.plan.features;
    return static_cast<double>(std::count_if(all.begin(), all.end(), [&](const town::PlanFeature& f) {
        return std::find(layers.begin(), layers.end(), f.layer) != layers.end();
    }));
}

double figureOf(const Derivation& d, Figure figure) {
    switch (figure) {
        case Figure::Bonds:
            return static_cast<double>(d.tree.bonds().all.size());
        case Figure::Overlaps:
            return static_cast<double>(d.overlaps());
        case Figure::Shapes:
            return static_cast<double>(d.tree.shapes.size());
        case Figure::Terminals:
            return static_cast<double>(d.terminals());
        case Figure::Classic:
            return static_cast<double>(d.classic);
        case Figure::Morphic:
            return static_cast<double>(d.morphic);
        case Figure::Floating:
            return static_cast<double>(d.floating());
        case Figure::Roads:
            return countOf(d, {"highway", "street", "bridge"});
        case Figure::Blocks:
            return countOf(d, {"block"});
        case Figure::Lots:
            return countOf(d, {"lot", "corner"});
        case Figure::Places:
            return static_cast<double>(placementsOf(d).size());
        case Figure::Objects:
            return static_cast<double>(d.objects.size());
        case Figure::Report:
            break;
    }
    return 0;
}

/// Who floats and who made it; the first few of many.
std::string floatersOf(const Derivation& d) {
    constexpr size_t most = 3;
    const auto shapes = d.floatingShapes();
    std::string text;
    for (size_t i = 0; i < std::min(shapes.size(), most); ++i) text += (i ? "; " : "") + madeBy(d, shapes[i]);
    if (shapes.size() > most) text += fmt::format("; and {} more", shapes.size() - most);
    return text;
}

/// `e` as the number that it turned out to be, which `told` gets too.
Expr constantOf(Expr e, double n, std::string& told) {
    told += fmt::format("{}{} is {}", told.empty() ? "" : ", ", e.span.text(), n);
    e.kind = Expr::Kind::Constant;
    e.args.clear();
    e.value = rules::Value::number(n);
    e.value.integer = true;
    return e;
}

/// Puts numbers in place of figures, and tells what they were.
Expr withFigures(Expr e, const Derivation& d, std::string& told) {
    if (e.kind == Expr::Kind::Figure) {
        const auto figure = static_cast<Figure>(e.index);
        const double n =
            figure == Figure::Report ? d.reported(static_cast<uint32_t>(e.value.num())).sum : figureOf(d, figure);
        Expr number = constantOf(std::move(e), n, told);
        if (figure == Figure::Floating && n > 0) told += ": " + floatersOf(d);
        return number;
    }
    if (e.kind == Expr::Kind::Call && static_cast<rules::Fn>(e.index) == rules::Fn::Count) {
        const auto symbol = static_cast<rules::SymbolId>(e.args[0].value.num());
        const auto& shapes = d.tree.shapes;
        const auto n = std::count_if(shapes.begin(), shapes.end(), [&](const Shape& s) { return s.symbol == symbol; });
        return constantOf(std::move(e), static_cast<double>(n), told);
    }
    for (Expr& arg : e.args) arg = withFigures(std::move(arg), d, told);
    return e;
}

}  // namespace

Result<std::vector<Verdict>> runChecks(std::shared_ptr<const rules::Grammar> grammar, uint64_t seed, Progress* progress,
                                       double seconds) {
    std::vector<Verdict> verdicts;
    const Stopwatch watch;
    for (const rules::Check& check : grammar->checks) {
        Options options;
        options.start = check.start;
        options.seed = seed;
        options.budget.seconds = seconds - watch.seconds();
        if (options.budget.seconds <= 0)
            return Error{Error::Kind::Budget, fmt::format("{}the budget of {:g} seconds for all checks of a file is "
                                                          "spent: take a smaller model here, or raise --max-seconds",
                                                          syntax::placeText(check.span), seconds)};
        options.params = rules::valuesOf(*grammar, check.start);
        for (const rules::Setting& s : check.settings) options.params[s.param] = s.value;
        const auto derivation = derive(grammar, options, progress);
        if (!derivation.ok()) {
            if (derivation.error().kind == Error::Kind::Cancelled) return derivation.error();
            verdicts.push_back({false, derivation.error().message, check.span});
            continue;
        }
        std::string told;
        const Expr expect = withFigures(check.expect, *derivation, told);
        Place place;
        place.tree = &derivation->tree;
        place.params = derivation->params;
        verdicts.push_back({holds(expect, place), told, check.span});
    }
    return verdicts;
}

}  // namespace sgm::derive
