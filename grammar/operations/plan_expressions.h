// What `footprint` draws: calls of plans, outlines, L-systems, and their unions and differences.
// Enters: written expressions, then scopes. Leaves: checked plans, then footprints in metres. Assumes one newcomer at a
// time.
#pragma once

#include <memory>

#include "grammar/derive/attribute_context.h"
#include "grammar/rules/operation_checker.h"

namespace sgm::operations {

/// The checked plan, or null after an error.
std::shared_ptr<const rules::PlanExpr> checkPlan(rules::OperationChecker& checker, const syntax::Expr& e);

/// A drawn plan.
struct DrawnPlan {
    plan::Footprint footprint;  ///< metres; about the scope's centre where it fills the scope
    bool keepsPlace = false;    ///< it was drawn in shares of the scope, or in the coordinates of a file
};
/// The plan in the scope of `context`; nothing after a failure.
std::optional<DrawnPlan> drawPlan(const derive::AttributeContext& context, const rules::PlanExpr& plan);

}  // namespace sgm::operations
