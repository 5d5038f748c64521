// Rewriting live shapes: by itself, along a `derive` way, or one rule at a time.
// Enters: a builder with an empty tree, parameter values. Leaves: a grown tree in the builder, and what was applied in
// which order. Assumes one thread; after a failure of the builder nothing more may be applied.
#pragma once

#include "grammar/derive/interpreter.h"

namespace sgm::derive {

/// What a derivation knows before its first shape. Error::Usage where there is no such start.
Result<Derivation> emptyDerivation(std::shared_ptr<const rules::Grammar> grammar, const Options& options);

/// A rule and the live shape it rewrites.
struct Application {
    uint32_t rule = none;
    ShapeId shape = none;
};

class Rewriter {
public:
    Rewriter(TreeBuilder& builder, std::span<const rules::Value> params)
        : builder_(builder), grammar_(*builder.derivation().grammar), interpreter_(builder, params) {}

    /// Runs the start's body.
    void start(const rules::Start& start, const Options& options);
    /// Rewrites every live shape until none is matched.
    void automatic();
    /// Applies the steps of a way; fails at the first that doesn't fit.
    void along(const rules::Derive& way);
    /// Applies one rule.
    void apply(Application application);
    /// Runs a piece of a recording again; false when a rule is chosen or matched otherwise.
    bool repeat(const Piece& piece);

    /// May the rule rewrite the shape as things stand: alive, matched, guard and all?
    bool usable(Application application);
    /// What keeps the shape's rules from matching: elements whose joints are all closed.
    std::vector<Closed> blockedAt(ShapeId shape);
    /// The shapes that the rule may rewrite, in tree order, at most so many.
    std::vector<ShapeId> usableBy(uint32_t rule, size_t most = SIZE_MAX);
    /// The live shape that "RULE at PLACE" means. Without a place it must be the only one that the rule may rewrite.
    Result<ShapeId> meant(uint32_t rule, const std::string& place);
    /// Live shapes in tree order.
    std::vector<ShapeId> live() const;
    /// What was applied so far, in order.
    const std::vector<Application>& applied() const { return applied_; }

private:
    struct Decision {
        uint64_t key;
        Application application;
    };

    uint32_t choose(ShapeId shape);
    std::string shapesFor(uint32_t rule);
    uint32_t draw(ShapeId shape, const std::vector<uint32_t>& rules);
    bool mayMatchLater(ShapeId shape) const;
    bool waits(ShapeId shape) const;
    void noteLive(const std::vector<ShapeId>& waiting);
    std::vector<Decision> decide(std::vector<ShapeId>& waiting);
    void apply(Application application, uint32_t generation);
    bool stillMatches(Application application);

    TreeBuilder& builder_;
    const rules::Grammar& grammar_;
    Interpreter interpreter_;
    std::vector<Application> applied_;
    bool hasOrder_ = false;          ///< some rule says `after`
    bool partsLookAround_ = false;   ///< some part is `shared` or snaps: they ask who stood around
    std::vector<bool> liveSymbols_;  ///< by symbol: a live shape of it was waiting when the generation began
};

}  // namespace sgm::derive
