#include "grammar/derive/parts_context.h"

#include <cmath>

#include "grammar/derive/scope_footprint.h"
#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::derive {
namespace {

/// Calls `change` for every child of a node behind `before` (none: all).
template <class Change>
void eachNew(ShapeTree& tree, ShapeId node, ShapeId before, Change&& change) {
    for (ShapeId s = before == none ? tree.shapes[node].firstChild : tree.shapes[before].nextSibling; s != none;
         s = tree.shapes[s].nextSibling)
        change(s);
}

}  // namespace

rules::Value PartsContext::evaluate(const rules::Expr& expr, uint64_t key) const {
    Place place = frame_.place;
    place.key = combine(frame_.key, key);
    return derive::evaluate(expr, place);
}

rules::Value PartsContext::evaluate(const rules::Expr& expr, uint64_t key, bool whole) const {
    if (!whole) return evaluate(expr, key);
    Place place = frame_.place;
    place.key = combine(frame_.key, key);
    const bool drawn = expr.kind == rules::Expr::Kind::Range || expr.kind == rules::Expr::Kind::Choose;
    rules::Value value = drawn ? rules::Value::number(wholeNumber(expr, place)) : derive::evaluate(expr, place);
    value.integer = value.kind == rules::Value::Kind::Number && value.num() == std::floor(value.num());
    return value;
}

void PartsContext::place(PlacedObject object) {
    TreeBuilder& builder = interpreter_.builder_;
    builder.extras(frame_.node).object = builder.derivation().objects.put(std::move(object));
}

double PartsContext::sharedBy(const Scope& part) const {
    startsOver();
    TreeBuilder& builder = interpreter_.builder_;
    return builder.surroundings().shared(builder.tree(), frame_.node, part);
}

std::vector<double> PartsContext::facesAlong(rules::SymbolId symbol, int axis) const {
    startsOver();
    TreeBuilder& builder = interpreter_.builder_;
    const Scope& own = scope();
    const Vec3d along = own.axes * Vec3d{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
    const Vec3d low = own.centre - along * (own.size[axis] / 2);
    std::vector<double> faces;
    for (const ShapeId s : builder.surroundings().shapesOf(symbol)) {
        const Scope& other = builder.tree().shapes[s].scope;
        const Vec3d axes[3] = {other.axes.x, other.axes.y, other.axes.z};
        for (int i = 0; i < 3; ++i) {
            if (std::abs(dot(axes[i], along)) < 1 - 1e-9) continue;
            const double at = dot(other.centre - low, along), half = other.size[i] / 2;
            faces.push_back(at - half);
            faces.push_back(at + half);
        }
    }
    return faces;
}

plan::Footprint PartsContext::footprint() const {
    return footprintOf(scope(), interpreter_.builder_.tree().footprints);
}

std::optional<Scope> PartsContext::over(Scope scope, const plan::Footprint& footprint, syntax::SourceSpan span) {
    Footprints& footprints = interpreter_.builder_.tree().footprints;
    auto index = footprints.put(footprint, scope.half());
    if (!index.ok())  // what was cut off a bend may touch itself by a hair
        if (const auto sound = plan::resolved(footprint); sound.ok() && !sound->empty())
            index = footprints.put(*sound, scope.half());
    if (!index.ok()) {
        fail(index.error().message, span);
        return std::nullopt;
    }
    scope.footprint = *index;
    return scope;
}

std::optional<Scope> PartsContext::cut(int axis, double low_m, double high_m) {
    Scope part = scope();
    const double whole_m = part.size[axis];
    Vec3d moved;
    moved[axis] = (low_m + high_m - whole_m) / 2;
    part.centre += part.axes * moved;
    part.size[axis] = high_m - low_m;
    if (part.footprint == none || axis == 1) return part;
    // A mitred plate reaches beyond its scope, and the first and last part have that too; lengths that share a scope
    // add up to it but for rounding.
    const double slack_m = 1e-9 * whole_m;
    const double lo = low_m <= slack_m ? -plan::Limits{}.farthest_m : low_m - whole_m / 2;
    const double hi = high_m >= whole_m - slack_m ? plan::Limits{}.farthest_m : high_m - whole_m / 2;
    const plan::Footprint clipped = plan::cleaned(
        plan::placed(plan::between(footprint(), axis == 0 ? 0 : 1, lo, hi), {1, 1}, {-moved.x, -moved.z}));
    part.footprint = none;
    if (clipped.empty()) return std::nullopt;
    const plan::Footprint box = footprintOf(part, interpreter_.builder_.tree().footprints);
    const bool isBox = clipped.edgeCount() == 4 && std::abs(area(clipped) - area(box)) < 1e-9 * area(box) &&
                       bounds(clipped).size() == bounds(box).size();
    return isBox ? part : over(part, clipped, syntax::SourceSpan{});
}

bool PartsContext::run(const rules::Body& body, const Scope& part, uint64_t key) {
    Interpreter::Frame inner = frame_;
    inner.key = inner.place.key = combine(frame_.key, key);
    inner.place.scope = part;
    inner.place.host = none;
    return interpreter_.builder_.monitor().work() && interpreter_.runBody(body, inner, 0);
}

uint32_t PartsContext::addRelief(Relief relief) {
    std::vector<Relief>& reliefs = interpreter_.builder_.derivation().reliefs;
    reliefs.push_back(std::move(relief));
    return static_cast<uint32_t>(reliefs.size() - 1);
}

bool PartsContext::runOn(uint32_t relief, const rules::Body& body, const Scope& part, uint64_t key) {
    TreeBuilder& builder = interpreter_.builder_;
    const ShapeId before = builder.tree().shapes[frame_.node].lastChild;
    if (!run(body, part, key)) return false;
    eachNew(builder.tree(), frame_.node, before, [&](ShapeId s) { builder.extras(s).relief = relief; });
    return true;
}

bool PartsContext::cutting(const std::function<bool()>& run) {
    ShapeTree& tree = interpreter_.builder_.tree();
    const ShapeId before = tree.shapes[frame_.node].lastChild;
    if (!run()) return false;
    eachNew(tree, frame_.node, before,
            [&](ShapeId s) { tree.shapes.record(s).op = static_cast<uint32_t>(rules::Operator::Difference); });
    return true;
}

const rules::Grammar& PartsContext::grammar() const { return *interpreter_.builder_.derivation().grammar; }

void PartsContext::draw(std::string layer, const Scope& scope, const plan::Footprint& area, uint64_t key,
                        double street_m) {
    interpreter_.builder_.derivation().plan.features.push_back(
        {std::move(layer), inModelPlan(scope, area), key, street_m});
}

void PartsContext::startsOver() const {
    if (Recording* recording = interpreter_.builder_.recording()) recording->unfit();
}

bool PartsContext::fail(const Error& why, syntax::SourceSpan span) {
    interpreter_.builder_.monitor().fail(why.kind, why.message, span);
    return false;
}

void PartsContext::warn(syntax::SourceSpan span, std::string message, std::string fix) const {
    interpreter_.builder_.warn(span, std::move(message), std::move(fix));
}

bool PartsContext::fail(const std::string& what, syntax::SourceSpan span) {
    interpreter_.builder_.monitor().fail(Error::Kind::Input, what, span);
    return false;
}

}  // namespace sgm::derive
