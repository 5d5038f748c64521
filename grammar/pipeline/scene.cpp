#include "grammar/pipeline/scene.h"

#include <set>
#include <utility>

#include "grammar/pipeline/buried.h"
#include "grammar/pipeline/floating.h"
#include "grammar/pipeline/floating_objects.h"
#include "grammar/pipeline/gaps.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/missing.h"
#include "grammar/pipeline/placed_models.h"
#include "modeler/core/distinct_names.h"
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
    /// To be asked before they are meshed.
    PlacedFigures figures() const { return objects_.figures(); }
    /// The same.
    syntax::Diagnostics floating() const { return floatingObjects(model_, objects_); }

    /// Lowers every object.
    Status tryAll() {
        return forAll(different(), [&](size_t, uint32_t object, Context& own) { return make(object, nullptr, own); });
    }

    /// Meshes the first object of each start for what its cells lack.
    Result<std::vector<MeshWarning>> lookAtFirst() {
        inspected_ = objects_.firstOfEachStart();
        std::vector<uint32_t> todo = different();
        std::erase_if(todo, [&](uint32_t object) { return !inspected_.contains(object); });
        const auto made = meshAll(todo);
        if (!made.ok()) return made.error();
        return lacksOf(*made);
    }

    /// Lowers and meshes every object.
    Status makeAll(MadeScene& out) {
        meshed_.assign(objects_.size(), derive::none);
        if (request_.seeksThinParts) inspected_ = objects_.firstOfEachStart();
        const std::vector<uint32_t> todo = different();
        auto meshed = meshAll(todo);
        if (!meshed.ok()) return meshed.error();
        std::vector<Made>& made = *meshed;
        out.meshWarnings = lacksOf(made);
        mesh::Scene* const scene = &out.scene;
        DistinctNames names;
        for (size_t i = 0; i < made.size(); ++i) {
            if (made[i].mesh.triangles.empty()) continue;
            meshed_[todo[i]] = static_cast<uint32_t>(scene->objects.size());
            mesh::SceneObject& object = scene->objects.emplace_back();
            object.name = names.take(objects_.nameOf(objects_[todo[i]]));
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
        std::vector<MeshWarning> lacks;
    };

    /// One of each that are alike.
    std::vector<uint32_t> different() const {
        std::vector<uint32_t> todo;
        for (uint32_t i = 0; i < objects_.size(); ++i)
            if (objects_[i].same == i) todo.push_back(i);
        return todo;
    }

    /// work(place in the list, object, context), several at a time; the first error in the order of the list.
    template <class Work>
    Status forAll(const std::vector<uint32_t>& todo, Work&& work) {
        if (context_.progress) context_.progress->begin("objects", todo.size());
        std::vector<Status> done(todo.size(), Done{});
        objects_.inParallel(todo.size(), [&](size_t i, Context& own) {
            done[i] = work(i, todo[i], own);
            tick(context_.progress);
        });
        if (cancelled(context_.progress)) return cancelledError();
        for (const Status& s : done)
            if (!s.ok()) return s;
        return Done{};
    }

    Result<std::vector<Made>> meshAll(const std::vector<uint32_t>& todo) {
        std::vector<Made> made(todo.size());
        const Status done =
            forAll(todo, [&](size_t i, uint32_t object, Context& own) { return make(object, &made[i], own); });
        if (!done.ok()) return done.error();
        return made;
    }

    static std::vector<MeshWarning> lacksOf(const std::vector<Made>& made) {
        std::vector<MeshWarning> all;
        for (const Made& m : made) all.insert(all.end(), m.lacks.begin(), m.lacks.end());
        return all;
    }

    /// Lowers an object, and meshes it where `out` isn't null; then its derivation goes, unless it holds objects.
    Status make(uint32_t index, Made* out, Context& own) {
        const PlacedModel& object = objects_[index];
        if (!hasSolids(object)) return Done{};
        const bool isInspected = inspected_.contains(index);
        Derivation derivation = object.holds.empty() ? objects_.release(index) : Derivation(*object.derivation);
        if (!out) {
            const auto model = makeModel(std::move(derivation), own, Objects::Apart);
            return model.ok() ? Status(Done{}) : Status(model.error());
        }
        const std::string name = isInspected ? objects_.nameOf(object) : std::string();
        auto made = meshObject(std::move(derivation), request_, own, name);
        if (!made.ok()) return made.error();
        *out = {mesh::pack(made->mesh), std::move(made->provenance), std::move(made->lacks)};
        return Done{};
    }

    const Derivation& model_;
    const SceneRequest& request_;
    Context& context_;
    PlacedModels objects_;
    std::set<uint32_t> inspected_;  ///< objects of which is told what their cells lack
    std::vector<uint32_t> meshed_;  ///< by object: its index in Scene::objects; none: nothing solid of its own
};

}  // namespace

