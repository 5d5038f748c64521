// Boxes of a plain sum that follow each other, made together: most terminals of a facade.
// Enters: shapes in the order of the walk, all of one rotation, none turned itself. Leaves: their nodes and slots in
// the graph, and terms of the sum, as `lowerSolid` makes them one by one. Assumes that nothing else is added to the
// graph between the first of a row and `place`, and that no slot has a key of these shapes yet. Each box has places of
// its own in every array, so that threads can share a row, and the number of them doesn't show.
#pragma once

#include "grammar/derive/derive.h"
#include "grammar/lower/joined_boxes.h"
#include "modeler/core/pages.h"
#include "modeler/core/parallel.h"
#include "modeler/field/combine.h"

namespace sgm::lower {

class BoxRow {
public:
    BoxRow(const derive::Derivation& derivation, field::Graph& graph, int threads)
        : tree_(derivation.tree), graph_(graph), threads_(threads) {}

    /// Whether the solid is the box of its scope, whatever its numbers.
    static bool takes(const derive::SolidValue& solid);
    /// Whether it is a block over all of its scope, which is a box too.
    static bool isWholeBlock(const derive::SolidValue& solid, const derive::Scope& scope,
                             const derive::Footprints& footprints);
    bool empty() const { return shapes_.empty(); }
    std::span<const derive::ShapeId> shapes() const { return shapes_; }
    /// Whether a shape that has been turned with `turn` may join: the row isn't full and has that rotation.
    bool hasPlaceFor(derive::ShapeId turn) const { return shapes_.size() < most && (empty() || turn == turn_); }
    void add(derive::ShapeId id, derive::ShapeId turn) {
        shapes_.push_back(id);
        turn_ = turn;
    }
    /// Makes the boxes, owned by `firstOwner` and those after it, appends them to `terms` and begins another row.
    /// Meanwhile `beside()` runs once, on some thread.
    template <class Beside>
    void place(PageVector<field::Owned>& terms, OriginId firstOwner, Beside&& beside) {
        const field::Point p = position();
        const size_t count = joined_.empty() ? shapes_.size() : joined_.size();
        const field::NodeId first = graph_.addBoxes(count);
        const size_t before = terms.size(), chunks = (count + chunk - 1) / chunk;
        terms.resize(before + count);
        parallelFor(chunks + 1, count > chunk ? threads_ : 1, nullptr, [&](size_t task, int) {
            if (task == 0) return beside();
            for (size_t i = (task - 1) * chunk; i < std::min(task * chunk, count); ++i)
                terms[before + i] = make(i, first, p, firstOwner);
        });
        shapes_.clear(), joined_.clear();
    }
    /// Joins the row's boxes of one material, which `materialOf(shape)` tells; the first one of those joined owns all.
    template <class MaterialOf>
    void join(MaterialOf&& materialOf) {
        std::vector<derive::Scope> scopes;
        std::vector<uint32_t> materials;
        for (const derive::ShapeId id : shapes_)
            scopes.push_back(tree_.shapes.scopeOf(id)), materials.push_back(materialOf(id));
        joined_ = joinBoxes(scopes, materials);
    }

private:
    static constexpr size_t most = 1 << 14, chunk = 1 << 11;

    field::Point position();
    field::Owned make(size_t i, field::NodeId first, const field::Point& p, OriginId firstOwner);

    const derive::ShapeTree& tree_;
    field::Graph& graph_;
    const int threads_;
    PageVector<derive::ShapeId> shapes_;
    std::vector<JoinedBox> joined_;             ///< of the shapes; empty where they stay apart
    derive::ShapeId turn_ = derive::none;       ///< of the row: the shape from which on nothing is turned
    derive::ShapeId knownTurn_ = derive::none;  ///< of `position_`
    field::Point position_;
};

}  // namespace sgm::lower
