#include "grammar/derive/incremental_derivation.h"

#include <utility>

#include "grammar/derive/rewriter.h"

namespace sgm::derive {

/// A finished derivation, with all that made it still in work.
struct IncrementalDerivation::State {
    State(Derivation empty, const Options& chosen, Progress* progress)
        : options(chosen),
          derivation(std::move(empty)),
          builder(derivation, options.budget, progress),
          rewriter(builder, derivation.params) {
        builder.recorder().record(&recording);
    }

    Options options;
    Derivation derivation;
    Recording recording;
    TreeBuilder builder;
    Rewriter rewriter;
    size_t joints = 0;  ///< in the index after the first run
};

IncrementalDerivation::IncrementalDerivation() = default;
IncrementalDerivation::~IncrementalDerivation() = default;
IncrementalDerivation::IncrementalDerivation(IncrementalDerivation&&) noexcept = default;
IncrementalDerivation& IncrementalDerivation::operator=(IncrementalDerivation&&) noexcept = default;

const Derivation& IncrementalDerivation::derivation() const { return state_->derivation; }

std::span<const ShapeId> IncrementalDerivation::changed() const { return state_->recording.changes().shapes(); }

namespace {

bool sameBudget(const Budget& a, const Budget& b) {
    return a.shapes == b.shapes && a.depth == b.depth && a.memory_bytes == b.memory_bytes && a.seconds == b.seconds;
}

/// True when the piece read what the second run has changed so far.
bool isDirty(const Piece& piece, uint64_t params, const ShapeTree& tree, const Recording& recording) {
    if ((piece.params & params) != 0) return true;
    if (piece.shape == none) return false;
    if (recording.changes().has(piece.shape, ShapeChanges::Moved)) return true;
    if (piece.readsWorld && recording.changes().has(piece.shape, ShapeChanges::Below)) return true;
    for (ShapeId s = piece.inherits ? tree.shapes[piece.shape].valuesAt : none; s != none;) {
        if (recording.changes().has(s, ShapeChanges::Values)) return true;
        const ShapeId parent = tree.shapes[s].parent;
        s = parent == none ? none : tree.shapes[parent].valuesAt;
    }
    return false;
}

}  // namespace

Status IncrementalDerivation::startOver(std::shared_ptr<const rules::Grammar> grammar, const Options& options,
                                        Progress* progress) {
    whole_ = true;
    state_.reset();
    auto empty = emptyDerivation(std::move(grammar), options);
    if (!empty.ok()) return empty.error();
    if (progress) progress->begin("derive", 0);
    auto state = std::make_unique<State>(std::move(*empty), options, progress);
    TreeBuilder& builder = state->builder;
    state->rewriter.start(state->derivation.grammar->starts[options.start], options);
    state->rewriter.automatic();
    if (builder.monitor().failed()) return builder.monitor().takeFailure();
    state->recording.finish(builder.recorder().end());
    builder.recorder().endPiece();
    builder.finish();
    state->joints = builder.bonds().jointsIndexed();
    state_ = std::move(state);
    return Done{};
}

/// Brings the derivation to other parameters in place; false when it can't be, or takes another course.
bool IncrementalDerivation::follow(const Options& options, Progress* progress) {
    Derivation& d = state_->derivation;
    Recording& recording = state_->recording;
    TreeBuilder& builder = state_->builder;
    uint64_t changed = 0;
    for (size_t i = 0; i < options.params.size(); ++i)
        if (options.params[i] != d.params[i]) changed |= uint64_t{1} << i % 64, d.params[i] = options.params[i];
    state_->options.params = options.params;
    recording.beginReplay(d.tree.shapes.size());
    builder.monitor().watch(progress);
    for (size_t i = 0; i < recording.pieces().size(); ++i) {
        if (!isDirty(recording.pieces()[i], changed, d.tree, recording)) continue;
        if (recording.pieces()[i].readsWorld) return false;  // it would find the world of today
        if (!builder.recorder().replay(i, [&](const Piece& piece) { return state_->rewriter.repeat(piece); }))
            return false;
    }
    if (!builder.bonds().revalidateContacts() || !recording.isReplayable()) return false;
    builder.bonds().settle();
    d.tree.shapes.shrink();
    recording.endAgain();
    builder.monitor().watch(nullptr);
    return true;
}

Status IncrementalDerivation::to(std::shared_ptr<const rules::Grammar> grammar, const Options& options,
                                 Progress* progress) {
    if (!options.derive.empty()) {
        auto d = derive(std::move(grammar), options, progress);
        state_.reset();
        whole_ = true;
        if (!d.ok()) return d.error();
        state_ = std::make_unique<State>(std::move(*d), options, nullptr);
        state_->recording.unfit();
        return Done{};
    }
    constexpr size_t mostMoved = 4;  // times the joints there are: then those that moved away are swept out
    const bool alike = state_ && state_->derivation.grammar == grammar && state_->recording.isReplayable() &&
                       state_->options.derive.empty() && state_->options.start == options.start &&
                       state_->options.seed == options.seed && sameBudget(state_->options.budget, options.budget) &&
                       options.params.size() == state_->derivation.params.size() &&
                       state_->builder.bonds().jointsIndexed() <= mostMoved * state_->joints;
    if (alike && follow(options, progress)) {
        whole_ = false;
        return Done{};
    }
    if (cancelled(progress)) {
        state_.reset();
        return cancelledError();
    }
    return startOver(std::move(grammar), options, progress);
}

}  // namespace sgm::derive
