#include "grammar/pipeline/scene.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/placed_models.h"
#include "grammar/rules/params.h"
#include "modeler/mesh/connected_components.h"

namespace sgm::pipeline {
namespace {

using derive::Derivation;

class SceneBuilder {
public:
    SceneBuilder(const Derivation& model, const SceneRequest& request, Context& context)
        : model_(model), request_(request), context_(context), objects_(model, request.budget, context) {}

    Status deriveAll() { return objects_.derive(); }
    syntax::Diagnostics warnings() const { return objects_.warnings(); }

    /// Lowers every object; meshes it where `scene` isn't null.
    Status makeAll(mesh::Scene* scene) {
        meshed_.assign(objects_.size(), derive::none);
        std::vector<uint32_t> todo;
        for (uint32_t i = 0; i < objects_.size(); ++i)
            if (objects_[i].same == i) todo.push_back(i);
        if (context_.progress) context_.progress->begin("objects", todo.size());
        std::vector<Made> made(scene ? todo.size() : 0);
        std::vector<Status> done(todo.size(), Done{});
        objects_.inParallel(todo.size(), [&](size_t i, Context& own) {
            done[i] = make(todo[i], scene ? &made[i] : nullptr, own);
            tick(context_.progress);
        });
        if (cancelled(context_.progress)) return cancelledError();
        for (const Status& s : done)
            if (!s.ok()) return s;
        std::map<std::string, uint32_t> numbers;
        for (size_t i = 0; i < made.size(); ++i) {
            if (made[i].mesh.triangles.empty()) continue;
            meshed_[todo[i]] = static_cast<uint32_t>(scene->objects.size());
            mesh::SceneObject& object = scene->objects.emplace_back();
            object.name = objects_.nameOf(objects_[todo[i]]);
            if (const uint32_t number = ++numbers[object.name]; number > 1) object.name += fmt::format("_{}", number);
            object.mesh = mesh::unpack(std::exchange(made[i].mesh, {}));
            object.provenance = std::move(made[i].provenance);
            object.values = valuesOf(objects_[todo[i]]);
        }
        return Done{};
    }

    /// Every place of every object, in tree order.
    Status placeAll(mesh::Scene& scene) { return placeIn(model_, objects_.ofModel(), {}, {}, scene); }

private:
    struct Made {
        mesh::PackedMesh mesh;
        Provenance provenance;
    };

    /// Lowers an object, and meshes it where `out` isn't null; then its derivation goes, unless it holds objects.
    Status make(uint32_t index, Made* out, Context& own) {
        const PlacedModel& object = objects_[index];
        if (object.derivation->terminals() == 0 && !object.holds.empty()) return Done{};
        auto model = makeModel(object.holds.empty() ? objects_.release(index) : Derivation(*object.derivation), own,
                               Objects::Apart);
        if (!model.ok()) return model.error();
        if (!out) return Done{};
        const Box3f& bounds = model->lowered->field.bounds;
        const float cell_m =
            request_.cell_m > 0 ? static_cast<float>(request_.cell_m) : mesh::cellFor(bounds, request_.resolution);
        auto meshed = makeMesh(*model, mesh::gridFor(bounds, cell_m), request_.meshing, own);
        if (!meshed.ok()) return meshed.error();
        mesh::keepOnly(meshed->mesh, request_.edits.keep, cell_m, own.threads);
        auto mesh = edited(std::move(meshed->mesh), request_.edits, request_.meshing.surface, cell_m, own);
        if (!mesh.ok()) return mesh.error();
        if (mesh->triangleCount() == 0) return noSurface(*model, cell_m);
        out->mesh = mesh::pack(*mesh);
        out->provenance = model->lowered->provenance;
        return Done{};
    }

    std::map<std::string, std::string> valuesOf(const PlacedModel& object) const {
        std::map<std::string, std::string> values{{"start", objects_.nameOf(object)}};
        if (object.usedChance) values["seed"] = fmt::format("{}", object.inputs.seed);
        const auto usual = rules::valuesOf(*model_.grammar, object.inputs.start);
        for (size_t i = 0; i < usual.size(); ++i)
            if (object.inputs.params[i] != usual[i])
                values["param " + model_.grammar->params[i].name] = rules::toText(object.inputs.params[i]);
        return values;
    }

    Status placeIn(const Derivation& derivation, const std::vector<uint32_t>& holds, const Pose& frame,
                   const std::string& path, mesh::Scene& scene) {
        for (const derive::Placement& placement : derive::placementsOf(derivation)) {
            const uint32_t index = objects_.of(holds, placement.object);
            const PlacedModel& object = objects_[index];
            mesh::Instance instance;
            instance.part = partOf(derivation, placement.shape);
            if (!path.empty()) instance.part.path = path + "/" + instance.part.path;
            const Pose local = PlacedModels::poseOf(object, derivation.tree.shapes[placement.shape].scope);
            instance.part.pose = {frame.origin + frame.axes * local.origin, frame.axes * local.axes};
            if (meshed_[index] != derive::none) {
                instance.object = meshed_[index];
                scene.instances.push_back(instance);
            }
            if (scene.instances.size() > request_.budget.shapes)
                return Error{Error::Kind::Budget,
                             fmt::format("{}there are more than {} places of objects (--max-shapes)",
                                         syntax::placeText(derivation.tree.shapes[placement.shape].span),
                                         request_.budget.shapes)};
            if (cancelled(context_.progress)) return cancelledError();
            if (object.holds.empty()) continue;
            const Status inner =
                placeIn(*object.derivation, object.holds, instance.part.pose, instance.part.path, scene);
            if (!inner.ok()) return inner;
        }
        return Done{};
    }

    static Part partOf(const Derivation& derivation, derive::ShapeId id) {
        const derive::Shape& shape = derivation.tree.shapes[id];
        Part part;
        part.path = derivation.tree.path(id);
        part.symbol = derivation.tree.labels[shape.label];
        if (shape.madeBy != derive::none)
            part.rule = derivation.grammar->rules[derivation.steps[shape.madeBy].rule].name;
        if (shape.span.source) {
            part.file = shape.span.source->name();
            part.line = shape.span.source->place(shape.span.begin).line;
        }
        return part;
    }

    const Derivation& model_;
    const SceneRequest& request_;
    Context& context_;
    PlacedModels objects_;
    std::vector<uint32_t> meshed_;  ///< by object: its index in Scene::objects; none: nothing solid of its own
};

}  // namespace

Result<MadeScene> makeScene(const Model& model, const SceneRequest& request, Context& context) {
    MadeScene made;
    made.scene.ground = model.lowered->provenance;
    if (model.derivation.objects.empty()) return made;
    const Status done = context.timed("objects", [&]() -> Status {
        SceneBuilder builder(model.derivation, request, context);
        if (const Status s = builder.deriveAll(); !s.ok()) return s;
        if (const Status s = builder.makeAll(&made.scene); !s.ok()) return s;
        if (const Status s = builder.placeAll(made.scene); !s.ok()) return s;
        made.warnings = builder.warnings();
        mesh::shareMaterials(made.scene);
        return Done{};
    });
    if (!done.ok()) return done.error();
    return made;
}

Status tryObjects(const derive::Derivation& derivation, const derive::Budget& budget, Context& context) {
    if (derivation.objects.empty()) return Done{};
    SceneRequest request;
    request.budget = budget;
    SceneBuilder builder(derivation, request, context);
    if (const Status s = builder.deriveAll(); !s.ok()) return s;
    return builder.makeAll(nullptr);
}

}  // namespace sgm::pipeline
