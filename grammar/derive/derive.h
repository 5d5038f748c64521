// Growing the shape tree: SG-M's engine (eqs. 1–8, 15–16).
// Enters: a Grammar, parameter values, a seed, a budget. Leaves: a Derivation: the ShapeTree and the log of steps.
// Assumes a grammar that passed `check`. A generation reads the state at its start and commits in key order; conflicts
// go to the lower key. Every draw is keyed by the shape's path, so editing one branch leaves the draws of the others
// alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/derive/placed_objects.h"
#include "grammar/derive/reliefs.h"
#include "grammar/derive/selections.h"
#include "grammar/derive/shape_tree.h"
#include "grammar/rules/grammar.h"
#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/town/town_plan.h"

namespace sgm::derive {

/// One rule application; a `repeat` logs one a step of its chain and one for `finally`.
struct Step {
    uint32_t rule = 0;
    ShapeId shape = none;     ///< the matched one
    uint32_t generation = 0;  ///< from 1
    uint32_t chainIndex = 0;  ///< i of a repeat, 0 otherwise
    bool morphic = false;     ///< R_M: its body morphs, or made a roof(a) with 0 < a < 1; else R_C
    bool closing = false;     ///< the `finally` of a chain
    ShapeId firstMade = 0;    ///< it made the shapes firstMade … firstMade + madeCount − 1
    uint32_t madeCount = 0;
};

/// An element that found its joint closed, so that nothing grew there.
struct Closed {
    syntax::SourceSpan span;       ///< the element
    uint64_t count = 0;            ///< how often
    ShapeId host = none;           ///< the shape on which it would have grown the first time; none where it is gone
    std::vector<uint32_t> joints;  ///< those of `host` that it asked for: a name, or the choice of `free(…)`
};

/// Something that was derived and is hardly meant, as a division by zero; told once a place.
struct Warning {
    syntax::SourceSpan span;
    std::string message, hint;
};

/// Where an L-system was first read: what decides its letters besides the grammar and its parameters.
struct LettersRead {
    uint32_t lsystem = 0;     ///< index into Grammar::lsystems
    uint64_t key = 0;         ///< the stream that draws
    Scope scope;              ///< of the shape that asked
    ShapeId valuesAt = none;  ///< nearest shape with `with` values
    bool isInSpace = false;   ///< read by `turtle`, not for a footprint
    bool rises = false;       ///< `turtle … upward`
    double width_m = 0;       ///< of the turtle's first step
};

/// What shapes reported under one word.
struct Reported {
    uint64_t count = 0;
    double sum = 0, least = 0, greatest = 0;

    void add(double value) { add({1, value, value, value}); }
    void add(const Reported& other);
};

/// What a derivation was made of, besides its grammar.
struct DerivationInput {
    std::vector<rules::Value> params;
    uint32_t start = 0;  ///< index into Grammar::starts
    uint64_t seed = 0;
    std::string way;          ///< the name of the `derive` way that it follows; empty: none
    bool isPlaced = false;    ///< it is an object of another model, and stands on no ground of its own
    bool planAlone = false;   ///< made with Options::planAlone
    bool isAlongWay = false;  ///< made step by step, as by a `derive` way: what is left live may be meant so
};

/// What a derivation counted.
struct DerivationCounts {
    /// What became of objects that were grafted: places that hold copies of their shapes, or boxes in their stead.
    uint64_t copies = 0, masses = 0;
    uint64_t classic = 0, morphic = 0;  ///< rule applications of R_C and R_M
};

struct Derivation : DerivationInput, DerivationCounts {
    std::shared_ptr<const rules::Grammar> grammar;
    ShapeTree tree;
    PageArray<Step> steps;
    std::vector<Closed> closed;        ///< one an element, in the order they first met a closed joint
    std::vector<Warning> warnings;     ///< in the order they were met, the first few hundred
    Selections selections;             ///< which places of the text picked something, and which never did
    std::vector<Material> materials;   ///< the grammar's, then those given by attributes
    town::TownPlan plan;               ///< what `network` and `lots` laid out
    PlacedObjects objects;             ///< what `place` puts; Extras::object says where
    std::vector<Relief> reliefs;       ///< heights that lift shapes; Extras::relief says which
    std::vector<LettersRead> letters;  ///< one an L-system that was read
    bool usedChance = false;           ///< another seed could have made another tree

