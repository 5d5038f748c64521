#include "viewer/document/stepper.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/print.h"
#include "grammar/derive/way.h"
#include "grammar/operations/operations.h"
#include "grammar/rules/params.h"
#include "viewer/document/nodes.h"

namespace sgm::document {

using derive::none;
using derive::ShapeId;
using edits::refused;

Result<Stepper> Stepper::begin(const std::shared_ptr<const rules::Grammar>& grammar, const derive::Options& options,
                               Progress* progress) {
    auto session = derive::Session::begin(grammar, options, progress);
    if (!session.ok()) return session.error();
    Stepper stepper(grammar, std::move(*session), options);
    if (options.derive.empty()) return stepper;
    const auto way = std::find_if(grammar->derives.begin(), grammar->derives.end(),
                                  [&](const rules::Derive& d) { return d.name == options.derive; });
    if (way == grammar->derives.end())
        return Error{Error::Kind::Usage, fmt::format("the grammar has no derive way '{}'", options.derive)};
    for (const rules::Derive::Step& step : way->steps) {
        if (cancelled(progress)) return cancelledError();
        const auto shape = stepper.session_.meant(step.rule, step.place);
        if (!shape.ok()) return shape.error();
        if (const Status done = stepper.apply(*shape, step.rule, progress); !done.ok()) return done.error();
    }
    return stepper;
}

Result<StepView> Stepper::view(Progress* progress) {
    auto derivation = session_.derivation(progress);
    if (!derivation.ok()) return derivation.error();
    StepView view{grammar_,
                  {},
                  session_.tree(),
                  session_.canUndo(),
                  session_.canRedo(),
                  std::make_shared<const derive::Derivation>(std::move(*derivation)),
                  refused("no rule was applied yet, so there is no way to save")};
    for (const ShapeId s : session_.live()) {
        StepRow row{s,
                    view.tree.path(s),
                    grammar_->symbols[view.tree.shapes[s].symbol].name,
                    view.tree.shapes[s].scope.size,
                    {},
                    derive::closedBy(session_.underWay(), session_.blockedAt(s))};
        for (const uint32_t r : session_.rulesFor(s))
            row.rules.push_back({r, grammar_->rules[r].name, grammar_->rules[r].span});
        view.rows.push_back(std::move(row));
    }
    if (session_.canUndo()) view.steps = session_.way(progress);
    if (cancelled(progress)) return cancelledError();
    return view;
}

const StepRow* StepView::rowOf(ShapeId shape) const {
    for (; shape < tree.shapes.size(); shape = tree.shapes[shape].parent) {
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const StepRow& r) { return r.shape == shape; });
        if (row != rows.end()) return &*row;
    }
    return nullptr;
}

Result<std::string> StepView::way(const std::string& name) const {
    if (!steps.ok()) return steps.error();
    return derive::wayText(*grammar, name, *steps);
}

Status Stepper::apply(ShapeId shape, uint32_t rule, Progress* progress) {
    return session_.apply({rule, shape}, progress);
}

Status Stepper::apply(const std::string& step, Progress* progress) {
    const auto& rules = grammar_->rules;
    const size_t end = std::min(step.find(" at "), step.size());
    const std::string name = step.substr(0, end), place = end == step.size() ? "" : step.substr(end + 4);
    for (uint32_t r = 0; r < rules.size(); ++r) {
        if (rules[r].name != name) continue;
        const auto shape = session_.meant(r, place);
        return shape.ok() ? apply(*shape, r, progress) : Status(shape.error());
    }
    return refused(fmt::format("no rule is called '{}'", name));
}

Status Stepper::applyRest(Progress* progress) { return session_.applyRest(progress); }
Status Stepper::undo(Progress* progress) { return session_.undo(progress); }
Status Stepper::redo(Progress* progress) { return session_.redo(progress); }

Result<WithWay> withWay(const derive::Session& session, const rules::Grammar& grammar, derive::Options options,
                        const std::string& name, const rules::Loader& loader, Progress* progress) {
    if (!session.canUndo()) return refused("no rule was applied yet, so there is no way to save");
    const auto steps = session.way(progress);
    if (!steps.ok()) return steps.error();
    std::string text = derive::fileWithWay(grammar, name, derive::wayText(grammar, name, *steps));
    syntax::Diagnostics problems;
    const auto changed = rules::load(std::make_shared<const syntax::Source>(grammar.sources[0]->name(), text),
                                     operations::table(), loader, problems);
    if (!changed) return refused(fmt::format("can't save this way as '{}': {}", name, problems.all()[0].message));
    options.derive = name;
    const auto derived = derive::derive(changed, options, progress), here = session.derivation(progress);
    if (!derived.ok()) return derived.error();
    if (!here.ok()) return here.error();
    if (derive::toText(*derived, false) != derive::toText(*here, false))
        return refused("can't save this way: a 'derive' line would lead to another tree");
    return WithWay{std::move(text), changed};
}

edits::Edit Stepper::save(const syntax::Ast& ast, const std::string& name, Progress* progress,
                          const rules::Loader& loader) const {
    if (ast.source->text() != grammar_->sources[0]->text())
        return refused("the text has changed since this way was begun");
    const auto saved = withWay(session_, *grammar_, options_, name, loader, progress);
    if (!saved.ok()) return saved.error();
    return difference(ast.source->text(), saved->text);
}

Result<size_t> Stepper::follow(const std::shared_ptr<const rules::Grammar>& grammar, derive::Options options,
                               Progress* progress) {
    const auto steps = session_.way(progress);
    if (!steps.ok()) return steps.error();
    options.derive.clear();
    auto begun = begin(grammar, options, progress);
    if (!begun.ok()) return begun.error();
    size_t kept = 0;
    for (const rules::Derive::Step& step : *steps) {
        if (cancelled(progress)) return cancelledError();
        const std::string& name = grammar_->rules[step.rule].name;
        if (!begun->apply(step.place.empty() ? name : name + " at " + step.place, progress).ok()) break;
        ++kept;
    }
    if (cancelled(progress)) return cancelledError();
    *this = std::move(*begun);
    return kept;
}

}  // namespace sgm::document
