// A derivation by hand: live shapes, the rules that match them, apply, undo, redo; what `sgm step` and a panel drive.
// Enters: a Grammar, parameter values, a seed. Leaves: the tree so far, the way that led to it (SG-M figure 1:
// R0 => R2 => R4) and, at any time, a finished Derivation. Assumes one thread. Undo runs the shorter way again: a way
// has as many steps as the user takes, and equal steps give equal trees.
#pragma once

#include <memory>
#include <span>

#include "grammar/derive/rewriter.h"

namespace sgm::derive {

class Session {
public:
    /// Runs the start's body. Error::Usage where there is no such start; Error::Input, Budget as `derive`.
    static Result<Session> begin(std::shared_ptr<const rules::Grammar> grammar, Options options,
                                 Progress* progress = nullptr);

    const rules::Grammar& grammar() const { return *grammar_; }
    /// The tree as it stands; ids hold until the next undo or redo.
    const ShapeTree& tree() const;
    /// The derivation as it stands, without the passes that end one; as `tree`.
    const Derivation& underWay() const;
    /// Live shapes in tree order: what rules may rewrite.
    std::vector<ShapeId> live() const;
    /// The rules that may rewrite the shape now, in file order.
    std::vector<uint32_t> rulesFor(ShapeId shape);
    /// The elements of its rules whose joints are all closed there, so that their rules don't match.
    std::vector<Closed> blockedAt(ShapeId shape);
    /// The shape that "RULE at PLACE" means; an empty place means the only one that the rule may rewrite.
    Result<ShapeId> meant(uint32_t rule, const std::string& place);

    /// Applies a rule to a live shape. After an error everything is as before.
    Status apply(Application application, Progress* progress = nullptr);
    /// Applies what the automatic derivation would from here on, until no rule matches; one step for undo.
    Status applyRest(Progress* progress = nullptr);
    bool canUndo() const { return !done_.empty(); }
    bool canRedo() const { return !undone_.empty(); }
    /// Takes the last step back, or does it again. Nothing happens where there is none; after an error everything is as
    /// before.
    Status undo(Progress* progress = nullptr);
    Status redo(Progress* progress = nullptr);

    /// The way so far; a step has a place where its rule matched several shapes. Error::Input when no `derive` line can
    /// say it: an automatic step whose guard, a count, no longer holds when its turn in the way comes.
    /// Derives anew.
    Result<std::vector<rules::Derive::Step>> way(Progress* progress = nullptr) const;
    /// The finished derivation of the way so far. Derives anew.
    Result<Derivation> derivation(Progress* progress = nullptr) const;

private:
    struct State;
    using Applications = std::vector<Application>;
    static Result<std::shared_ptr<State>> begun(std::shared_ptr<const rules::Grammar> grammar, const Options& options,
                                                Progress* progress);
    Result<std::shared_ptr<State>> replayed(std::span<const Applications> steps, Progress* progress) const;
    Status settle();
    Status keep(Applications step);

    std::shared_ptr<const rules::Grammar> grammar_;
    Options options_;
    std::shared_ptr<State> state_;
    std::vector<Applications> done_, undone_;  ///< one entry for each step of the user
};

}  // namespace sgm::derive
