#include "viewer/window/scene_uploader.h"

#include <utility>

#include "grammar/pipeline/mesh_edits.h"
#include "modeler/core/guarded.h"
#include "modeler/core/stopwatch.h"

namespace sgm::window {
namespace {

/// Depth of the cells: few while a slider is dragged, for the user waits for them, and no picture of it is drawn whole.
int levelsFor(const document::BuiltModel& model) {
    constexpr size_t longTape = 4096;  // that two levels leave too long for rays
    return !model.held ? cellDepth(render::TracedBy::Best) : model.model.tape.size() > longTape ? 3 : 2;
}

}  // namespace

SceneUploader::SceneUploader(std::unique_ptr<SharedContext> context, std::function<void()> notify)
    : context_(std::move(context)), notify_(std::move(notify)), worker_([this] { work(); }) {}

SceneUploader::~SceneUploader() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        if (running_) running_->cancel();
    }
    changed_.notify_one();
    worker_.join();
}

void SceneUploader::ask(const std::function<void(Wanted&)>& how) {
    {
        const std::lock_guard lock(mutex_);
        how(wanted_);
    }
    changed_.notify_one();
}
void SceneUploader::prepare(std::shared_ptr<const document::BuiltModel> model, bool withCamera) {
    ask([&](Wanted& wanted) {
        wanted.deferred.push_back(std::exchange(wanted.model, std::move(model)));
        wanted.withCamera = withCamera;
    });
}
void SceneUploader::lookInside(std::shared_ptr<const document::BuiltModel> model) {
    ask([&](Wanted& wanted) { wanted.inside = std::move(model); });
}
void SceneUploader::prepareFog(std::shared_ptr<const document::BuiltModel> model, int resolution) {
    ask([&](Wanted& wanted) {
        wanted.fog = std::move(model);
        wanted.fogResolution = resolution;
    });
}
void SceneUploader::preview(std::shared_ptr<const document::BuiltModel> model, int resolution) {
    ask([&](Wanted& wanted) {
        wanted.preview = std::move(model);
        wanted.previewResolution = resolution;
    });
}
void SceneUploader::prepare(std::shared_ptr<const document::BuiltMesh> mesh) {
    ask([&](Wanted& wanted) {
        wanted.mesh = std::move(mesh);
        wanted.preview = nullptr;  // of a model before: made after the mesh it would stay in its place
    });
}

void SceneUploader::deferDelete(std::shared_ptr<const void> deferred) {
    if (deferred) ask([&](Wanted& wanted) { wanted.deferred.push_back(std::move(deferred)); });
}

void SceneUploader::cancel() {
    const std::lock_guard lock(mutex_);
    wanted_.model = wanted_.fog = wanted_.inside = wanted_.preview = nullptr;
    wanted_.mesh = nullptr;
    if (running_) running_->cancel();
}

void SceneUploader::forget() {
    cancel();
    const Update forgotten = poll();
}

SceneUploader::Update SceneUploader::poll() {
    const std::lock_guard lock(mutex_);
    return std::exchange(update_, {});
}
bool SceneUploader::busy() const {
    const std::lock_guard lock(mutex_);
    return running_ || wanted_.any();
}
bool SceneUploader::makesField() const {
    const std::lock_guard lock(mutex_);
    return makingField_ || wanted_.model;
}
std::string_view SceneUploader::stage() const {
    const std::lock_guard lock(mutex_);
    return running_ ? running_->stage() : "";
}
double SceneUploader::fraction() const {
    const std::lock_guard lock(mutex_);
    return running_ ? running_->fraction() : 0;
}

template <class Scene>
void SceneUploader::give(UploadResult<Scene> Update::*where, UploadResult<Scene> ready) {
    render::finish();  // so that the window's context finds all of it
    const std::lock_guard lock(mutex_);
    if (running_->cancelled()) return;
    std::swap(update_.*where, ready);  // what was never taken dies with `ready`, when nobody waits for the lock
    if constexpr (std::is_same_v<Scene, render::MeshScene>) update_.meshIsPreview = false;
}

