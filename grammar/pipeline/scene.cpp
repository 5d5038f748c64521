#include "grammar/pipeline/scene.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/placed_models.h"
#include "modeler/mesh/connected_components.h"

namespace sgm::pipeline {
namespace {

using derive::Derivation;

class SceneBuilder {
public:
    SceneBuilder(const Derivation& model, const SceneRequest& request, Context& context)
        : request_(request), context_(context), objects_(model, request.budget, context) {}

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
            object.values = objects_.valuesOf(objects_[todo[i]]);
        }
        return Done{};
    }

    /// Every place of every object, in tree order.
    Status placeAll(mesh::Scene& scene) {
        auto places = objects_.places(request_.budget.shapes);
        if (!places.ok()) return places.error();
        for (PlacedModels::Place& place : *places)
            if (meshed_[place.object] != derive::none)
                scene.instances.push_back({meshed_[place.object], std::move(place.part)});
        return Done{};
    }

private:
    struct Made {
        mesh::PackedMesh mesh;
        Provenance provenance;
    };

    /// Lowers an object, and meshes it where `out` isn't null; then its derivation goes, unless it holds objects.
    Status make(uint32_t index, Made* out, Context& own) {
        const PlacedModel& object = objects_[index];
        if (object.derivation->terminals() == 0 && !object.holds.empty()) return Done{};
        Derivation derivation = object.holds.empty() ? objects_.release(index) : Derivation(*object.derivation);
        if (!out) {
            const auto model = makeModel(std::move(derivation), own, Objects::Apart);
            return model.ok() ? Status(Done{}) : Status(model.error());
        }
        auto made = meshObject(std::move(derivation), request_, own);
        if (!made.ok()) return made.error();
        *out = {mesh::pack(made->mesh), std::move(made->provenance)};
        return Done{};
    }

    const SceneRequest& request_;
    Context& context_;
    PlacedModels objects_;
    std::vector<uint32_t> meshed_;  ///< by object: its index in Scene::objects; none: nothing solid of its own
};

}  // namespace

Result<ObjectMesh> meshObject(derive::Derivation derivation, const SceneRequest& request, Context& context) {
    auto model = makeModel(std::move(derivation), context, Objects::Apart);
    if (!model.ok()) return model.error();
    const mesh::Grid grid = gridOver(*model, {request.resolution, request.cell_m}, request.meshing.surface);
    const float cell_m = grid.cell_m;
    auto meshed = makeMesh(*model, grid, request.meshing, context);
    if (!meshed.ok()) return meshed.error();
    mesh::keepOnly(meshed->mesh, request.edits.keep, cell_m, context.threads);
    auto mesh = edited(std::move(meshed->mesh), request.edits, request.meshing.surface, cell_m, context);
    if (!mesh.ok()) return mesh.error();
    if (mesh->triangleCount() == 0) return noSurface(*model, cell_m);
    return ObjectMesh{std::move(*mesh), model->lowered->provenance};
}

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
