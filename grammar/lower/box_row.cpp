#include "grammar/lower/box_row.h"

#include "grammar/lower/solids.h"
#include "modeler/field/domain.h"

namespace sgm::lower {

bool BoxRow::takes(const derive::SolidValue& solid) { return isScopesBox(solid); }

/// The position along the row's axes.
field::Point BoxRow::position() {
    if (turn_ == knownTurn_) return position_;
    knownTurn_ = turn_;
    position_ = field::turned(graph_.position(), tree_.shapes.axesOf(turn_), tree_.shapes.record(turn_).key);
    graph_.literal(0);  // as field::solids::boxDistance
    return position_;
}

field::Owned BoxRow::make(size_t i, field::NodeId first, const field::Point& p, OriginId firstOwner) {
    const derive::Scope scope = tree_.shapes.scopeOf(shapes_[i]);
    const uint64_t key = tree_.shapes.record(shapes_[i]).key;
    graph_.setBox(first, i, p, {key, boxNumbers(scope)});
    const auto number = static_cast<uint32_t>(i);
    const field::NodeRef value(&graph_, first + number * field::Graph::boxNodes + field::Graph::boxNodes - 1);
    return {boxField(value, scope), firstOwner + number};
}

}  // namespace sgm::lower
