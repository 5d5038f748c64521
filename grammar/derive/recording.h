// What a derivation read and which answers it got, kept so that it can be brought to other parameter values in place.
// Enters: notes while rules run; then the same pieces of work again, those whose numbers changed. Leaves: which shapes
// changed, or that the derivation takes another course. Assumes that a derivation takes the same course while every
// question about the world (which rule, which joints are open, who meets whom) gets the answer it got: so only the
// pieces that read a changed number run again, and each must put the same shapes with the same bonds.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "grammar/derive/joints.h"

namespace sgm::derive {

/// A piece of work: the start's body, the choice of a rule, a rule matched once more, or its application.
struct Piece {
    enum class Kind : uint8_t { Start, Choice, Match, Application };
    Kind kind = Kind::Start;
    uint32_t rule = none;  ///< the one chosen, matched or applied
    ShapeId shape = none;
    uint32_t generation = 0;
    bool matched = false;     ///< what a Match answered
    bool inherits = false;    ///< it read values that `with` sets
    bool readsWorld = false;  ///< it asked for counts, neighbours or what stands below its shape
    uint64_t params = 0;      ///< bit i % 64 for every parameter i that it read
    uint64_t work = 0;        ///< turns it took of the budget
    /// Where in the lists begins what it made and what it was answered; it ends where the next piece begins.
    struct Place {
        size_t shape = 0, solid = 0, extras = 0, mate = 0, step = 0, answer = 0;
    } from{};
};

/// Flags by index, in a list that grows as they are set.
inline void setFlag(std::vector<bool>& flags, size_t at) {
    if (flags.size() <= at) flags.resize(at + 1 + at / 2);
    flags[at] = true;
}
inline bool hasFlag(const std::vector<bool>& flags, size_t at) { return at < flags.size() && flags[at]; }

/// What a second run finds changed of shapes and solids.
class ShapeChanges {
public:
    enum Change : uint8_t { LookChanged = 1, Moved = 2, Turned = 4, Values = 8, Below = 16 };

    /// Forgets what changed in the last run.
    void begin(size_t shapes);
    void add(const ShapeTree& tree, ShapeId id, uint8_t what);
    bool has(ShapeId id, Change what) const { return (changes_[id] & what) != 0; }
    /// Shapes that changed by themselves, in the order in which they did.
    std::span<const ShapeId> shapes() const { return changed_; }
    void addSolid(uint32_t solid) { setFlag(solids_, solid); }
    bool hasSolid(uint32_t solid) const { return hasFlag(solids_, solid); }

private:
    std::vector<uint8_t> changes_;  ///< by shape
    std::vector<ShapeId> changed_, marked_;
    std::vector<bool> solids_;
};

/// What the first run noted of what it made.
class MadeNotes {
public:
    /// A face that met another when it was put, open or not: `at` met `partner`.
    struct Contact {
        JointIndex::Entry at, partner;
    };

    void met(JointIndex::Entry at, JointIndex::Entry partner) { contacts_.push_back({at, partner}); }
    std::span<const Contact> contacts() const { return contacts_; }
    /// Whom the joint met, if anyone.
    std::optional<JointIndex::Entry> partnerOf(JointIndex::Entry at) const;
    void sharedSolid(size_t solid) { setFlag(shared_, solid); }
    bool isSharedSolid(size_t solid) const { return hasFlag(shared_, solid); }
    void annotated(ShapeId id) { setFlag(annotated_, id); }
    bool isAnnotated(ShapeId id) const { return hasFlag(annotated_, id); }
    void cleared(ShapeId id) { setFlag(cleared_, id); }
    bool isCleared(ShapeId id) const { return hasFlag(cleared_, id); }

private:
    std::vector<Contact> contacts_;  ///< in the order of `at`
    std::vector<bool> shared_, annotated_, cleared_;
};

class Recording {
public:
    /// Begins a piece, with the lists as long as `from` says.
    void begin(Piece piece);
    /// The piece begun last, to note what came of it.
    Piece& now() { return pieces_[running_]; }
    std::span<const Piece> pieces() const { return pieces_; }
    /// Nothing more is made: `end` is where the lists end.
    void finish(const Piece::Place& end);
    /// False where something was read that a second run can't tell: the derivation must then start over.
    bool isReplayable() const { return replayable_; }
    void unfit() { replayable_ = false; }

    void readsParam(uint32_t index) { now().params |= uint64_t{1} << index % 64; }
    void readsParams(uint64_t set) { now().params |= set; }
    void readsValues() { now().inherits = true; }
    void readsWorld() { now().readsWorld = true; }
    /// Locals are known to applications alone: a choice would find those of whatever ran before.
    void readsLocal() {
        replayable_ = replayable_ && (now().kind == Piece::Kind::Start || now().kind == Piece::Kind::Application);
    }
    /// A material that wasn't there: when pieces run again, the list would have another order.
    void freshMaterial() { replayable_ = replayable_ && !replaying_; }

    /// The joints that are open of those asked for. Notes `open` the first time; again, `open` becomes what it was
    /// then. False where others were asked for then.
    bool answer(const std::vector<uint32_t>& asked, std::vector<uint32_t>& open);
    MadeNotes& made() { return made_; }
    ShapeChanges& changes() { return changes_; }
    const ShapeChanges& changes() const { return changes_; }

    /// True while pieces run again.
    bool isReplaying() const { return replaying_; }
    /// Begins a second run; what changed in the last one is forgotten.
    void beginReplay(size_t shapes);
    void endAgain() { replaying_ = false; }
    /// Which second run this is, from 1.
    uint32_t turn() const { return turn_; }
    Piece& enter(size_t piece);
    /// True when the piece made as much as the first time.
    bool complete();
    /// The next of its kind that the piece made the first time; `none` when it made no more.
    uint32_t nextShape() { return next(at_.shape, end_.shape); }
    uint32_t nextStep() { return next(at_.step, end_.step); }
    uint32_t nextExtras() { return next(at_.extras, end_.extras); }
    uint32_t nextMate() { return next(at_.mate, end_.mate); }
    /// Passes over those that several shapes share.
    uint32_t nextSolid();
    uint32_t shapesMade() const { return static_cast<uint32_t>(at_.shape); }

private:
    static uint32_t next(size_t& at, size_t end) { return at < end ? static_cast<uint32_t>(at++) : none; }

    std::vector<Piece> pieces_;
    Piece::Place last_, at_, end_;
    size_t running_ = 0;
    /// Answers: how many were asked for, who, how many were open, who.
    std::vector<uint32_t> answers_;
    MadeNotes made_;
    ShapeChanges changes_;
    bool replayable_ = true, replaying_ = false;
    uint32_t turn_ = 0;
};

}  // namespace sgm::derive