Status SceneUploader::makeField(std::shared_ptr<const document::BuiltModel> model, bool withCamera,
                                Progress& progress) {
    UploadResult<render::FieldScene> ready;
    Stopwatch watch;
    const lower::Model& lowered = *model->model.lowered;
    const eval::Tape& tape = model->model.tape;
    Result<render::PreparedField> field = render::prepareField(tape, render::tighten(tape, lowered.field.bounds),
                                                               lowered.provenance, 0, &progress, levelsFor(*model));
    if (!field) return field.error();
    ready.times.prepare = watch.seconds();
    if (withCamera) ready.camera = render::frame(tape, field->bounds, 1);
    watch = {};
    auto programs = programsFor(*field, fieldPrograms_);
    if (!programs) return programs.error();
    const double made = watch.seconds();
    watch = {};
    ready.scene = std::make_unique<render::FieldScene>(std::move(*field), *programs, 0);
    render::finish();
    ready.times.upload = watch.seconds();
    if (*programs != fieldPrograms_) {
        watch = {};
        if (Status s = ready.scene->warmUp(); !s) return s;
        ready.times.compile = made + watch.seconds();
        fieldPrograms_ = *programs;
    }
    give(&Update::field, std::move(ready));
    return Done{};
}

Status SceneUploader::makeFog(std::shared_ptr<const document::BuiltModel> model, int resolution, Progress& progress) {
    UploadResult<render::FogScene> ready;
    Stopwatch watch;
    const eval::Tape& tape = model->model.tape;
    const Box3f bounds = render::tighten(tape, model->model.lowered->field.bounds);
    const Result<render::FogGrid> grid =
        render::fogGrid(tape, mesh::gridFor(bounds, mesh::cellFor(bounds, resolution)), bounds, 0, &progress);
    if (!grid) return grid.error();
    const Result<render::PreparedFog> fog = render::prepareFog(grid->dense, bounds, usualFog(*grid), 0, &progress);
    if (!fog) return fog.error();
    ready.times.prepare = watch.seconds();
    if (!fogPrograms_) {
        watch = {};
        auto programs = render::FogPrograms::create();
        if (!programs) return programs.error();
        fogPrograms_ = *programs;
        ready.times.compile = watch.seconds();
    }
    watch = {};
    ready.scene = std::make_unique<render::FogScene>(*fog, fogPrograms_);
    ready.times.upload = watch.seconds();
    give(&Update::fog, std::move(ready));
    return Done{};
}

Status SceneUploader::findInside(const document::BuiltModel& model) {
    const eval::Tape& tape = model.model.tape;
    const render::Camera found = render::inside(tape, render::tighten(tape, model.model.lowered->field.bounds));
    const std::lock_guard lock(mutex_);
    update_.inside = found;
    return Done{};
}

Status SceneUploader::ensureMeshPrograms(UploadTimes& times) {
    if (meshPrograms_) return Done{};
    const Stopwatch watch;
    auto programs = render::MeshPrograms::create();
    if (!programs) return programs.error();
    meshPrograms_ = *programs;
    times.compile += watch.seconds();
    return Done{};
}

Status SceneUploader::makeMesh(std::shared_ptr<const document::BuiltMesh> meshed, Progress& progress) {
    UploadResult<render::MeshScene> ready;
    Stopwatch watch;
    // As it would be exported.
    pipeline::Context context{&progress, 0};
    const Result<mesh::Mesh> simple = pipeline::edited(
        *meshed->mesh, {}, {meshed->of->model.tape, mesh::Surface::Crisp, meshed->grid.cell_m}, context);
    if (!simple) return simple.error();
    const Result<render::PreparedMesh> mesh = render::prepareMesh(*simple, meshed->of->model.lowered->provenance);
    if (!mesh) return mesh.error();
    ready.times.prepare = watch.seconds();
    if (Status s = ensureMeshPrograms(ready.times); !s) return s;
    watch = {};
    ready.scene = std::make_unique<render::MeshScene>(*mesh, meshPrograms_);
    ready.times.upload = watch.seconds();
    give(&Update::mesh, std::move(ready));
    return Done{};
}

