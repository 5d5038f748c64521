// Handles of plans in the view: points and sides that the text holds as numbers, and what dragging them writes.
// Enters: a document and the model made of it. Leaves: places in space, then edits of the text. Assumes that the model
// is the text's (picking.h, isCurrent); edits are of the text that the handles were made from, however it has changed
// since.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/document/edits.h"
#include "viewer/document/session.h"

namespace sgm::document {

/// The shape that covers most of the plan, as the ground of a town does; the oldest of several. O(shapes).
derive::ShapeId widestShape(const derive::ShapeTree& tree);

/// Something of a plan that can be taken hold of.
struct PlanHandle {
    enum class Kind : uint8_t {
        Point,  ///< a corner of an outline, where roads begin, the middle of a bump
        Side    ///< an edge of an outline, or of a plan with numbers, as the width of a `rect`
    };
    Kind kind = Kind::Point;
    std::string name;  ///< "corner 2", "side 1", "from", "old": what it is in the text
    Vec3d at;          ///< metres, the object's frame: a side's middle
    Vec3d ends[2];     ///< of a side
};

class PlanHandles {
public:
    /// The handles of the footprint that a shape stands on, where its own text says it in numbers: the points and sides
    /// of an `outline`, the sides of a `rect`, `ell` and the like. Where nothing is selected, or the root, those of a
    /// town: `from` and `centre` of roads, the middles of the bumps of maps. None where the model isn't the text's.
    static PlanHandles of(const Document& document, const BuiltModel& shown, derive::ShapeId selected);

    PlanHandles();
    ~PlanHandles();
    PlanHandles(PlanHandles&&) noexcept;
    PlanHandles& operator=(PlanHandles&&) noexcept;

    const std::vector<PlanHandle>& all() const { return handles_; }
    /// Moves a handle to a place at its own height: sides go along their normal. Numbers are written in their own units
    /// in steps of `step_m` metres or a thousandth of the scope. Error::Input where the plan would have no room.
    edits::Edit move(size_t handle, Vec3d to, double step_m) const;
    /// The syntax tree that edits are of.
    const std::shared_ptr<const syntax::Ast>& ast() const { return ast_; }

    /// What a family of handles is made of: an outline, a plan with numbers, a point of the ground.
    class Source;

private:
    struct Place {
        size_t source, index;
    };
    void add(std::unique_ptr<Source> source);

    std::shared_ptr<const syntax::Ast> ast_;
    std::vector<std::unique_ptr<Source>> sources_;
    std::vector<PlanHandle> handles_;
    std::vector<Place> places_;  ///< by handle
};

}  // namespace sgm::document
