#include "viewer/window/workbench.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/lift.h"
#include "modeler/core/conventions.h"

namespace sgm::window {

constexpr int fogVoxels = 96, previewCells = 64;  // along the longest side

Workbench::Workbench(Report& report, std::unique_ptr<SharedContext> shared, std::function<void()> notify)
    : report(report), session(notify), uploader(std::move(shared), notify), notify_(std::move(notify)) {}

Status Workbench::open(const std::filesystem::path& path) {
    Result<document::Document> opened = document::Document::open(path);
    if (!opened) return opened.error();
    document = std::move(*opened);
    selected_ = derive::none;
    endSteps();
    framed_ = false;
    asked_ = ~uint64_t(0);
    refresh();
    return Done{};
}

void Workbench::edit(const document::edits::Edit& edit, const std::string& label) {
    if (!edit) return say(edit.error().message, true);
    if (const Status s = document.apply(*edit, label); !s) return say(s.error().message, true);
    say(label);
}

void Workbench::undo() {
    if (!document.canUndo()) return;
    say(fmt::format("Undone: {}", document.undoLabel()));
    document.undo();
    resolveSelection();
}

void Workbench::redo() {
    if (!document.canRedo()) return;
    say(fmt::format("Done again: {}", document.redoLabel()));
    document.redo();
    resolveSelection();
}

void Workbench::save(bool overwrite) {
    const Status s = document.save(overwrite);
    s ? say(fmt::format("Saved {}", document.path().string())) : say(s.error().message, true);
}

void Workbench::refresh() {
    recovery_.keep(document);
    followSteps();
    field.showFog(look.pane == Pane::Fog);
    if (look.pane == Pane::Fog && session.model() && askedFog_ != session.model()) {
        uploader.deferDelete(std::exchange(askedFog_, session.model()));
        uploader.prepareFog(askedFog_, fogVoxels);
        settled_ = false;
    }
    // While the user drags, the GPU's own mesh does.
    const int resolution = wantsMesh() && !document.dragging() ? look.meshResolution : 0;
    const bool dragging = document.dragging() && !stepper;  // steps belong to a text and its spans
    const auto section = look.section && resolution > 0 ? std::optional(look.plane()) : std::nullopt;
    if (asked_ == document.revision() && askedResolution_ == resolution && askedDragging_ == dragging &&
        askedByHand_ == byHand_.get() && askedSection_ == section)
        return;
    document::ShowRequest request = requestOf(document);
    request.dragging = dragging;
    request.meshResolution = resolution;
    request.section = section;
    request.byHand = byHand_;
    asked_ = document.revision();
    askedResolution_ = resolution;
    askedDragging_ = dragging;
    askedByHand_ = byHand_.get();
    askedSection_ = section;
    session.show(std::move(request));
    settled_ = false;
}

bool Workbench::poll() {
    const bool settled = !working();
    const auto model = session.model();
    const auto meshed = session.mesh();
    bool news = session.poll();
    if (session.model() != model && session.model()) {
        resolveSelection();
        hover.reset();
        // What a slider let go of looks the same, but was made ready in haste.
        if (!framed_ || !prepared_ || prepared_->held || !looksLike(*prepared_, *session.model())) {
            uploader.deferDelete(std::exchange(prepared_, session.model()));
            uploader.prepare(prepared_, !framed_);
        }
        if (wantsMesh() && document.dragging()) uploader.preview(session.model(), previewCells);
    }
    if (session.mesh() != meshed && session.mesh()) uploader.prepare(session.mesh());
    SceneUploader::Update ready = uploader.poll();
    if (ready.field.scene) {
        fieldTimes = ready.field.times;
        compiles += fieldTimes.compile > 0;
        uploader.deferDelete(field.setField(std::move(ready.field.scene)));
        if (!framed_ && ready.field.camera) {
            orbit = Orbit::from(*ready.field.camera);
            framed_ = true;
        }
        news = true;
    }
    if (ready.inside) {
        orbit = Orbit::from(*ready.inside);
        news = true;
    }
    if (ready.fog.scene) {
        field.setFog(std::move(ready.fog.scene));
        news = true;
    }
    if (ready.mesh.scene) {
        if (const Status s = mesh.setMesh(std::move(ready.mesh.scene)); !s) say(s.error().message, true);
        previewed = ready.meshIsPreview;
        news = true;
    }
    if (!ready.problem.empty()) say(ready.problem, true);
    if (const std::optional<Status> written = exporting.take()) {
        *written ? say("Wrote " + exporting.file().string()) : say(written->error().message, true);
        news = true;
    }
    settled_ = settled && !working();
    return news;
}

bool Workbench::drawn() const {
    return (look.pane == Pane::Mesh || field.finished()) && (!wantsMesh() || mesh.finished());
}

void Workbench::cancel() {
    session.cancel();
    uploader.cancel();
    uploader.deferDelete(std::exchange(prepared_, nullptr));
    say("Cancelled: what is shown was made before");
}

void Workbench::exportTo(document::ExportRequest request) {
    request.inputs = session.usedFiles();
    if (!document.path().empty()) request.inputs.push_back(document.path());
    if (const Status s = exporting.start(session.model(), std::move(request), notify_); !s)
        say(s.error().message, true);
}

void Workbench::select(derive::ShapeId shape, bool quiet) {
    selected_ = shape;
    document.select(shape == derive::none ? "" : tree()->path(shape, true));
    if (shape == derive::none || quiet) return;
    const syntax::SourceSpan span = tree()->shapes[shape].span;
    if (span.source && span.source == shown()->grammar->sources.front().get()) {
        reveal = {span.begin, span.end};
        revealRule = span.begin;
    }
}

void Workbench::revealPlace(const document::Problem& problem) {
    const syntax::Source& source = *document.ast()->source;
    if (problem.file != source.name() || !problem.line)
        return say(fmt::format("{}:{}: {}", problem.file, problem.line, problem.message), true);
    const std::string_view line = source.line(problem.line);
    const auto start = static_cast<uint32_t>(line.data() - source.text().data());
    const uint32_t begin = start + std::min<uint32_t>(problem.column - 1, static_cast<uint32_t>(line.size()));
    const uint32_t end =
        problem.endLine == problem.line ? start + problem.endColumn - 1 : start + static_cast<uint32_t>(line.size());
    reveal = {begin, std::max(begin, end)};
}

void Workbench::resolveSelection() {
    selected_ = tree() ? document::selected(*tree(), document.choice().selection) : derive::none;
}

void Workbench::selectText(uint32_t offset) {
    if (!shown() || !isCurrent(document, *shown())) return;
    const std::vector<derive::ShapeId> made = document::shapesAt(shown()->model.derivation, offset);
    if (made.empty()) return;
    const auto present = std::find(made.begin(), made.end(), selected_);
    select(present == made.end() || present + 1 == made.end() ? made.front() : present[1], true);
    if (made.size() > 1)
        say(fmt::format("One of {} shapes that this text made; click again for the next", made.size()));
}

std::optional<Hover> Workbench::hoverOf(const Pick& pick) const {
    if (pick.kind != render::HitKind::Object || !shown()) return std::nullopt;
    const auto picked = document::pick(*shown(), pick.origin);
    if (!picked) return std::nullopt;
    Hover hover{pick.position, picked->shape,
                fmt::format("{}  ·  {}", picked->symbol, picked->rule.empty() ? "start" : "rule " + picked->rule)};
    if (picked->element.source)
        hover.text +=
            fmt::format("  ·  {}:{}", std::filesystem::path(picked->element.source->name()).filename().string(),
                        picked->element.source->place(picked->element.begin).line);
    return hover;
}

void Workbench::attach(derive::ShapeId moved, derive::ShapeId host, uint32_t joint) {
    edit(document::attach(document, *shown(), moved, host, joint),
         fmt::format("Join at {}", tree()->joint(host, joint).name));
}

void Workbench::beginSteps(const std::string& way) {
    if (!shown()) return;
    derive::Options options = shown()->options;
    options.derive = way;
    Result<document::Stepper> begun = document::Stepper::begin(shown()->grammar, options);
    if (!begun) return say(begun.error().message, true);
    stepper.emplace(std::move(*begun));
    steppedAt_ = document.revision();
    stepped(Done{}, "Pick a live shape, then a rule");
}

void Workbench::stepped(const Status& done, const std::string& what) {
    if (!done) return say(done.error().message, true);
    Result<std::shared_ptr<const derive::Derivation>> derivation = stepper->derivation();
    if (!derivation) return say(derivation.error().message, true);
    byHand_ = *derivation;
    say(what);
}

void Workbench::endSteps() {
    stepper.reset();
    byHand_ = nullptr;
}

void Workbench::followSteps() {
    if (!stepper || steppedAt_ == document.revision()) return;
    byHand_ = nullptr;  // the automatic model of the new text comes first, and brings its grammar
    if (!shown() || shown()->revision != document.revision() || shown()->byHand) return;
    const Result<size_t> kept = stepper->follow(shown()->grammar, shown()->options);
    steppedAt_ = document.revision();
    kept ? stepped(Done{}, fmt::format("{} steps hold in the new text", *kept)) : say(kept.error().message, true);
}

Box3d Workbench::bounds() const {
    if (!shown()) return {{-1, -1, -1}, {1, 1, 1}};
    return field.hasField() ? field.bounds().as<double>() : shown()->model.lowered->field.bounds.as<double>();
}

Box3d Workbench::boundsOf(derive::ShapeId shape) const {
    Box3d box;
    const derive::ShapeTree& shapes = *tree();
    for (derive::ShapeId id = shape; id != derive::none; id = shapes.next(id, shape)) {
        const derive::Scope scope = derive::liftedScope(shown()->model.derivation, id);
        for (int corner = 0; corner < 8; ++corner)
            box = hull(box, scope.point({corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0}));
    }
    return box;
}

void Workbench::frameAll() {
    orbit.lamp_m = 0;
    orbit.fieldOfView = render::Camera{}.fieldOfView;
    orbit.frame(bounds());
}

void Workbench::frameSelection() {
    if (selected_ == derive::none) return frameAll();
    orbit.frame(boundsOf(selected_));
}

render::MeshStyle Workbench::meshStyle() const {
    render::MeshStyle style = look.mesh;
    if (look.section) {
        // A little beyond the plane, so that the cut of a mesh that ends there is seen; one that doesn't yet is cut
        // here.
        const Box3f box = session.model() ? session.model()->model.lowered->field.bounds : bounds().as<float>();
        const pipeline::Section plane = look.plane();
        style.section = render::Section{plane.normal().as<float>(),
                                        static_cast<float>(plane.offset_m(box)) + 1e-4f * length(box.size())};
    }
    return style;
}

void Workbench::stepInside() {
    if (!shown()) return;
    uploader.lookInside(session.model());
    settled_ = false;
}

std::optional<double> Workbench::groundBelow(Vec3d from) const {
    if (!shown()) return std::nullopt;
    return render::surfaceBelow(shown()->model.tape, from, static_cast<double>(bounds().lo.y));
}

void Workbench::startTurntable(int count) { turntable = Turntable{0, count, orbit.yaw}; }

Result<bool> Workbench::takePictures() {
    const bool whole = look.pane == Pane::Mesh ? mesh.visible() && mesh.finished() : field.finished();
    if (!whole || (!pictureWanted && !turntable)) return false;
    const std::filesystem::path stem =
        document.path().empty() ? "untitled" : std::filesystem::path(document.path()).replace_extension();
    std::string name;
    if (turntable) {
        name = fmt::format("{}-turn-{:03}.png", stem.string(), turntable->next);
    } else {
        for (int n = 1; name.empty() || std::filesystem::exists(name); ++n)
            name = fmt::format("{}-{}.png", stem.string(), n);
    }
    if (const Status s = writePng(look.pane == Pane::Mesh ? mesh.image() : field.image(), name); !s) return s.error();
    say("Wrote " + name);
    if (!turntable) {
        pictureWanted = false;
        return true;
    }
    const int next = ++turntable->next;
    orbit.yaw = turntable->yaw + 2 * pi * next / turntable->count;
    if (next == turntable->count) turntable.reset();
    return true;
}

void Workbench::say(std::string text, bool problem) {
    notice = std::move(text);
    noticeIsProblem = problem;
}

}  // namespace sgm::window
