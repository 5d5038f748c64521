#include "grammar/lower/box_row.h"

#include <algorithm>
#include <cmath>

#include "grammar/derive/scope_footprint.h"
#include "grammar/lower/solids.h"
#include "modeler/field/domain.h"

namespace sgm::lower {

bool BoxRow::takes(const derive::SolidValue& solid) { return isScopesBox(solid); }

bool BoxRow::isWholeBlock(const derive::SolidValue& solid, const derive::Scope& scope,
                          const derive::Footprints& footprints) {
    static const field::Primitive* const block = field::findPrimitive("block");
    if (solid.primitive != block || solid.kind != rules::Solid::Kind::Primitive) return false;
    if (scope.footprint == derive::none) return true;
    const plan::Footprint plan = derive::footprintOf(scope, footprints);
    if (plan.polygons.size() != 1 || plan.edgeCount() != 4) return false;
    constexpr double slack_m = 1e-6;
    const auto& points = plan.polygons[0].outer.points;
    const Vec3d half = scope.half();
    return std::all_of(points.begin(), points.end(), [&](plan::Vec2 p) {
        return std::abs(std::abs(p.x) - half.x) < slack_m && std::abs(std::abs(p.z) - half.z) < slack_m;
    });
}

/// The position along the row's axes.
field::Point BoxRow::position() {
    if (turn_ == knownTurn_) return position_;
    knownTurn_ = turn_;
    position_ = field::turned(graph_.position(), tree_.shapes.axesOf(turn_), tree_.shapes.record(turn_).key);
    graph_.literal(0);  // as field::solids::boxDistance
    return position_;
}

field::Owned BoxRow::make(size_t i, field::NodeId first, const field::Point& p, OriginId firstOwner) {
    const size_t shape = joined_.empty() ? i : joined_[i].first;
    const derive::Scope scope = joined_.empty() ? tree_.shapes.scopeOf(shapes_[i]) : joined_[i].scope;
    const uint64_t key = tree_.shapes.record(shapes_[shape]).key;
    graph_.setBox(first, i, p, {key, boxNumbers(scope)});
    const auto number = static_cast<uint32_t>(i);
    const field::NodeRef value(&graph_, first + number * field::Graph::boxNodes + field::Graph::boxNodes - 1);
    return {boxField(value, scope), firstOwner + static_cast<OriginId>(shape)};
}

}  // namespace sgm::lower
