// Objects as part of the field of the model that places them.
#include <fmt/format.h>

#include "grammar/derive/graft.h"
#include "grammar/pipeline/placed_models.h"
#include "grammar/pipeline/scene.h"

namespace sgm::pipeline {
namespace {

using derive::Derivation;
using derive::Placement;

/// Copies of an object and of those that it holds.
Status graftCopy(Derivation& model, derive::ShapeId at, const PlacedModels& objects, uint32_t index, const Pose& pose,
                 const Progress* progress) {
    if (cancelled(progress)) return cancelledError();
    const PlacedModel& object = objects[index];
    const size_t first = model.tree.shapes.size();
    derive::graft(model, at, *object.derivation, pose);
    for (const Placement& inner : derive::placementsOf(*object.derivation)) {
        const auto shape = static_cast<derive::ShapeId>(first + inner.shape);
        const uint32_t held = objects.of(object.holds, inner.object);
        const Pose own = PlacedModels::poseOf(objects[held], model.tree.shapes[shape].scope);
        if (const Status s = graftCopy(model, shape, objects, held, own, progress); !s.ok()) return s;
    }
    return Done{};
}

Status graftAll(Derivation& model, const PlacedModels& objects, bool copies, const Progress* progress) {
    for (const Placement& placement : derive::placementsOf(model)) {
        const uint32_t index = objects.of(objects.ofModel(), placement.object);
        const Pose pose = PlacedModels::poseOf(objects[index], model.tree.shapes[placement.shape].scope);
        if (copies)
            if (const Status s = graftCopy(model, placement.shape, objects, index, pose, progress); !s.ok()) return s;
        if (!copies) derive::graftMass(model, placement.shape, *objects[index].derivation, pose);
        if (cancelled(progress)) return cancelledError();
        ++(copies ? model.copies : model.masses);
    }
    for (derive::Extras& extras : model.tree.extras) extras.object = derive::none;
    model.objects = {};
    model.tree.shapes.shrink();
    model.steps.shrink();
    return Done{};
}

}  // namespace

Status graftObjects(Derivation& derivation, Objects objects, const derive::Budget& budget, Context& context) {
    if (derivation.objects.empty()) return Done{};
    return context.timed("objects", [&]() -> Status {
        const Derivation model = derivation;
        PlacedModels made(model, budget, context);
        if (const Status s = made.derive(); !s.ok()) return s;
        uint64_t shapes = model.tree.shapes.size();
        for (const Placement& placement : derive::placementsOf(model))
            shapes += made.shapesOf(made.of(made.ofModel(), placement.object));
        derivation.selections.add(made.selections());
        const bool copies = shapes <= budget.shapes;
        if (copies || objects == Objects::Sketched) return graftAll(derivation, made, copies, context.progress);
        return Error{Error::Kind::Budget,
                     fmt::format("{}as one field the model with its objects has {} shapes, and the budget is {}: build "
                                 ".glb, .gltf, .usda, .obj, .ply or .stl, or draw --view mesh, which make each object "
                                 "once; or raise --max-shapes",
                                 syntax::placeText(model.tree.shapes[0].span), shapes, budget.shapes)};
    });
}

}  // namespace sgm::pipeline
