#include "grammar/pipeline/checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/derive.h"
#include "grammar/derive/expressions.h"
#include "grammar/derive/support.h"
#include "grammar/pipeline/placed_models.h"
#include "grammar/rules/params.h"
#include "modeler/core/stopwatch.h"

namespace sgm::pipeline {
namespace {

using derive::Derivation;
using derive::Shape;
using rules::Expr;
using rules::Figure;

/// Areas of those layers in the plan.
double countOf(const Derivation& d, std::initializer_list<std::string_view> layers) {
    const auto& all = d.plan.features;
    return static_cast<double>(std::count_if(all.begin(), all.end(), [&](const town::PlanFeature& f) {
        return std::find(layers.begin(), layers.end(), f.layer) != layers.end();
    }));
}

/// Who floats and who made it; the first few of many.
std::string floatersOf(const Derivation& d) {
    constexpr size_t most = 3;
    const auto shapes = d.floatingShapes();
    std::string text;
    if (d.floating() != shapes.size())
        text = fmt::format("{} solids in {} group{}: ", d.floating(), shapes.size(), shapes.size() == 1 ? "" : "s");
    for (size_t i = 0; i < std::min(shapes.size(), most); ++i) text += (i ? "; " : "") + derive::madeBy(d, shapes[i]);
    if (shapes.size() > most)
        text += fmt::format("; and {} more{}", shapes.size() - most, d.floating() != shapes.size() ? " groups" : "");
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

/// Figures of one derivation. Its objects are derived once something of them is asked.
class FiguresOf {
public:
    FiguresOf(const Derivation& d, const derive::Budget& budget, Context& context)
        : d_(d), budget_(budget), context_(context) {}

    /// `e` with numbers in place of figures, which `told` gets too.
    Expr substitute(Expr e, std::string& told) {
        if (e.kind == Expr::Kind::Figure) {
            const auto figure = static_cast<Figure>(e.index);
            const double n = figure == Figure::Report ? sumOf(static_cast<uint32_t>(e.value.num())) : valueOf(figure);
            Expr number = constantOf(std::move(e), n, told);
            if (figure == Figure::Floating && n > 0) told += ": " + floatersOf(d_);
            return number;
        }
        if (e.kind == Expr::Kind::Call && static_cast<rules::Fn>(e.index) == rules::Fn::Count) {
            const auto symbol = static_cast<rules::SymbolId>(e.args[0].value.num());
            const auto& shapes = d_.tree.shapes;
            const auto n =
                std::count_if(shapes.begin(), shapes.end(), [&](const Shape& s) { return s.symbol == symbol; });
            return constantOf(std::move(e), static_cast<double>(n), told);
        }
        for (Expr& arg : e.args) arg = substitute(std::move(arg), told);
        return e;
    }
    /// Why a figure couldn't be had.
    const Status& failure() const { return failure_; }

private:
    double valueOf(Figure figure) {
        switch (figure) {
            case Figure::Bonds:
                return static_cast<double>(d_.tree.bonds().all.size());
            case Figure::Overlaps:
                return static_cast<double>(d_.overlaps());
            case Figure::Shapes:
                return static_cast<double>(d_.tree.shapes.size());
            case Figure::Terminals:
                return static_cast<double>(d_.terminals());
            case Figure::Classic:
                return static_cast<double>(d_.classic);
            case Figure::Morphic:
                return static_cast<double>(d_.morphic);
            case Figure::Floating:
                return static_cast<double>(d_.floating());
            case Figure::Roads:
                return countOf(d_, {"highway", "street", "bridge"});
            case Figure::Blocks:
                return countOf(d_, {"block"});
            case Figure::Lots:
                return countOf(d_, {"lot", "corner"});
            case Figure::Places:
                return static_cast<double>(placed().places);
            case Figure::Objects:
                return static_cast<double>(placed().objects);
            case Figure::Report:
                break;
        }
        return 0;
    }

    double sumOf(uint32_t report) { return d_.reported(report).sum + placed().reports[report].sum; }

    const PlacedFigures& placed() {
        if (placed_) return *placed_;
        PlacedModels objects(d_, budget_, context_);
        if (failure_.ok()) failure_ = objects.derive();
        placed_ = failure_.ok() ? objects.figures()
                                : PlacedFigures{0, 0, std::vector<derive::Reported>(d_.grammar->reports.size())};
        return *placed_;
    }

    const Derivation& d_;
    const derive::Budget& budget_;
    Context& context_;
    std::optional<PlacedFigures> placed_;
    Status failure_ = Done{};
};

}  // namespace

Result<std::vector<Verdict>> runChecks(const std::shared_ptr<const rules::Grammar>& grammar, uint64_t seed,
                                       Context& context, double seconds) {
    std::vector<Verdict> verdicts;
    const Stopwatch watch;
    for (const rules::Check& check : grammar->checks) {
        derive::Options options;
        options.start = check.start;
        options.seed = seed;
        options.budget.seconds = seconds - watch.seconds();
        if (options.budget.seconds <= 0)
            return Error{Error::Kind::Budget, fmt::format("{}the budget of {:g} seconds for all checks of a file is "
                                                          "spent: take a smaller model here, or raise --max-seconds",
                                                          syntax::placeText(check.span), seconds)};
        options.params = rules::valuesOf(*grammar, check.start);
        for (const rules::Setting& s : check.settings) options.params[s.param] = s.value;
        const auto derivation = derive::derive(grammar, options, context.progress);
        std::string told;
        Status done = derivation.ok() ? Status(Done{}) : Status(derivation.error());
        bool passed = false;
        if (done.ok()) {
            FiguresOf figures(*derivation, options.budget, context);
            const Expr expect = figures.substitute(check.expect, told);
            done = figures.failure();
            derive::Place place;
            place.tree = &derivation->tree;
            place.params = derivation->params;
            passed = done.ok() && derive::holds(expect, place);
        }
        if (!done.ok() && done.error().kind == Error::Kind::Cancelled) return done.error();
        verdicts.push_back({passed, done.ok() ? told : done.error().message, check.span});
    }
    return verdicts;
}

}  // namespace sgm::pipeline
