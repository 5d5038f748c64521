// The Step panel: a derivation by hand, walked forward and back, saved as a `derive` line.
// Enters: a grammar and options, then the user's choices. Leaves: rows, and the derivation so far to be shown. Assumes
// one thread. What decides is derive::Session, as for `sgm step`.
#pragma once

#include <memory>
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
    std::string closed;           ///< which shapes closed joints that its rules ask for, as derive::closedBy says it
};

/// A derivation by hand after a step, as the panel shows it. Immutable; spans point into sources of `grammar`.
struct StepView {
    std::shared_ptr<const rules::Grammar> grammar;
    std::vector<StepRow> rows;  ///< live shapes in tree order
    derive::ShapeTree tree;  ///< whose numbers the rows have: those of `derivation` are other ones, without dead shapes
    bool canUndo = false, canRedo = false;
    std::shared_ptr<const derive::Derivation> derivation;  ///< so far, for ShowRequest::byHand
    /// What led to it; Error::Input where no `derive` line can say it, or nothing was done.
    Result<std::vector<rules::Derive::Step>> steps;

    /// The row of a live shape, or null. For a shape that was picked in the view: the nearest live one at or above it.
    const StepRow* rowOf(derive::ShapeId shape) const;
    /// The steps as a line, "derive NAME: R0 => R2".
    Result<std::string> way(const std::string& name) const;
};

class Stepper {
public:
    /// Runs the start's body, then the steps of options.derive where it names a way. Errors as of derive::Session.
    static Result<Stepper> begin(const std::shared_ptr<const rules::Grammar>& grammar, const derive::Options& options,
                                 Progress* progress = nullptr);

    /// What the panel shows. Derives the steps so far anew, twice.
    Result<StepView> view(Progress* progress = nullptr);

    /// Applies a rule to a live shape; after an error everything is as before, as of all that follow.
    Status apply(derive::ShapeId shape, uint32_t rule, Progress* progress = nullptr);
    /// "RULE" or "RULE at PATH", as in a `derive` line.
    Status apply(const std::string& step, Progress* progress = nullptr);
    /// Goes on automatically until no rule matches; one step for undo.
    Status applyRest(Progress* progress = nullptr);
    Status undo(Progress* progress = nullptr);
    Status redo(Progress* progress = nullptr);

    /// The edit that writes that line into the text: in place of the way of that name, else behind the last one.
    /// Refused unless running the line gives this very tree. `ast` must be what the grammar was checked from.
    edits::Edit save(const syntax::Ast& ast, const std::string& name, Progress* progress = nullptr,
                     const rules::Loader& loader = pipeline::fileLoader()) const;

    /// The same way in another text of the grammar, as far as its rules still match. The number of steps kept.
    Result<size_t> follow(const std::shared_ptr<const rules::Grammar>& grammar, derive::Options options,
                          Progress* progress = nullptr);

private:
    Stepper(std::shared_ptr<const rules::Grammar> grammar, derive::Session session, derive::Options options)
        : grammar_(std::move(grammar)), session_(std::move(session)), options_(std::move(options)) {}

    std::shared_ptr<const rules::Grammar> grammar_;
    derive::Session session_;
    derive::Options options_;
};

/// A grammar with a way in it.
struct WithWay {
    std::string text;
    std::shared_ptr<const rules::Grammar> grammar;
};
/// The text of `grammar` with the session's way in it, tried: running it must give the session's very tree. `grammar`
/// is the session's own or one that differs from it in `derive` lines alone. What `sgm step` and the panel save.
Result<WithWay> withWay(const derive::Session& session, const rules::Grammar& grammar, derive::Options options,
                        const std::string& name, const rules::Loader& loader, Progress* progress = nullptr);

}  // namespace sgm::document
