#include "cli/trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "grammar/derive/support.h"
#include "grammar/pipeline/missing.h"
#include "grammar/pipeline/scene.h"
#include "grammar/rules/params.h"
#include "modeler/core/printable.h"
#include "modeler/core/stopwatch.h"
#include "viewer/document/problems.h"

namespace sgm::cli {
namespace {

/// One choice of start, values and way.
struct Setting {
    derive::Options options;
    std::string words;    ///< "with floors = 20"; empty for a start as it is
    bool isMain = false;  ///< what `sgm build` makes with the same options
    bool isEnd = false;   ///< one end of a range, of which less is asked
};

/// The text that an error is about, `extent` bytes from where it says it is, if that is in one of the grammar's files.
syntax::SourceSpan placeOf(const document::Problem& problem, uint32_t extent, const rules::Grammar& grammar) {
    for (const syntax::SourcePtr& source : grammar.sources) {
        if (printable(source->name()) != problem.file || problem.line == 0) continue;
        const std::string_view line = source->line(problem.line);
        const auto begin = static_cast<uint32_t>(line.data() - source->text().data()) + problem.column - 1;
        return {source.get(), begin, begin + std::max(extent, 1u)};
    }
    return {};
}

class Trial {
public:
    Trial(std::shared_ptr<const rules::Grammar> grammar, const TrialOptions& options, Progress* progress,
          syntax::Diagnostics& diagnostics)
        : grammar_(std::move(grammar)), options_(options), progress_(progress), diagnostics_(diagnostics) {
        for (const syntax::Diagnostic& d : diagnostics.all()) warned_.insert({d.span.source, d.span.begin, d.span.end});
    }

    Result<Trials> run() {
        const auto chosen = pipeline::optionsFor(*grammar_, options_.model);
        if (!chosen.ok()) return chosen.error();
        main_ = chosen->start;
        Trials trials;
        const Status main = attempt({*chosen, {}, true}, options_.model.secondsBudget, true);
        if (!main.ok() && main.error().kind == Error::Kind::Cancelled) return main.error();
        if (!main.ok()) tell(main.error(), {}, true);
        trials.budgetSpent = !main.ok() && main.error().kind == Error::Kind::Budget;
        const std::vector<Setting> others = settings();
        trials.all = 1 + others.size();
        trials.tried = 1;
        const Stopwatch watch;
        for (const Setting& setting : others) {
            const double left = options_.otherSeconds - watch.seconds();
            if (left <= 0) break;
            const Status done = attempt(setting, left, setting.words.empty());
            ++trials.tried;
            if (done.ok()) continue;
            if (done.error().kind == Error::Kind::Cancelled) return done.error();
            // A time that ran out says nothing of the grammar.
            if (done.error().kind != Error::Kind::Budget || watch.seconds() < options_.otherSeconds)
                tell(done.error(), setting.words, false);
        }
        trials.ofCells = std::move(ofCells_);
        return trials;
    }

private:
    using Key = std::tuple<const syntax::Source*, uint32_t, std::string>;
    static Key keyOf(syntax::SourceSpan span, std::string message) {
        return {span.source, span.begin, std::move(message)};
    }

    /// What is asked for, of this start; a way belongs to the main one.
    derive::Options optionsOf(uint32_t start, const std::string& style) const {
        pipeline::ModelChoice choice = options_.model;
        choice.start = grammar_->symbols[grammar_->starts[start].symbol].name;
        choice.style = style;
        if (start != main_) choice.derive.clear();
        return *pipeline::optionsFor(*grammar_, choice);  // its names are those that the main model was chosen by
    }
    derive::Options optionsOf(uint32_t start) const { return optionsOf(start, options_.model.style); }

