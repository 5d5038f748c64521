// Builds the shape tree: adds and removes shapes. Its parts bond them (BondBuilder), keep the budget (Monitor) and
// record what another run has to know (Recorder).
// Enters: shapes with scope and content. Leaves: a consistent ShapeTree. Assumes one thread.
#pragma once

#include <optional>
#include <unordered_map>

#include "grammar/derive/bond_builder.h"
#include "grammar/derive/derive.h"
#include "grammar/derive/monitor.h"
#include "grammar/derive/recorder.h"
#include "grammar/derive/series.h"
#include "grammar/derive/surroundings.h"

namespace sgm::derive {

class TreeBuilder {
public:
    TreeBuilder(Derivation& derivation, const Budget& budget, Progress* progress);

    /// Adds `shape` as the last child of shape.parent and indexes its joints; none (and a failure) when a budget is
    /// spent. Content (op None) of its parent's very scope shares the parent's joints.
    /// With `before`, a child of the same parent, it joins before that one instead.
    ShapeId add(Shape shape, ShapeId before = none);
    /// `cutter` stands elsewhere in the tree than `origin`, whose text made it: it goes with it.
    void bindTo(ShapeId cutter, ShapeId origin) { bound_.emplace_back(cutter, origin); }
    /// Takes the solid and the children away: a rule replaces them.
    void clearContent(ShapeId id);
    Extras& extras(ShapeId id);
    /// Puts a solid, or what few shapes have, into its list: the index.
    uint32_t put(SolidValue solid, bool shared);
    uint32_t put(Extras extras);
    /// Gives a solid that several shapes share another value.
    void replace(uint32_t solid, SolidValue value);
    /// Logs a step that begins: its index in the log.
    uint32_t beginStep(Step step);
    /// The step made what was added since, and morphs or not.
    void endStep(uint32_t step, bool morphic);
    /// The next shape's id.
    ShapeId nextShape() const;
    /// Removes what is dead and numbers occurrences; ids change.
    void finish();

    Monitor& monitor() { return monitor_; }
    Recorder& recorder() { return recorder_; }
    BondBuilder& bonds() { return bonds_; }
    /// What is recorded, or null.
    Recording* recording() const { return recorder_.recording(); }
    bool isReplaying() const { return recorder_.isReplaying(); }
    /// Adds a remark to the derivation, once a place; a second run of a recording adds none.
    void warn(syntax::SourceSpan span, std::string message, std::string hint);
    /// The first of an L-system counts, and what is read again at its place.
    void noteLetters(const LettersRead& read);
    Derivation& derivation() { return derivation_; }
    ShapeTree& tree() { return derivation_.tree; }
    std::span<const uint64_t> counts() const { return counts_; }
    /// What stands around shapes, as it was when the generation began.
    const Surroundings& surroundings();
    /// A generation begins: what stands now counts.
    void forgetSurroundings() { surroundings_.reset(); }
    /// What repetitions have drawn so far.
    SeriesDraws& series() { return series_; }
    /// Live shapes added since the last call.
    std::vector<ShapeId> takeLive() { return std::exchange(live_, {}); }

private:
    ShapeId replayShape(const Shape& made);
    void linkChild(ShapeId parent, ShapeId id, ShapeId before);
    void kill(ShapeId id);
    void killBound();

    Derivation& derivation_;
    JointIndex joints_;
    Monitor monitor_;
    Recorder recorder_;
    BondBuilder bonds_;
    std::vector<uint64_t> counts_;
    std::vector<ShapeId> live_;
    std::vector<std::pair<ShapeId, ShapeId>> bound_;   ///< cutters and where they come from
    std::unordered_map<ShapeId, ShapeId> lastBefore_;  ///< by shape: what was put before it last
    SeriesDraws series_;
    std::optional<Surroundings> surroundings_;
    uint64_t deadCount_ = 0;
    uint8_t extrasChange_ = 0;  ///< of the extras put last, while pieces run again
};

/// Notes whether a place of the text picked something here (Selections); `otherwise` makes the Explanation of the first
/// time that it didn't. A second run of a recording notes only that it did.
template <class Otherwise>
void select(TreeBuilder& builder, syntax::SourceSpan at, bool found, Otherwise&& otherwise) {
    Selections& selections = builder.derivation().selections;
    if (found)
        selections.found(at);
    else if (!builder.isReplaying() && !selections.knows(at))
        selections.missed(at, otherwise());
}

}  // namespace sgm::derive
