// What the `run` of a content operation works with: the scope that it cuts, and bodies run in parts of it.
// Enters: the checked parts. Leaves: shapes below the node that holds them. Assumes it lives while its operation runs.
#pragma once

#include <functional>
#include <string>

#include "grammar/derive/interpreter.h"

namespace sgm::derive {

class PartsContext {
public:
    PartsContext(Interpreter& interpreter, const Interpreter::Frame& frame)
        : interpreter_(interpreter), frame_(frame) {}

    /// The scope that the operation cuts.
    const Scope& scope() const { return frame_.place.scope; }
    /// The value of an expression of the block; `key` tells its draws from those of its neighbours.
    rules::Value evaluate(const rules::Expr& expr, uint64_t key) const;
    /// What a local of the block (the `i` of a repetition) counts from now on.
    void count(uint32_t local, double turn) { interpreter_.count(local, turn, frame_.key); }
    /// The part of the scope between two places along an axis, metres from its low end; the footprint is clipped, but
    /// keeps what stands out of the scope at its ends. Nothing where no footprint is left.
    std::optional<Scope> cut(int axis, double low_m, double high_m);
    /// The scope's footprint in metres about its centre; the rectangle where it has none.
    plan::Footprint footprint() const;
    /// `scope` over a footprint in metres about its centre; nothing, after a failure, where it isn't sound.
    std::optional<Scope> over(Scope scope, const plan::Footprint& footprint, syntax::SourceSpan span);
    /// Runs `body` in a part of the scope; `key` tells the part from its neighbours. False after a failure.
    bool run(const rules::Body& body, const Scope& part, uint64_t key);
    /// Calls `run`; what it makes is cut from what stands before it. False where `run` is.
    bool cutting(const std::function<bool()>& run);
    /// Adds a relief to the derivation: its index.
    uint32_t addRelief(Relief relief);
    /// As `run`, with all that it makes, and what rules make of that, lifted by a relief.
    bool runOn(uint32_t relief, const rules::Body& body, const Scope& part, uint64_t key);
    const rules::Grammar& grammar() const;
    /// The stream of the shape whose scope is cut.
    uint64_t key() const {
        interpreter_.builder_.monitor().noteChance();
        return frame_.key;
    }
    /// The value as a whole number where `whole`, a range drawing one of its whole numbers.
    rules::Value evaluate(const rules::Expr& expr, uint64_t key, bool whole) const;
    /// Where the faces of shapes of that symbol cross an axis of the scope, metres from its low end, as things stood
    /// when the generation began; those alone that run square to the axis.
    std::vector<double> facesAlong(rules::SymbolId symbol, int axis) const;
    /// The share of the outer face (+z) of a part, 0 … 1, at which another shape stood when the generation began; one
    /// that this one stands in or that stands in it doesn't count.
    double sharedBy(const Scope& part) const;
    /// Counts a unit of work; false once something failed.
    bool work() { return interpreter_.builder_.monitor().work(); }
    /// Puts an object of its own into the scope.
    void place(PlacedObject object);
    const Derivation& derivation() const { return interpreter_.builder_.derivation(); }
    /// The shape whose content the operation is.
    ShapeId shape() const { return frame_.node; }
    /// Where expressions of the block stand, for those that are asked at many places of the plan.
    Place place() const { return frame_.place; }
    Progress* progress() const { return interpreter_.builder_.monitor().progress(); }
    /// Takes note of what lies on the ground: `area` in metres about the centre of `scope`.
    void draw(std::string layer, const Scope& scope, const plan::Footprint& area, uint64_t key, double street_m = 0);
    /// What is cut here can't be brought to other numbers in place: the derivation starts over where one changes.
    void startsOver() const;
    /// Adds a warning to the derivation, once a place.
    void warn(syntax::SourceSpan span, std::string message, std::string fix) const;
    /// Notes whether a place of the text picked something here, as derive::select.
    template <class Otherwise>
    void select(syntax::SourceSpan at, bool found, Otherwise&& otherwise) const {
        derive::select(interpreter_.builder_, at, found, std::forward<Otherwise>(otherwise));
    }
    /// Ends the derivation with an error located at `span`; returns false.
    bool fail(const std::string& what, syntax::SourceSpan span);
    bool fail(const Error& why, syntax::SourceSpan span);

private:
    Interpreter& interpreter_;
    const Interpreter::Frame& frame_;
};

}  // namespace sgm::derive