    /// All settings but the main one: starts, styles, ways, then parameters one at a time.
    std::vector<Setting> settings() const {
        std::vector<Setting> list;
        const auto starts = static_cast<uint32_t>(grammar_->starts.size());
        for (uint32_t s = 0; s < starts; ++s)
            if (s != main_) list.push_back({optionsOf(s), {}, false});
        for (const rules::Style& style : grammar_->styles)
            for (uint32_t s = 0; s < starts; ++s) {
                if (style.start != rules::none && style.start != s) continue;
                Setting setting{optionsOf(s, style.name), fmt::format("with style '{}'", style.name), false};
                if (setting.options.params != optionsOf(s).params) list.push_back(std::move(setting));
            }
        if (starts == 1)  // nothing says which start a way belongs to
            for (const rules::Derive& way : grammar_->derives) {
                if (way.name == options_.model.derive) continue;
                list.push_back({optionsOf(0), fmt::format("with derive '{}'", way.name), false});
                list.back().options.derive = way.name;
            }
        for (uint32_t s = 0; s < starts; ++s)
            for (uint32_t p = 0; p < grammar_->params.size(); ++p) {
                if (grammar_->params[p].span.source != grammar_->sources[0].get()) continue;  // a library's own matter
                for (rules::Value& value : endsOf(grammar_->params[p])) {
                    Setting setting{optionsOf(s), {}, false};
                    if (setting.options.params[p] == value) continue;
                    setting.isEnd = grammar_->params[p].choices.empty() && value.kind != rules::Value::Kind::Bool;
                    setting.words = fmt::format("with {} = {}", grammar_->params[p].name, rules::toText(value));
                    setting.options.params[p] = std::move(value);
                    list.push_back(std::move(setting));
                }
            }
        return list;
    }

    /// What a parameter can be at the most and at the least; all choices, and both truths.
    static std::vector<rules::Value> endsOf(const rules::Param& param) {
        std::vector<rules::Value> ends;
        if (param.lo) ends.push_back(*param.lo);
        if (param.hi) ends.push_back(*param.hi);
        for (const std::string& word : param.choices) {
            ends.push_back(param.value);
            ends.back().text = word;
        }
        if (param.value.kind == rules::Value::Kind::Bool) ends.push_back(rules::Value::boolean(!param.value.truth()));
        return ends;
    }

    /// Derives, lowers and looks whether anything is left. `thorough`: all warnings; else only what was remarked.
    Status attempt(const Setting& setting, double seconds, bool thorough) {
        derive::Options options = setting.options;
        options.budget.seconds = seconds;
        auto derivation = derive::derive(grammar_, options, progress_);
        if (!derivation.ok()) return derivation.error();
        syntax::Diagnostics found;
        if (thorough) {
            // What another start picked something by isn't told of this one.
            selections_.add(derivation->selections);
            derivation->selections = selections_;
            found = derive::warnings(*derivation);
        } else {
            for (const derive::Warning& r : derivation->warnings) found.warning(r.span, r.message, r.hint);
        }
        for (const syntax::Diagnostic& d : found.all())
            if (warned_.insert({d.span.source, d.span.begin, d.span.end}).second)
                diagnostics_.warning(d.span, prefixed(setting.words, d.message), d.hint);
        warnOfFloatingBoxes(*derivation, setting);
        Context context{progress_};
        const bool placesObjects = !derivation->objects.empty();
        const auto floating = pipeline::tryObjects(*derivation, options.budget, context);
        if (!floating.ok()) return floating.error();
        warnOfFloatingObjects(*floating, setting);
        const auto model = makeModel(std::move(*derivation), context, pipeline::Objects::Apart);
        if (!model.ok()) return model.error();
        const bool checksMesh = setting.isMain && options_.otherSeconds > 0;
        // Objects have cells of their own, of which `sgm build` tells.
        if (placesObjects && model->lowered->field.bounds.empty()) return Done{};
        if (const Status s = placesObjects ? Done{} : hasSurface(*model); !s.ok()) return s;
        return checksMesh ? lookAtMesh(*model) : Status(Done{});
    }

    /// What hangs in the air at another setting, by boxes, which costs no mesh. Nothing where the start as it is has
    /// some.
    void warnOfFloatingBoxes(const derive::Derivation& derivation, const Setting& setting) {
        const uint32_t start = setting.options.start;
        if (setting.words.empty() && derivation.floating() == 0) standing_.insert(start);
        if (setting.words.empty() || setting.isEnd || !standing_.contains(start)) return;
        const std::vector<derive::ShapeId> floating = derivation.floatingShapes();
        if (floating.empty()) return;
        const syntax::SourceSpan span = derivation.tree.shapes[floating[0]].span;
        if (!said_.insert(keyOf(span, "floats")).second) return;
        const std::string more =
            floating.size() > 1 ? fmt::format(" and {} more float", floating.size() - 1) : " floats";
        diagnostics_.warning(span, prefixed(setting.words, derive::madeBy(derivation, floating[0]) + more),
                             "let it touch what stands on the ground");
    }