    /// Pairs of shapes with a solid whose boxes overlap by more than 0.1 mm without being bonded or related (one above
    /// the other in the tree); counting ends at a million. O(n log n) plus the pairs that share an interval of an axis.
    uint64_t overlaps() const;
    /// Shapes that carry a solid.
    uint64_t terminals() const;
    /// Solids that touching boxes neither connect with the first one nor with the lowest level.
    uint64_t floating() const;
    /// Where each group of floating solids begins, in tree order.
    std::vector<ShapeId> floatingShapes() const;
    /// What shapes of this tree reported under a word, an index into Grammar::reports. O(shapes).
    Reported reported(uint32_t report) const;
    /// Memory of the arrays, bytes.
    uint64_t memory() const;
};

/// A shape that holds an object of its own.
struct Placement {
    ShapeId shape = none;
    uint32_t object = none;  ///< index into Derivation::objects
};
/// Where objects stand, in tree order.
std::vector<Placement> placementsOf(const Derivation& derivation);

/// Which shapes closed the joints, "'+x' of 'A' is closed by 'A/cube', made by rule 'B' (a.sgm:3)"; joints that a
/// centre alone met, of which `free(…)` takes none, are "bonded to" it. The first three of many joints; "" where the
/// shape is gone. Makes the tree's bonds where nobody has asked for them yet.
std::string closedBy(const Derivation& derivation, const Closed& closed);
/// The same of several elements, each text once, with ", " between them.
std::string closedBy(const Derivation& derivation, const std::vector<Closed>& closed);

/// A warning for every element that a closed joint kept from growing wherever it came.
syntax::Diagnostics ungrown(const Derivation& derivation);

/// A warning for every difference that removes nothing wherever it was derived: nothing stands there to be cut, or it
/// lies beside what does. Boxes decide, so that a cutter that only its box lets touch its host isn't told.
syntax::Diagnostics uncut(const Derivation& derivation);

/// A warning for every look of a group, a part or a shape with rules that no solid in it has, since all have their own.
syntax::Diagnostics unseenLooks(const Derivation& derivation);

/// A warning for every symbol of which a shape stays empty since no guard of its rules holds there.
syntax::Diagnostics unmatched(const Derivation& derivation);

/// All warnings of a derivation, in the order of the text: its remarks, places that never picked anything, `ungrown`,
/// `unmatched`, `uncut` and `unseenLooks`.
syntax::Diagnostics warnings(const Derivation& derivation);

/// Error::Input where a derivation leaves nothing solid: its first warning as the cause, or else that no solid is
/// named.
Error nothingSolid(const Derivation& derivation);

/// Limits of a derivation; what passes one ends in Error::Budget.
struct Budget {
    uint64_t shapes = 250'000;           ///< a runaway reaches it within a second
    uint32_t depth = 10'000;             ///< levels of the shape tree
    uint64_t memory_bytes = 4ull << 30;  ///< of the tree and the log
    double seconds = 600;
};

struct Options {
    uint32_t start = 0;                ///< index into Grammar::starts
    std::string derive;                ///< name of a `derive` way; empty: automatic
    std::vector<rules::Value> params;  ///< by index; empty: the start's defaults (rules::valuesOf)
    uint64_t seed = 1;
    Budget budget;
    bool isPlaced = false;   ///< derives an object that `place` puts: maps can't be asked
    bool planAlone = false;  ///< lays out towns: what stands on roads, waters, parks and lots isn't derived
    std::optional<Lot> lot;  ///< the scope of the start; none: 1 m a side
};

/// Runs the start's body, then rules until nothing live is matched, or the steps of the `derive` way. What is left live
/// contributes its content. Error::Budget names the rule, the path in the tree, the seed and the line; Error::Input is
/// located too; Error::Cancelled comes within 50 ms.
Result<Derivation> derive(std::shared_ptr<const rules::Grammar> grammar, const Options& options, Progress* progress);

}  // namespace sgm::derive