Result<ObjectMesh> meshObject(derive::Derivation derivation, const SceneRequest& request, Context& context,
                              const std::string& name) {
    auto model = makeModel(std::move(derivation), context, Objects::Apart, {}, request.joinsBoxes);
    if (!model.ok()) return model.error();
    const mesh::Grid grid = gridOver(*model, {request.resolution, request.cell_m}, request.meshing.surface);
    const float cell_m = grid.cell_m;
    auto meshed = makeMesh(*model, grid, request.meshing, context);
    if (!meshed.ok()) return meshed.error();
    std::vector<MeshWarning> lacks;
    if (!name.empty()) {
        const auto missing = findMissingParts(*model, *meshed, context.threads, context.progress);
        if (!missing.ok()) return missing.error();
        lacks = missingWarnings(*model, grid, *missing, name);
        auto buried = buriedWarnings(*model, meshed->mesh, context);
        if (!buried.ok()) return buried.error();
        for (MeshWarning& hidden : *buried) lacks.push_back(std::move(hidden));
        // What smaller cells would show, or what they hold, is told by what is missing.
        Support support = supportOf(*model, meshed->mesh, cell_m);
        if (const Status s = findCauses(*model, meshed->mesh, cell_m, *missing, support, context.progress); !s.ok())
            return s.error();
        for (MeshWarning& floats : floatingWarnings(*model, support, cell_m))
            if (!floats.ofCells) lacks.push_back(std::move(floats));
    }
    mesh::keepOnly(meshed->mesh, request.edits.keep, cell_m, context.threads);
    auto mesh = edited(std::move(meshed->mesh), request.edits, {model->tape, request.meshing.surface, cell_m}, context);
    if (!mesh.ok()) return mesh.error();
    if (mesh->triangleCount() == 0) return noSurface(*model, cell_m);
    return ObjectMesh{std::move(*mesh), model->lowered->provenance, std::move(lacks)};
}

Result<MadeScene> makeScene(const Model& model, const SceneRequest& request, Context& context) {
    MadeScene made;
    made.scene.ground = model.lowered->provenance;
    if (model.derivation.objects.empty()) return made;
    const Status done = context.timed("objects", [&]() -> Status {
        SceneBuilder builder(model.derivation, request, context);
        if (const Status s = builder.deriveAll(); !s.ok()) return s;
        made.reports = builder.figures().reports;
        const syntax::Diagnostics floating = builder.floating();
        if (const Status s = builder.makeAll(made); !s.ok()) return s;
        if (const Status s = builder.placeAll(made.scene); !s.ok()) return s;
        made.warnings = builder.warnings();
        for (const syntax::Diagnostic& d : floating.all()) made.warnings.warning(d.span, d.message, d.hint);
        mesh::shareMaterials(made.scene);
        return Done{};
    });
    if (!done.ok()) return done.error();
    return made;
}

Result<syntax::Diagnostics> tryObjects(const derive::Derivation& derivation, const derive::Budget& budget,
                                       Context& context) {
    if (derivation.objects.empty()) return syntax::Diagnostics();
    SceneRequest request;
    request.budget = budget;
    SceneBuilder builder(derivation, request, context);
    if (const Status s = builder.deriveAll(); !s.ok()) return s.error();
    syntax::Diagnostics floating = builder.floating();
    if (const Status s = builder.tryAll(); !s.ok()) return s.error();
    return floating;
}

Result<std::vector<MeshWarning>> objectWarnings(const Model& model, const SceneRequest& request, Context& context) {
    SceneBuilder builder(model.derivation, request, context);
    if (const Status s = builder.deriveAll(); !s.ok()) return s.error();
    const syntax::Diagnostics floating = builder.floating();
    auto warnings = builder.lookAtFirst();
    if (!warnings.ok()) return warnings;
    for (const syntax::Diagnostic& d : floating.all()) warnings->push_back({d.span, {}, d.message});
    return warnings;
}

}  // namespace sgm::pipeline