    /// Objects of `place` that hang in the air; once a place, and not at the ends of ranges.
    void warnOfFloatingObjects(const syntax::Diagnostics& floating, const Setting& setting) {
        if (setting.isEnd) return;
        for (const syntax::Diagnostic& d : floating.all())
            if (said_.insert(keyOf(d.span, "floats")).second)
                diagnostics_.warning(d.span, prefixed(setting.words, d.message), d.hint);
    }

    /// What `sgm build` would tell of the mesh at the cells that are asked for: what floats, what is too thin.
    Status lookAtMesh(const Model& model) {
        Context context{progress_, options_.grid.threads};
        const auto meshed = makeMesh(model, options_.grid, context);
        if (!meshed.ok()) return meshed.error();
        if (meshed->mesh.triangleCount() == 0 && model.derivation.objects.empty())
            return withOptions(pipeline::noSurface(model, meshed->grid.cell_m));
        const auto found = pipeline::meshWarnings(model, *meshed, context);
        if (!found.ok()) return found.error();
        for (const pipeline::MeshWarning& w : *found)
            if (w.ofCells)
                ofCells_.push_back(w);
            else
                diagnostics_.warning(w.span, w.text);
        return Done{};
    }

    /// Fails when intervals prove that there is no surface; what is thinner than a cell isn't lost by them.
    Status hasSurface(const Model& model) const {
        constexpr int cells = 64;
        const Box3f& bounds = model.lowered->field.bounds;
        mesh::Counts counts;
        const auto blocks =
            mesh::subdivide(model.tape, mesh::gridFor(bounds, mesh::cellFor(bounds, cells)), 0, progress_, counts);
        if (!blocks.ok()) return blocks.error();
        if (!blocks->empty()) return Done{};
        const derive::Shape& root = model.derivation.tree.shapes[0];
        return syntax::errorAt(root.span, Error::Kind::Input,
                               fmt::format("nothing solid is left of '{}': all is cut away; move the cutters, or make "
                                           "them smaller",
                                           model.derivation.tree.path(0)));
    }

    static std::string prefixed(const std::string& words, const std::string& message) {
        return words.empty() ? message : fmt::format("{}: {}", words, message);
    }

    /// An error of the main model, or a warning for another; once a place and sentence.
    void tell(const Error& error, const std::string& words, bool isMain) {
        const document::Problem problem = document::problemOf(error);
        const syntax::SourceSpan span = placeOf(problem, error.extent, *grammar_);
        // One warning a place: at other settings it is another number or path.
        if (!said_.insert(keyOf(span, words.empty() ? problem.message : std::string())).second) return;
        const std::string message = prefixed(words, span.source ? problem.message : error.message);
        if (isMain)
            diagnostics_.error(span, message);
        else
            diagnostics_.warning(span, message);
    }

    std::shared_ptr<const rules::Grammar> grammar_;
    TrialOptions options_;
    Progress* progress_;
    syntax::Diagnostics& diagnostics_;
    std::vector<pipeline::MeshWarning> ofCells_;
    uint32_t main_ = 0;                                                       ///< the main model's start
    std::set<uint32_t> standing_;                                             ///< starts in which nothing floats
    derive::Selections selections_;                                           ///< of all starts so far
    std::set<Key> said_;                                                      ///< errors
    std::set<std::tuple<const syntax::Source*, uint32_t, uint32_t>> warned_;  ///< places: one warning each
};

}  // namespace

Result<Trials> tryModels(std::shared_ptr<const rules::Grammar> grammar, const TrialOptions& options, Progress* progress,
                         syntax::Diagnostics& diagnostics) {
    return Trial(std::move(grammar), options, progress, diagnostics).run();
}

}  // namespace sgm::cli
