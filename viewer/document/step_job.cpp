#include "viewer/document/step_job.h"

#include <fmt/format.h>

#include <utility>

#include "modeler/core/guarded.h"

namespace sgm::document {

StepJob::~StepJob() { end(); }

void StepJob::cancel() { progress_->cancel(); }

void StepJob::end() {
    cancel();
    closing_->cancel();
    if (thread_.joinable()) thread_.join();
    closing_ = std::make_unique<Progress>();
    view_.reset();
    drop();
    retired_.reset();
}

/// Lets go of the stepper: there is no view once the outcome is taken.
void StepJob::drop() {
    made_.reset();
    stepper_.reset();
}

std::optional<StepJob::Outcome> StepJob::takeOutcome() {
    if (!ended_ || !thread_.joinable()) return std::nullopt;
    thread_.join();
    retired_ = std::exchange(view_, made_);
    return std::exchange(outcome_, Outcome{});
}

void StepJob::run(std::function<Status(Progress&)> work) {
    if (thread_.joinable()) return;
    progress_ = std::make_unique<Progress>();
    progress_->begin("derive", 0);
    ended_ = false;
    outcome_ = Outcome{};
    thread_ = std::thread([this, work = std::move(work)] {
        retired_.reset();
        outcome_.done = guarded([&] { return work(*progress_); });
        ended_ = true;
        notify_();
    });
}

void StepJob::change(Change change) {
    run([this, change = std::move(change)](Progress& progress) -> Status {
        Result<std::string> what = change(progress);
        if (!what.ok()) return what.error();
        Result<StepView> view = stepper_->view(closing_.get());
        if (!view.ok()) {
            drop();  // it has gone on, and nobody sees where
            return view.error();
        }
        made_ = std::make_shared<const StepView>(std::move(*view));
        outcome_.what = std::move(*what);
        return Done{};
    });
}

void StepJob::begin(std::shared_ptr<const rules::Grammar> grammar, derive::Options options) {
    end();
    change(
        [this, grammar = std::move(grammar), options = std::move(options)](Progress& progress) -> Result<std::string> {
            auto begun = Stepper::begin(grammar, options, &progress);
            if (!begun.ok()) return begun.error();
            stepper_.emplace(std::move(*begun));
            return std::string("Pick a live shape, then a rule");
        });
}

void StepJob::follow(std::shared_ptr<const rules::Grammar> grammar, derive::Options options) {
    if (!view_) return;
    change(
        [this, grammar = std::move(grammar), options = std::move(options)](Progress& progress) -> Result<std::string> {
            const Result<size_t> kept = stepper_->follow(grammar, options, &progress);
            if (!kept.ok()) {
                drop();
                return kept.error();
            }
            return fmt::format("{} steps hold in the new text", *kept);
        });
}

void StepJob::step(std::string what, std::function<Status(Stepper&, Progress&)> apply) {
    if (!view_) return;
    change([this, what = std::move(what), apply = std::move(apply)](Progress& progress) -> Result<std::string> {
        const Status done = apply(*stepper_, progress);
        if (!done.ok()) return done.error();
        return what;
    });
}

void StepJob::apply(derive::ShapeId shape, const StepRule& rule) {
    step("Applied " + rule.name,
         [shape, id = rule.rule](Stepper& stepper, Progress& progress) { return stepper.apply(shape, id, &progress); });
}

void StepJob::applyRest() {
    step("The rest by itself", [](Stepper& stepper, Progress& progress) { return stepper.applyRest(&progress); });
}

void StepJob::undo() {
    step("A step back", [](Stepper& stepper, Progress& progress) { return stepper.undo(&progress); });
}

void StepJob::redo() {
    step("A step forward", [](Stepper& stepper, Progress& progress) { return stepper.redo(&progress); });
}

void StepJob::save(std::shared_ptr<const syntax::Ast> ast, std::string name) {
    if (!view_) return;
    run([this, ast = std::move(ast), name = std::move(name)](Progress& progress) -> Status {
        edits::Edit edit = stepper_->save(*ast, name, &progress);
        if (cancelled(&progress)) return cancelledError();
        outcome_.edit = std::move(edit);
        outcome_.ast = ast;
        outcome_.what = "Save way " + name;
        return Done{};
    });
}

}  // namespace sgm::document
