// Growing the shape tree: SG-M's engine (eqs. 1–8, 15–16).
// Enters: a Grammar, parameter values, a seed, a budget. Leaves: a Derivation: the ShapeTree and the log of steps.
// Assumes a grammar that passed `check`. A generation reads the state at its start and commits in key order; conflicts go
// to the lower key. Every draw is keyed by the shape's path, so editing one branch leaves the draws of the others alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/rules/grammar.h"
#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/field/domain.h"

namespace sgm::derive {

using ShapeId = uint32_t;
inline constexpr uint32_t none = rules::none;

/// An oriented box: centre, axes, size in metres.
struct Scope {
    Vec3d centre;
    Mat3 axes;   ///< world from local
    Vec3d size;  ///< metres, > 0
};

/// A joint point J = (P, D), eq. 15, in the object's frame.
struct Joint {
    std::string_view name;  ///< "+x" … "-z", "centre", or declared
    Vec3d point;
    Vec3d direction;        ///< zero: meets any other
    uint32_t bond = none;   ///< the bond that consumed it
};

/// B = (J₁, J₂) ⇔ J₁.P = J₂.P ∧ J₁.D = −J₂.D, eq. 16 (or a D of zero).
struct Bond {
    ShapeId shape[2];
    uint32_t joint[2];  ///< indices into the shapes' joints
};

/// An evaluated solid, numbers bound.
struct SolidValue {
    rules::Solid::Kind kind = rules::Solid::Kind::Nil;
    const field::Primitive* primitive = nullptr;
    std::vector<rules::Value> args;
    std::vector<SolidValue> parts;
    rules::Operator op = rules::Operator::None;
    double amount = 0;
};

struct Displacement {
    bool fbm = false;
    double amplitude_m = 0, frequency = 1;
    int octaves = 2;
};

/// A node of the shape tree. Its field is its own solid combined with its children in order.
struct Shape {
    uint64_t key = 0;             ///< hash(parent's key, rule, label or ordinal, repeat index): names its random stream
    ShapeId parent = none;
    rules::SymbolId symbol = rules::none;  ///< none for an anonymous solid
    std::string path;             ///< "Cave/Cell[3]"
    rules::Operator op = rules::Operator::None;  ///< how it joins its parent
    double amount = 0;            ///< for op Morph: a (`by`)
    double blend_m = 0;           ///< melts into what stands with this radius
    std::vector<Displacement> displace;
    bool live = false;            ///< rules may still rewrite it
    Scope scope;
    std::optional<SolidValue> solid;
    uint32_t material = rules::none;  ///< index into Derivation::materials; none inherits
    std::vector<std::pair<std::string, rules::Value>> values;  ///< `with`
    std::vector<std::string> tags;
    std::vector<Joint> joints;
    std::vector<ShapeId> children;  ///< in joining order
    uint32_t madeBy = none;         ///< step that made it; none for the start
    syntax::SourceSpan span;        ///< the text that made it
};

/// One rule application.
struct Step {
    uint32_t rule = 0;
    ShapeId shape = none;         ///< the matched one
    uint32_t generation = 0;
    uint32_t chainIndex = 0;      ///< i of a repeat, 0 otherwise
    bool morphic = false;
    std::vector<ShapeId> made;
};

/// The shape tree; shapes[0] is the root. Parents come before their children.
struct ShapeTree {
    std::vector<Shape> shapes;
    std::vector<Bond> bonds;
};

struct Derivation {
    std::shared_ptr<const rules::Grammar> grammar;
    ShapeTree tree;
    std::vector<Step> steps;
    std::vector<Material> materials;  ///< the grammar's, then those given by attributes
    std::vector<rules::Value> params;
    uint64_t seed = 0;
    uint64_t classic = 0, morphic = 0;  ///< rule applications of R_C and R_M
    /// Pairs of shapes whose boxes overlap without being bonded or related.
    uint64_t overlaps() const;
    uint64_t terminals() const;
};

struct Budget {
    uint64_t shapes = 2'000'000;
    uint32_t depth = 10'000;
    uint64_t memory_bytes = 4ull << 30;
    double seconds = 600;
};

struct Options {
    uint32_t start = 0;                  ///< index into Grammar::starts
    std::string derive;                  ///< name of a `derive` way; empty: automatic
    std::vector<rules::Value> params;    ///< by index; empty: the defaults
    uint64_t seed = 1;
    Budget budget;
};

/// Error::Budget names the rule, the path in the tree, the seed and the line.
Result<Derivation> derive(std::shared_ptr<const rules::Grammar> grammar, const Options& options, Progress* progress);

/// One check's verdict, for `sgm check`.
struct Verdict { bool passed = false; std::string message; syntax::SourceSpan span; };
Result<std::vector<Verdict>> runChecks(std::shared_ptr<const rules::Grammar> grammar, uint64_t seed, Progress* progress);

}  // namespace sgm::derive
