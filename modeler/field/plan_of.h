// The footprint that a solid of the primitive table stands over.
// Enters: its input. Leaves: the plan's field. Not for other folders.
#pragma once

#include <optional>

#include "modeler/core/random.h"
#include "modeler/field/plan_field.h"
#include "modeler/field/primitives.h"
#include "modeler/plan/shapes.h"

namespace sgm::field {

/// The footprint of the scope, else the scope's rectangle.
class PlanOf {
public:
    explicit PlanOf(const PrimitiveInput& in) : plan_(in.plan) {
        if (plan_) return;
        rectangle_ = plan::rectangle(2 * in.halfValue.x, 2 * in.halfValue.z).value();
        formula_ = plan::monotoneFormula(rectangle_).value();
        plan_ = &own_.emplace(rectangle_, formula_, in.p, combine(in.path, hashText("plan")));
    }
    PlanOf(const PlanOf&) = delete;
    PlanOf& operator=(const PlanOf&) = delete;
    const PlanField& operator*() const { return *plan_; }

private:
    const PlanField* plan_;
    plan::Footprint rectangle_;
    plan::Formula formula_;
    std::optional<PlanField> own_;
};

}  // namespace sgm::field