Status SceneUploader::makePreview(std::shared_ptr<const document::BuiltModel> model, int resolution,
                                  Progress& progress) {
    UploadResult<render::MeshScene> ready;
    const lower::Model& lowered = *model->model.lowered;
    const Stopwatch watch;
    const Box3f bounds =
        render::tighten(model->model.tape, lowered.field.bounds);  // the ground lies where the field's does
    const Result<render::PreparedBlocks> blocks = render::prepareBlocks(
        model->model.tape, mesh::gridFor(bounds, mesh::cellFor(bounds, resolution)), 0, &progress);
    if (!blocks) return blocks.error();
    auto programs = programsFor(*blocks, blockPrograms_);
    if (!programs) return programs.error();
    blockPrograms_ = *programs;
    Result<render::GpuTriangles> triangles = polygonizeOnGpu(*blocks, *blockPrograms_, &progress);
    if (!triangles) return triangles.error();
    ready.times.prepare = watch.seconds();
    if (Status s = ensureMeshPrograms(ready.times); !s) return s;
    const std::vector<OriginId> owners = ownersOf(*blocks, *triangles, 0);
    ready.scene =
        std::make_unique<render::MeshScene>(std::move(*triangles), owners, bounds, lowered.provenance, meshPrograms_);
    give(&Update::mesh, std::move(ready));
    const std::lock_guard lock(mutex_);
    update_.meshIsPreview = true;
    return Done{};
}

void SceneUploader::work() {
    context_->take();
    std::unique_lock lock(mutex_);
    while (!quit_) {
        changed_.wait(lock, [&] { return quit_ || wanted_.any() || !wanted_.deferred.empty(); });
        if (quit_) break;
        auto deferred = std::exchange(wanted_.deferred, {});
        if (!deferred.empty()) {
            lock.unlock();
            deferred.clear();
            lock.lock();
            continue;
        }
        auto model = std::exchange(wanted_.model, nullptr);
        auto mesh = model ? nullptr : std::exchange(wanted_.mesh, nullptr);
        auto preview = model || mesh ? nullptr : std::exchange(wanted_.preview, nullptr);
        auto within = model || mesh || preview ? nullptr : std::exchange(wanted_.inside, nullptr);
        auto fog = model || mesh || preview || within ? nullptr : std::exchange(wanted_.fog, nullptr);
        const int fogResolution = wanted_.fogResolution, previewResolution = wanted_.previewResolution;
        const bool withCamera = wanted_.withCamera;
        makingField_ = model != nullptr;
        const auto progress = running_ = std::make_shared<Progress>();
        lock.unlock();
        const Status done = guarded([&]() -> Status {
            return model     ? makeField(std::move(model), withCamera, *progress)
                   : mesh    ? makeMesh(std::move(mesh), *progress)
                   : preview ? makePreview(std::move(preview), previewResolution, *progress)
                   : within  ? findInside(*within)
                             : makeFog(std::move(fog), fogResolution, *progress);
        });
        lock.lock();
        running_ = nullptr;
        makingField_ = false;
        if (!done && done.error().kind != Error::Kind::Cancelled) update_.problem = done.error().message;
        notify_();
    }
    lock.unlock();
    fieldPrograms_ = nullptr;
    fogPrograms_ = nullptr;
    meshPrograms_ = nullptr;
    blockPrograms_ = nullptr;
    update_ = {};
    wanted_ = {};
    context_->giveBack();
}

}  // namespace sgm::window
