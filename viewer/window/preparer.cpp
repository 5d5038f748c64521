#include "viewer/window/preparer.h"

#include <utility>

#include "modeler/core/stopwatch.h"

namespace sgm::viewer {
namespace {

Result<ReadyField> readied(std::shared_ptr<const Shown> model, Progress& progress) {
    const Stopwatch watch;
    const lower::Model& lowered = *model->model.lowered;
    const eval::Tape& tape = model->model.tape;
    Result<PreparedField> field = prepareField(tape, tighten(tape, lowered.field.bounds), lowered.provenance, 0, &progress);
    if (!field) return field.error();
    return ReadyField{std::move(model), std::make_shared<const PreparedField>(std::move(*field)), watch.seconds()};
}

Result<ReadyMesh> readied(std::shared_ptr<const Meshed> meshed) {
    Result<PreparedMesh> mesh = prepareMesh(*meshed->mesh, meshed->of->model.lowered->provenance);
    if (!mesh) return mesh.error();
    return ReadyMesh{std::move(meshed), std::make_shared<const PreparedMesh>(std::move(*mesh))};
}

}  // namespace

Preparer::Preparer(std::function<void()> wake) : wake_(std::move(wake)), worker_([this] { work(); }) {}

Preparer::~Preparer() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        progress_.cancel();
    }
    wanted_.notify_one();
    worker_.join();
}

void Preparer::prepare(std::shared_ptr<const Shown> model) {
    const std::lock_guard lock(mutex_);
    model_ = std::move(model);
    wanted_.notify_one();
}
void Preparer::prepare(std::shared_ptr<const Meshed> mesh) {
    const std::lock_guard lock(mutex_);
    mesh_ = std::move(mesh);
    wanted_.notify_one();
}

Preparer::Ready Preparer::poll() {
    const std::lock_guard lock(mutex_);
    return std::exchange(ready_, {});
}
bool Preparer::busy() const {
    const std::lock_guard lock(mutex_);
    return running_ || model_ || mesh_;
}

void Preparer::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        wanted_.wait(lock, [&] { return quit_ || model_ || mesh_; });
        if (quit_) return;
        auto model = std::exchange(model_, nullptr);
        auto mesh = model ? nullptr : std::exchange(mesh_, nullptr);
        running_ = true;
        lock.unlock();
        Result<ReadyField> field = model ? readied(std::move(model), progress_) : Result(ReadyField{});
        Result<ReadyMesh> meshed = mesh ? readied(std::move(mesh)) : Result(ReadyMesh{});
        lock.lock();
        running_ = false;
        if (!field) ready_.problem = field.error().message;
        else if (field->field) ready_.field = std::move(*field);
        if (!meshed) ready_.problem = meshed.error().message;
        else if (meshed->mesh) ready_.mesh = std::move(*meshed);
        wake_();
    }
}

}  // namespace sgm::viewer
