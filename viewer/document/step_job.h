// A derivation by hand on a thread of its own, for the Step panel: one piece of work at a time.
// Enters: requests. Leaves: immutable views and outcomes, taken over by `takeOutcome`. Assumes that one thread calls
// it; large trees and many steps take seconds, which the window doesn't wait for.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "viewer/document/stepper.h"

namespace sgm::document {

class StepJob {
public:
    /// What a piece of work came to.
    struct Outcome {
        Status done = Done{};
        std::string what;                        ///< one sentence for the user where it went well
        std::optional<edits::Edit> edit;         ///< what `save` writes
        std::shared_ptr<const syntax::Ast> ast;  ///< into which text
    };

    /// `notify` is called from the thread when there is something to take.
    explicit StepJob(std::function<void()> notify) : notify_(std::move(notify)) {}
    ~StepJob();
    StepJob(const StepJob&) = delete;
    StepJob& operator=(const StepJob&) = delete;

    /// Begins another derivation by hand; what runs of the one before is cancelled. As Stepper::begin.
    void begin(std::shared_ptr<const rules::Grammar> grammar, derive::Options options);
    /// Ends it: what runs is cancelled, there is no view any more.
    void end();

    // While one runs or none is begun, nothing happens.
    void apply(derive::ShapeId shape, const StepRule& rule);
    void applyRest();
    void undo();
    void redo();
    void save(std::shared_ptr<const syntax::Ast> ast, std::string name);
    /// As Stepper::follow. The derivation by hand ends where that isn't done.
    void follow(std::shared_ptr<const rules::Grammar> grammar, derive::Options options);

    /// Stops what runs; after it everything is as before.
    void cancel();
    /// From a request until its outcome is taken.
    bool running() const { return thread_.joinable(); }
    std::string_view stage() const { return progress_->stage(); }
    double fraction() const { return progress_->fraction(); }

    /// As of the last outcome that was taken; null before the first and after `end`.
    const std::shared_ptr<const StepView>& view() const { return view_; }
    /// The outcome, once, when it has come.
    std::optional<Outcome> takeOutcome();

private:
    /// Changes the stepper and says what was done.
    using Change = std::function<Result<std::string>(Progress& progress)>;
    void change(Change change);
    void drop();
    void step(std::string what, std::function<Status(Stepper&, Progress&)> apply);
    void run(std::function<Status(Progress& progress)> work);

    std::function<void()> notify_;
    std::shared_ptr<const StepView> view_;
    std::unique_ptr<Progress> progress_ = std::make_unique<Progress>();  ///< of what runs
    std::unique_ptr<Progress> closing_ = std::make_unique<Progress>();   ///< cancelled by `end`
    std::thread thread_;

    // The thread's while it runs.
    std::optional<Stepper> stepper_;
    std::shared_ptr<const StepView> made_, retired_;  ///< the view to come, and the one to let go of
    Outcome outcome_;
    std::atomic<bool> ended_{false};
};

}  // namespace sgm::document
