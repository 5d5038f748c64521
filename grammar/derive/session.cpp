#include "grammar/derive/session.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::derive {

/// A derivation under way: what `derive` holds while it runs.
struct Session::State {
    State(Derivation begun, const Options& options, Progress* progress)
        : derivation(std::move(begun)),
          builder(derivation, options.budget, progress),
          rewriter(builder, derivation.params) {}

    Derivation derivation;
    TreeBuilder builder;
    Rewriter rewriter;
};

Result<std::shared_ptr<Session::State>> Session::begun(std::shared_ptr<const rules::Grammar> grammar,
                                                       const Options& options, Progress* progress) {
    auto empty = emptyDerivation(grammar, options);
    if (!empty.ok()) return empty.error();
    empty->isAlongWay = true;
    auto state = std::make_shared<State>(std::move(*empty), options, progress);
    state->rewriter.start(grammar->starts[options.start], options);
    if (state->builder.monitor().failed()) return state->builder.monitor().takeFailure();
    state->builder.bonds().settle();
    state->builder.monitor().resume(nullptr);
    return state;
}

Result<Session> Session::begin(std::shared_ptr<const rules::Grammar> grammar, Options options, Progress* progress) {
    auto state = begun(grammar, options, progress);
    if (!state.ok()) return state.error();
    Session session;
    session.grammar_ = std::move(grammar);
    session.options_ = std::move(options);
    session.state_ = std::move(*state);
    return session;
}

Result<std::shared_ptr<Session::State>> Session::replayed(std::span<const Applications> steps,
                                                          Progress* progress) const {
    auto state = begun(grammar_, options_, progress);
    if (!state.ok()) return state;
    Monitor& monitor = (*state)->builder.monitor();
    monitor.resume(progress);
    for (const Applications& step : steps)
        for (const Application& a : step) {
            (*state)->rewriter.apply(a);
            if (monitor.failed()) return monitor.takeFailure();  // later steps rewrite what wasn't made
        }
    monitor.resume(nullptr);
    (*state)->builder.bonds().settle();
    return state;
}

const ShapeTree& Session::tree() const { return state_->derivation.tree; }

const Derivation& Session::underWay() const { return state_->derivation; }

std::vector<ShapeId> Session::live() const { return state_->rewriter.live(); }

std::vector<uint32_t> Session::rulesFor(ShapeId shape) {
    std::vector<uint32_t> found;
    for (const uint32_t rule : grammar_->symbols[tree().shapes[shape].symbol].rules) {
        if (state_->rewriter.usable({rule, shape})) found.push_back(rule);
        state_->builder.monitor().discardFailure();
    }
    return found;
}

std::vector<Closed> Session::blockedAt(ShapeId shape) {
    std::vector<Closed> found = state_->rewriter.blockedAt(shape);
    state_->builder.monitor().discardFailure();
    return found;
}

Result<ShapeId> Session::meant(uint32_t rule, const std::string& place) {
    auto shape = state_->rewriter.meant(rule, place);
    if (state_->builder.monitor().failed()) return state_->builder.monitor().takeFailure();
    return shape;
}

Status Session::apply(Application application, Progress* progress) {
    const bool isUsable = application.shape < tree().shapes.size() && state_->rewriter.usable(application);
    state_->builder.monitor().discardFailure();
    if (!isUsable)
        return Error{Error::Kind::Input,
                     fmt::format("rule '{}' doesn't match the shape any more", grammar_->rules[application.rule].name)};
    state_->builder.monitor().resume(progress);
    state_->rewriter.apply(application);
    return keep({application});
}

Status Session::applyRest(Progress* progress) {
    const size_t before = state_->rewriter.applied().size();
    state_->builder.monitor().resume(progress);
    state_->rewriter.automatic();
    const auto& all = state_->rewriter.applied();
    return keep({all.begin() + static_cast<ptrdiff_t>(before), all.end()});
}

/// Ends a step. One that failed is taken back.
Status Session::settle() {
    state_->builder.monitor().resume(nullptr);
    state_->builder.bonds().settle();
    if (!state_->builder.monitor().failed()) return Done{};
    const Error error = state_->builder.monitor().takeFailure();
    auto state = replayed(done_, nullptr);
    if (!state.ok()) return state.error();
    state_ = std::move(*state);
    return error;
}

Status Session::keep(Applications step) {
    if (const Status settled = settle(); !settled.ok() || step.empty()) return settled;
    done_.push_back(std::move(step));
    undone_.clear();
    return Done{};
}

Status Session::undo(Progress* progress) {
    if (done_.empty()) return Done{};
    auto state = replayed(std::span(done_).first(done_.size() - 1), progress);
    if (!state.ok()) return state.error();
    state_ = std::move(*state);
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    return Done{};
}

Status Session::redo(Progress* progress) {
    if (undone_.empty()) return Done{};
    state_->builder.monitor().resume(progress);
    for (const Application& a : undone_.back()) {
        state_->rewriter.apply(a);
        if (state_->builder.monitor().failed()) break;
    }
    if (const Status settled = settle(); !settled.ok()) return settled;
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return Done{};
}

namespace {

/// A path that leads to the shape: the short form "Root/Label[n]" where it does, else every label from the root.
std::string placeOf(const ShapeTree& tree, ShapeId id) {
    const auto& label = tree.labels[tree.shapes[id].label];
    uint32_t n = 0;
    for (ShapeId s = tree.next(0); s != none; s = tree.next(s)) {
        n += tree.labels[tree.shapes[s].label] == label;
        if (s == id) break;
    }
    const std::string root = tree.labels[tree.shapes[0].label];
    const std::string brief = n > 1 ? fmt::format("{}/{}[{}]", root, label, n) : fmt::format("{}/{}", root, label);
    return tree.find(brief) == id ? brief : tree.path(id, true);
}

}  // namespace

Result<std::vector<rules::Derive::Step>> Session::way(Progress* progress) const {
    auto state = begun(grammar_, options_, progress);
    if (!state.ok()) return state.error();
    Rewriter& rewriter = (*state)->rewriter;
    Monitor& monitor = (*state)->builder.monitor();
    std::vector<rules::Derive::Step> steps;
    for (const Applications& step : done_)
        for (const Application& a : step) {
            if (cancelled(progress)) return cancelledError();
            const auto& rule = grammar_->rules[a.rule];
            if (!rewriter.usable(a))
                return Error{Error::Kind::Input,
                             fmt::format("step {}, rule '{}', can't stand in a 'derive' line: its guard counts shapes "
                                         "that stood otherwise when it was chosen",
                                         steps.size() + 1, rule.name)};
            const bool only = rewriter.usableBy(a.rule, 2).size() == 1;
            monitor.discardFailure();
            steps.push_back({a.rule, only ? "" : placeOf((*state)->derivation.tree, a.shape), {}});
            rewriter.apply(a);
            if (monitor.failed()) return monitor.takeFailure();
        }
    return steps;
}

Result<Derivation> Session::derivation(Progress* progress) const {
    auto state = replayed(done_, progress);
    if (!state.ok()) return state.error();
    (*state)->builder.finish();
    return std::move((*state)->derivation);
}

}  // namespace sgm::derive
