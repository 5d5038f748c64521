// Builds the shape tree: adds and removes shapes, bonds them, and keeps the budget.
// Enters: shapes with scope and content. Leaves: a consistent ShapeTree. Assumes one thread.
#pragma once

#include <chrono>
#include <optional>
#include <unordered_map>

#include "grammar/derive/derive.h"
#include "grammar/derive/recording.h"
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
    /// Joins two joints; the shift is what lies between their points. A directed bond closes both, any other leaves
    /// them open. Where a centre came to our face, the newcomer's face that looks back counts as bonded too.
    void bond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    /// Bonds every face of `id` that coincides with another's, so that no rule grows there again. Call after the bond
    /// that placed it.
    void bondCoincidentFaces(ShapeId id);
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

    /// Counts a unit of work that adds no shape (a turn of a loop); false once something failed.
    bool work();
    bool failed() const { return failure_.has_value(); }
    /// Why it failed; from then on it hasn't.
    Error takeFailure() { return *std::exchange(failure_, std::nullopt); }
    /// Begins a piece of work of its own: its time counts from now, and `progress` is told of it.
    void resume(Progress* progress) { progress_ = progress, begin_ = std::chrono::steady_clock::now(), work_ = 0; }
    /// Ends the derivation with a sentence located at `span` and the present rule, path and seed, and what to do.
    void fail(Error::Kind kind, const std::string& what, syntax::SourceSpan span, const char* fix = "");
    /// Adds a remark to the derivation, once a place; a second run of a recording adds none.
    void warn(syntax::SourceSpan span, std::string message, std::string hint);
    /// Another seed could have gone another way here.
    void noteChance() { derivation_.usedChance = true; }
    /// From now on notes all that another run with other numbers has to know; null for nobody.
    void record(Recording* recording) { recording_ = recording; }
    Recording* recording() const { return recording_; }
    /// Begins a piece of the recording, if there is one; the last one ends.
    void beginPiece(Piece piece);
    void endPiece();
    size_t jointsIndexed() const { return joints_.size(); }
    /// Whom to tell from now on; time counts from now.
    void watch(Progress* progress) { progress_ = progress, begin_ = std::chrono::steady_clock::now(); }
    /// Where the lists end.
    Piece::Place end() const;
    /// Runs a piece again with numbers that changed: what it makes goes where it is already. False when it takes
    /// another course; then the derivation is of no use any more.
    template <class Run>
    bool replay(size_t piece, Run&& run) {
        Piece& p = recording_->enter(piece);
        work_ -= p.work;
        const uint64_t before = work_;
        const bool same = run(p) && !failed() && recording_->complete();
        p.work = work_ - before;
        return same && !failed();
    }
    /// After the last piece: whether those that stayed where they are meet whom they met, and bonds' shifts.
    bool revalidateContacts();

    bool isReplaying() const { return recording_ && recording_->isReplaying(); }
    /// A second run takes another course.
    void diverge();

    /// What is being run, for messages and the log.
    void at(uint32_t rule, ShapeId shape, uint32_t step) { rule_ = rule, shape_ = shape, step_ = step; }

    Derivation& derivation() { return derivation_; }
    Progress* progress() const { return progress_; }
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
    void replayBond(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    void replayContacts(ShapeId id);
    void join(ShapeId a, uint32_t jointA, ShapeId b, uint32_t jointB);
    bool ownsBody(ShapeId id) const { return derivation_.tree.bodies[derivation_.tree.shapes[id].body].owner == id; }

    /// The rule that runs, or the start.
    syntax::SourceSpan here() const;
    void poll();
    void linkBond(uint32_t bond, int end);
    uint32_t& firstBondAt(ShapeId id, uint32_t joint);
    void release(ShapeId id);
    void linkChild(ShapeId parent, ShapeId id, ShapeId before);
    void kill(ShapeId id);
    void killBound();
    std::vector<uint32_t> sweepShapes();
    void sweepBonds(std::vector<Bond> old, const std::vector<uint32_t>& newId, const std::vector<uint32_t>& ownerOf);
    void numberOccurrences();

    Derivation& derivation_;
    Budget budget_;
    Progress* progress_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    JointIndex joints_;
    struct Contact {
        uint32_t joint;
        Joint at;
        JointIndex::Spot spot;
    };
    std::vector<Contact> meeting_;  ///< scratch of bondCoincidentFaces
    std::vector<uint64_t> counts_;
    std::vector<ShapeId> live_;
    std::vector<std::pair<ShapeId, ShapeId>> bound_;   ///< cutters and where they come from
    std::unordered_map<ShapeId, ShapeId> lastBefore_;  ///< by shape: what was put before it last
    SeriesDraws series_;
    std::optional<Surroundings> surroundings_;
    std::optional<Error> failure_;
    uint64_t work_ = 0;
    uint64_t pieceBegan_ = 0;  ///< work when the piece began
    uint64_t deadCount_ = 0;
    uint32_t rule_ = none, step_ = none;
    ShapeId shape_ = 0;
    Recording* recording_ = nullptr;
    uint8_t extrasChange_ = 0;  ///< of the extras put last, while pieces run again
};

}  // namespace sgm::derive
