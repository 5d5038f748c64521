// The walk from shapes to fields, and what it leaves for a second one.
// Enters: a derivation. Leaves: graph, field and parts in the model. Assumes parents before their children. The entry
// points are lower.h, for a model once, and incremental_lowering.h, for one that follows its derivation.
#pragma once

#include <set>
#include <unordered_map>

#include "grammar/lower/box_row.h"
#include "grammar/lower/lower.h"
#include "grammar/lower/materials.h"
#include "grammar/lower/part_texts.h"
#include "grammar/lower/shared_plans.h"
#include "modeler/field/combine.h"

namespace sgm::lower {

using derive::none;
using derive::Shape;
using derive::ShapeId;
using derive::ShapeTree;
using field::Owned;
using rules::Operator;

/// Parts of one pending n-ary sum, or of one pending blend.
struct Parts {
    PageVector<Owned> terms;
    double blend_m = 0;  ///< > 0: the terms are those of a blend with this radius
    uint64_t blendKey = 0;
};

/// A plain sum of many parts, kept.
struct KeptSum {
    PageVector<Owned> terms;
    field::NodeRef value;
};

/// What a node holds so far. Cuts in a row are gathered, for a − b − c = a − (b + c) and one sum of many parts is
/// cheap.
struct Content : Parts {
    ShapeId shape = none;       ///< the node whose content this is
    std::vector<ShapeId> from;  ///< who gave each term, while they are a plain sum; only where the lowering keeps
    Parts cuts;                 ///< taken from the terms when anything else comes
};

/// Walks the tree once, without recursion. A child that only adds to what stands, and is itself a plain sum, pours its
/// terms into its parent's, so that thousands of parts meet in one n-ary sum.
class Lowering {
public:
    struct Options {
        bool keeps = false;       ///< `replay` may follow
        bool joinsBoxes = false;  ///< see lower()
        int threads = 1;          ///< 0: all that the machine has
    };
    Lowering(const derive::Derivation& d, Model& model, Options options)
        : d_(d),
          tree_(d.tree),
          model_(model),
          materials_(d),
          texts_(d),
          owners_(d.tree.shapes.size(), 0),
          row_(d, model.graph, options.threads),
          plans_(d.tree.footprints),
          options_(options) {}

    Status run(Progress* progress);
    /// After `run`, when the derivation changed in place: the parts that hold one of these shapes, again. False where
    /// the field has another structure now; then the model is of no use any more.
    bool replay(std::span<const ShapeId> changed);

private:
    void surveyShapes();
    void noteTurn(ShapeId id);
    Status walk(ShapeId top, Progress* progress);
    void attachToParent(ShapeId id, const Owned& part);
    Owned whole(Content& content, ShapeId id);
    Owned solidOf(ShapeId id);
    void nameTheWhole();
    void poseTheWhole();
    void mergeMaterials();

    // incremental_lowering.cpp; dressing.cpp has what dresses a whole content
    using Dirty = std::set<ShapeId, std::greater<>>;
    ShapeId partOf(ShapeId id) const;
    bool changeTerm(ShapeId part, ShapeId from, const Owned& to);
    bool mark(ShapeId changed, Dirty& dirty);
    bool replayPart(ShapeId part, Dirty& dirty);
    void enter(ShapeId id);
    void leave(ShapeId id);
    void join(Content& content, ShapeId id, Owned part);
    Owned take(Content& content);
    Owned takeParts(Parts& parts);
    void flush(Content& content);
    OriginId ownerOf(ShapeId id);
    void addPart(ShapeId id);
    void placeBoxes();
    Owned applyCladding(Owned part, ShapeId id);
    Owned displaced(Owned part, ShapeId id);
    Owned draped(Owned part, ShapeId id);
    bool flattensIntoParent(ShapeId id) const;
    bool isSum(const Shape& s) const { return (s.op == Operator::Sum || s.op == Operator::None) && s.blend_m <= 0; }

    const derive::Derivation& d_;
    const ShapeTree& tree_;
    Model& model_;
    Materials materials_;
    std::vector<Content> open_;
    PageVector<ShapeId> turnedAt_;  ///< by shape: the highest above it, or itself, from which on nothing turned
    std::vector<bool> plain_;       ///< by shape: its content is nothing but a sum
    PartTexts texts_;
    PageVector<OriginId> owners_;  ///< by shape; 0: not asked for
    BoxRow row_;                   ///< boxes of the innermost open node that have yet to be made
    SharedPlans plans_;
    struct Noted {
        size_t cladNodes = 0;      ///< of the graph, made for cladding
        ShapeId refused = none;    ///< the first shape whose cladding was one too much
        ShapeId boundless = none;  ///< the first shape whose noise left no bounds
    } noted_;

    /// What a second run begins with.
    struct Kept {
        std::vector<bool> joins;                    ///< by shape: isSum
        std::vector<Owned> parts;                   ///< by shape: the part it is, unless it pours
        std::unordered_map<ShapeId, KeptSum> sums;  ///< by the shape whose content it is
        std::vector<uint32_t> termOf;               ///< by shape: its place among the terms of a kept sum, or none
    };
    const Options options_;
    bool again_ = false;  ///< parts below the top of a walk are known
    Kept kept_;
};

}  // namespace sgm::lower
