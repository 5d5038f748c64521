// The Step panel: a derivation by hand, walked forward and back, saved as a `derive` line.
// Enters: a grammar and options, then the user's choices. Leaves: rows, and the derivation so far to be shown. Assumes
// one thread. What decides is derive::Session, as for `sgm step`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/derive/session.h"
#include "grammar/pipeline/files.h"
#include "viewer/document/edits.h"

namespace sgm::document {

/// A rule that may rewrite a live shape.
struct StepRule {
    uint32_t rule = 0;
    std::string name;
    syntax::SourceSpan span;
};
/// A live shape and the rules that match it now.
struct StepRow {
    derive::ShapeId shape = 0;
    std::string path, symbol;
    Vec3d size_m;
    std::vector<StepRule> rules;  ///< none: nothing matches any more
};

class Stepper {
public:
    /// Runs the start's body, then the steps of options.derive where it names a way. Errors as of derive::Session.
    static Result<Stepper> begin(std::shared_ptr<const rules::Grammar> grammar, derive::Options options);

    /// Live shapes in tree order.
    const std::vector<StepRow>& rows() const { return rows_; }
    const derive::ShapeTree& tree() const { return session_.tree(); }
    /// The row of a live shape, or null. For a shape that was picked in the view: the nearest live one at or above it.
    const StepRow* rowOf(derive::ShapeId shape) const;

    /// Applies a rule to a live shape; after an error everything is as before.
    Status apply(derive::ShapeId shape, uint32_t rule, Progress* progress = nullptr);
    /// "RULE" or "RULE at PATH", as in a `derive` line.
    Status apply(const std::string& step);
    /// Goes on automatically until no rule matches; one step for undo.
    Status applyRest(Progress* progress = nullptr);
    bool canUndo() const { return session_.canUndo(); }
    bool canRedo() const { return session_.canRedo(); }
    Status undo();
    Status redo();

    /// The derivation so far, for ShowRequest::byHand: made anew after every step.
    Result<std::shared_ptr<const derive::Derivation>> derivation() const;
    /// The way so far as a line, "derive NAME: R0 => R2"; Error::Input where a line can't say it, or nothing was done.
    /// Derives anew the first time after a step.
    Result<std::string> way(const std::string& name) const;
    /// The edit that writes that line into the text: in place of the way of that name, else behind the last one.
    /// Refused unless running the line gives this very tree. `ast` must be what the grammar was checked from.
    edits::Edit save(const syntax::Ast& ast, const std::string& name,
                     const rules::Loader& loader = pipeline::fileLoader()) const;

    /// The same way in another text of the grammar, as far as its rules still match. The number of steps kept.
    Result<size_t> follow(std::shared_ptr<const rules::Grammar> grammar, derive::Options options);

private:
    Stepper(derive::Session session, derive::Options options)
        : session_(std::move(session)), options_(std::move(options)) {}
    void list();
    Status listed(Status done);

    derive::Session session_;
    derive::Options options_;
    std::vector<StepRow> rows_;
    mutable std::optional<Result<std::vector<rules::Derive::Step>>> way_;  ///< of the session, once it was asked for
};

/// A grammar with a way in it.
struct WithWay {
    std::string text;
    std::shared_ptr<const rules::Grammar> grammar;
};
/// The text of `grammar` with the session's way in it, tried: running it must give the session's very tree. `grammar`
/// is the session's own or one that differs from it in `derive` lines alone. What `sgm step` and the panel save.
Result<WithWay> withWay(const derive::Session& session, const rules::Grammar& grammar, derive::Options options,
                        const std::string& name, const rules::Loader& loader);

}  // namespace sgm::document
