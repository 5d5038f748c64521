// The session's mesh: of the whole model, block by block again, or of the model cut open.
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/missing.h"
#include "grammar/pipeline/refining.h"
#include "viewer/document/session.h"

namespace sgm::document {
namespace {

constexpr float keptCells =
    1.25f;  ///< the lattice of a mesh is kept while its cells are within this factor of what is wished

/// A mesh with halved cells around thin parts, null where it stays as it is, and the parts that it lacks.
struct FinerMesh {
    std::shared_ptr<const BuiltMesh> mesh;
    std::vector<lower::ThinPart> missing;
};
Result<FinerMesh> withThinParts(const BuiltMesh& coarse, pipeline::Context& context) {
    mesh::Mesh mesh = *coarse.mesh;
    mesh::Counts counts;
    auto missing = pipeline::holdThinParts(coarse.of->model, mesh, coarse.grid, {.halvesAll = false}, context, counts);
    if (!missing.ok()) return missing.error();
    if (mesh.triangleCount() == coarse.mesh->triangleCount()) return FinerMesh{nullptr, std::move(*missing)};
    auto finer = std::make_shared<BuiltMesh>(coarse);
    finer->mesh = std::make_shared<const mesh::Mesh>(std::move(mesh));
    finer->stages.insert(finer->stages.end(), context.stages.begin(), context.stages.end());
    return FinerMesh{std::move(finer), std::move(*missing)};
}

}  // namespace

void Session::forgetMesh() {
    {
        const std::lock_guard lock(queue_.mutex);
        queue_.deferred.push_back(std::exchange(mesh_, nullptr));
        queue_.deferred.push_back(std::exchange(queue_.update.mesh, nullptr));
        queue_.forgetsMesh = true;
        if (queue_.running && queue_.meshing) queue_.running->cancel();
    }
    queue_.wanted.notify_one();
}

void Session::Last::forgetMesh() {
    rebuild = mesh::Rebuild(mesh::PolygonizeOptions{.surface = mesh::Surface::Crisp});
    meshed.reset();
    missing.reset();
    isMeshFinished = false;
    problems.mesh.clear();
}

void Session::meshIt(const ShowRequest& request, Progress& progress) {
    {
        const std::lock_guard lock(queue_.mutex);
        if (queue_.pending || queue_.quit) return;
        queue_.meshing = true;
    }
    if (last_.meshed && last_.meshed->of == last_.shown && last_.meshResolution == request.meshResolution &&
        last_.meshed->section == request.section) {
        if (!request.dragging || last_.isMeshFinished) finishMesh(progress);
        return;
    }
    if (request.section) return meshCutOpen(request, progress);
    const Box3f& bounds = last_.shown->model.lowered->field.bounds;
    const float wished_m = mesh::cellFor(bounds, request.meshResolution),
                before_m = last_.meshed ? last_.meshed->grid.cell_m : 0;
    const bool keep = last_.meshResolution == request.meshResolution && before_m < wished_m * keptCells &&
                      before_m * keptCells > wished_m;
    auto meshed = std::make_shared<BuiltMesh>();
    meshed->of = last_.shown;
    meshed->grid =
        pipeline::gridToKeep(last_.meshed ? last_.meshed->grid : mesh::Grid{}, bounds, keep ? before_m : wished_m,
                             last_.shown->model.derivation, mesh::Surface::Crisp);
    const auto mesh = last_.rebuild.update(last_.shown->model.tape, meshed->grid, &progress, meshed->counts);
    if (!mesh.ok()) {
        if (mesh.error().kind == Error::Kind::Cancelled) return;
        Update update;
        update.problems = last_.problems.check;
        update.problems->push_back(problemOf(mesh.error()));
        publish(std::move(update));
        return;
    }
    meshed->mesh = std::make_shared<const mesh::Mesh>(**mesh);
    meshed->blocksMade = last_.rebuild.blocksMade();
    meshed->blocksKept = last_.rebuild.blocksKept();
    meshed->stages = {{"subdivide", meshed->counts.subdivideSeconds},
                      {"sample", meshed->counts.sampleSeconds},
                      {"polygonize", meshed->counts.polygonizeSeconds}};
    last_.meshed = meshed;
    last_.meshResolution = request.meshResolution;
    last_.missing.reset();
    last_.isMeshFinished = false;
    Update update;
    update.mesh = meshed;
    publish(std::move(update));
    last_.problems.mesh.clear();
    if (!request.dragging && !queue_.isSuperseded()) finishMesh(progress);
}

/// Halves cells around thin parts and publishes, behind what is known of the model, what floats or is missing all the
/// same. Where it is cancelled, the next request goes on from what is done.
void Session::finishMesh(Progress& progress) {
    if (!last_.isMeshFinished) {
        pipeline::Context context{&progress};
        if (!last_.missing) {
            auto finer = withThinParts(*last_.meshed, context);
            if (!finer.ok()) return;
            last_.missing = std::move(finer->missing);
            if (finer->mesh) {
                last_.meshed = finer->mesh;
                Update update;
                update.mesh = finer->mesh;
                publish(std::move(update));
            }
        }
        const auto warnings = pipeline::meshWarnings(last_.shown->model, *last_.meshed->mesh, last_.meshed->grid,
                                                     *last_.missing, context);
        if (!warnings.ok()) return;
        syntax::Diagnostics found;
        for (const pipeline::MeshWarning& w : *warnings) found.warning(w.span, w.text);
        last_.problems.mesh = problemsOf(found);
        last_.isMeshFinished = true;
    }
    if (last_.problems.mesh.empty()) return;
    Update update;
    update.problems = last_.problems.model;
    update.problems->insert(update.problems->end(), last_.problems.mesh.begin(), last_.problems.mesh.end());
    publish(std::move(update));
}

/// The mesh of what a section leaves: as `sgm build --section` makes it, whole each time.
void Session::meshCutOpen(const ShowRequest& request, Progress& progress) {
    pipeline::Context context{&progress};
    const auto model =
        pipeline::makeModel(derive::Derivation(last_.shown->model.derivation), *request.section, context);
    if (!model.ok()) return;  // cancelled, or nothing is left: what was shown stays
    auto meshed = pipeline::makeMesh(*model, pipeline::gridOf(*model, request.meshResolution),
                                     {.surface = mesh::Surface::Crisp}, context);
    if (!meshed.ok()) return;
    auto cut = std::make_shared<BuiltMesh>();
    cut->of = last_.shown;
    cut->grid = meshed->grid;
    cut->mesh = std::make_shared<const mesh::Mesh>(std::move(meshed->mesh));
    cut->counts = meshed->counts;
    cut->stages = std::move(context.stages);
    cut->section = request.section;
    last_.meshed = cut;
    last_.meshResolution = request.meshResolution;
    last_.isMeshFinished = true;
    Update update;
    update.mesh = std::move(cut);
    publish(std::move(update));
}

}  // namespace sgm::document
