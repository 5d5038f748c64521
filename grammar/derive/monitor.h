// Watches a derivation: what runs, what it took of its budget, and why it failed.
// Enters: turns of work, and failures. Leaves: at most one Error with its place. Assumes one thread.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "grammar/derive/derive.h"
#include "grammar/derive/joints.h"

namespace sgm::derive {

class Monitor {
public:
    /// `joints` counts for the budget of memory.
    Monitor(Derivation& derivation, const JointIndex& joints, const Budget& budget, Progress* progress)
        : derivation_(derivation), joints_(joints), budget_(budget), progress_(progress) {}

    const Budget& budget() const { return budget_; }
    Progress* progress() const { return progress_; }
    /// Whom to tell from now on; time counts from now.
    void watch(Progress* progress) { progress_ = progress, begin_ = std::chrono::steady_clock::now(); }
    /// Begins a piece of work of its own: its time and its turns count from now, and `progress` is told of it.
    void resume(Progress* progress) { watch(progress), turns_ = 0; }

    /// What is being run, for messages and the log.
    void at(uint32_t rule, ShapeId shape, uint32_t step) { rule_ = rule, shape_ = shape, step_ = step; }
    uint32_t step() const { return step_; }

    /// Counts a unit of work that adds no shape (a turn of a loop); false once something failed.
    bool work();
    /// Units of work so far.
    uint64_t turns() const { return turns_; }
    /// Takes units back that are counted anew.
    void takeBack(uint64_t turns) { turns_ -= turns; }

    bool failed() const { return failure_.has_value(); }
    /// Why it failed; from then on it hasn't.
    Error takeFailure() { return *std::exchange(failure_, std::nullopt); }
    /// Forgets a failure of what changes nothing: a guard that was evaluated for a message or a list.
    void discardFailure() { failure_.reset(); }
    /// Ends the derivation with a sentence located at `span` and the present rule, path and seed, and what to do.
    void fail(Error::Kind kind, const std::string& what, syntax::SourceSpan span, const char* fix = "");
    /// The same of a budget that shapes without end would spend.
    void failOfGrowth(const std::string& what, syntax::SourceSpan span);
    /// A second run takes another course.
    void diverge();
    /// Another seed could have gone another way here.
    void noteChance() { derivation_.usedChance = true; }

private:
    /// The rule that runs, or the start.
    syntax::SourceSpan here() const;
    void poll();

    Derivation& derivation_;
    const JointIndex& joints_;
    Budget budget_;
    Progress* progress_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::optional<Error> failure_;
    uint64_t turns_ = 0;
    uint32_t rule_ = none, step_ = none;
    ShapeId shape_ = 0;
};

}  // namespace sgm::derive
