#include "viewer/window/workbench.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/lift.h"
#include "modeler/core/conventions.h"

namespace sgm::window {

constexpr int fogVoxels = 96, previewCells = 64;  // along the longest side

Workbench::Workbench(Report& report, std::unique_ptr<SharedContext> shared, std::function<void()> notify)
    : report(report), session(notify), uploader(std::move(shared), notify), steps(notify), notify_(std::move(notify)) {}

Status Workbench::open(const std::filesystem::path& path, bool mayBegin) {
    std::error_code failed;
    const bool isNew = mayBegin && !std::filesystem::exists(path, failed);
    Result<document::Document> opened = document::Document::open(path, mayBegin);
    if (!opened) return opened.error();
    show(std::move(*opened));
    endSteps();
    refresh();
    panels.fileIsNew = isNew;
    if (isNew) say(fmt::format("{} is new: Ctrl+S writes the file", path.filename().string()));
    return Done{};
}

void Workbench::show(document::Document other) {
    document = std::move(other);
    panels.naming.reset();  // it was about the document before
    panels.fileIsNew = false;
    selection = {};
    view.framed = false;
    view.mesh.clear();
    view.field.setFog(nullptr);
    session.forgetMesh();
    uploader.forget();
    uploader.deferDelete(std::exchange(asked_.fog, nullptr));
    asked_.otherModel = true;
    asked_.revision = ~uint64_t(0);
}

void Workbench::edit(const document::edits::Edit& edit, const std::string& label) {
    if (!edit) return say(edit.error().message, true);
    if (const Status s = document.apply(*edit, label); !s) return say(s.error().message, true);
    panels.revealRow |= edit->node.has_value();
    say(label);
}

void Workbench::undo() {
    if (!document.history().canUndo()) return;
    say(fmt::format("Undone: {}", document.history().undoLabel()));
    document.undo();
    resolveSelection();
}

void Workbench::redo() {
    if (!document.history().canRedo()) return;
    say(fmt::format("Done again: {}", document.history().redoLabel()));
    document.redo();
    resolveSelection();
}

void Workbench::save(bool overwrite) {
    if (document.path().empty()) {
        panels.naming = Naming{};
        return;
    }
    const Status s = document.save(overwrite);
    s ? say(fmt::format("Saved {}", document.path().string())) : say(s.error().message, true);
}

void Workbench::refresh() {
    recovery_.keep(document);
    followSteps();
    view.field.showFog(view.look.pane == Pane::Fog);
    if (view.look.pane == Pane::Fog && session.model() && !asked_.otherModel && asked_.fog != session.model()) {
        uploader.deferDelete(std::exchange(asked_.fog, session.model()));
        uploader.prepareFog(asked_.fog, fogVoxels);
        asked_.settled = false;
    }
    // While the user drags, the GPU's own mesh does.
    const int resolution = view.wantsMesh() && !document.dragging() ? view.look.meshResolution : 0;
    const bool dragging = document.dragging() && !steps.view();  // steps belong to a text and its spans
    const auto section = view.look.section && resolution > 0 ? std::optional(view.look.plane()) : std::nullopt;
    if (asked_.revision == document.revision() && asked_.resolution == resolution && asked_.dragging == dragging &&
        asked_.byHand == byHand_.derivation.get() && asked_.section == section)
        return;
    document::ShowRequest request = requestOf(document);
    request.dragging = dragging;
    request.meshResolution = resolution;
    request.section = section;
    request.byHand = byHand_.derivation;
    asked_.revision = document.revision();
    asked_.resolution = resolution;
    asked_.dragging = dragging;
    asked_.byHand = byHand_.derivation.get();
    asked_.section = section;
    session.show(std::move(request));
    asked_.settled = false;
}

bool Workbench::poll() {
    const bool settled = !working();
    const auto model = session.model();
    const auto meshed = session.mesh();
    bool news = session.poll();
    if (session.model() != model && session.model()) {
        asked_.otherModel = false;
        resolveSelection();
        view.hover.reset();
        // What a slider let go of looks the same, but was made ready in haste.
        if (!view.framed || !asked_.prepared || asked_.prepared->held ||
            !looksLike(*asked_.prepared, *session.model())) {
            uploader.deferDelete(std::exchange(asked_.prepared, session.model()));
            uploader.prepare(asked_.prepared, !view.framed);
        }
        if (view.wantsMesh() && document.dragging()) uploader.preview(session.model(), previewCells);
    }
    if (session.mesh() != meshed && session.mesh()) uploader.prepare(session.mesh());
    SceneUploader::Update ready = uploader.poll();
    if (ready.field.scene) {
        status.fieldTimes = ready.field.times;
        status.compiles += status.fieldTimes.compile > 0;
        uploader.deferDelete(view.field.setField(std::move(ready.field.scene)));
        if (!view.framed && ready.field.camera) {
            view.orbit = Orbit::from(*ready.field.camera);
            view.framed = true;
        }
        news = true;
    }
    if (ready.inside) {
        view.orbit = Orbit::from(*ready.inside);
        news = true;
    }
    if (ready.fog.scene) {
        view.field.setFog(std::move(ready.fog.scene));
        news = true;
    }
    if (ready.mesh.scene) {
        if (const Status s = view.mesh.setMesh(std::move(ready.mesh.scene)); !s) say(s.error().message, true);
        status.previewed = ready.meshIsPreview;
        news = true;
    }
    if (!ready.problem.empty()) say(ready.problem, true);
    if (const std::optional<Status> written = exporting.take()) {
        *written ? say("Wrote " + exporting.file().string()) : say(written->error().message, true);
        news = true;
    }
    if (const auto outcome = steps.takeOutcome()) {
        stepped(*outcome);
        news = true;
    }
    asked_.settled = settled && !working();
    return news;
}

void Workbench::cancel() {
    session.cancel();
    uploader.cancel();
    steps.cancel();
    uploader.deferDelete(std::exchange(asked_.prepared, nullptr));
    say("Cancelled: what is shown was made before");
}

void Workbench::exportTo(document::ExportRequest request) {
    if (shown() && (asked_.otherModel || session.revisions().modelled != document.revision()))
        return say(session.busy() ? "The model isn't ready yet: export again in a moment"
                                  : "What is shown is older than the text: nothing is written (see Problems)",
                   true);
    request.inputs = session.usedFiles();
    if (!document.path().empty()) request.inputs.push_back(document.path());
    if (const Status s = exporting.start(session.model(), std::move(request), notify_); !s)
        say(s.error().message, true);
}

/// Shows what is selected in the text.
static void reveal(Workbench& bench) {
    const auto& node = bench.document.choice().node;
    if (!node) return;
    bench.panels.reveal = {node->range.begin, node->range.end};
    bench.panels.revealRow = true;
}

void Workbench::select(derive::ShapeId shape, bool quiet) {
    view.face.reset();
    if (!shown()) return;
    selection.selectShape(document, *shown(), shape);
    if (!quiet) reveal(*this);
    if (const std::string notice = selection.takeNotice(); !notice.empty()) say(notice);
}

void Workbench::selectLive(derive::ShapeId shape) {
    const derive::ShapeTree& tree = steps.view()->tree;
    const syntax::SourceSpan span = tree.shapes[shape].span;
    document.select(tree.path(shape, true));
    document.selectNode(std::nullopt);
    if (shown() && span.source == shown()->grammar->sources.front().get()) {
        const auto rows = document::ruleRows(*document.ast());
        const size_t row = rowOf(rows, document::TextRange{span.begin, span.end});
        if (row < rows.size())
            document.selectNode(document::SelectedNode{{rows[row].span.begin, rows[row].span.end}, rows[row].kind});
    }
    resolveSelection();
    reveal(*this);
}

void Workbench::resolveSelection() {
    view.face.reset();
    selection.resolve(document, shown(), !steps.view());
    if (const std::string notice = selection.takeNotice(); !notice.empty()) say(notice);
}

void Workbench::beginSteps(const std::string& way) {
    if (!shown()) return;
    derive::Options options = shown()->options;
    options.derive = way;
    byHand_.steppedAt = shown()->revision;
    steps.begin(shown()->grammar, options);
}

void Workbench::stepped(const document::StepJob::Outcome& outcome) {
    if (!steps.view()) byHand_.derivation = nullptr;
    if (!outcome.done) return say(outcome.done.error().message, true);
    if (outcome.edit && outcome.ast != document.ast())
        return say("The text has changed while the way was tried: nothing was saved", true);
    if (outcome.edit) return edit(*outcome.edit, outcome.what);
    byHand_.derivation = steps.view()->derivation;
    say(outcome.what);
}

void Workbench::endSteps() {
    steps.end();
    byHand_.derivation = nullptr;
}

void Workbench::followSteps() {
    if (!steps.view() || steps.running() || byHand_.steppedAt == document.revision()) return;
    byHand_.derivation = nullptr;  // the automatic model of the new text comes first, and brings its grammar
    if (!shown() || shown()->revision != document.revision() || shown()->byHand) return;
    byHand_.steppedAt = document.revision();
    steps.follow(shown()->grammar, shown()->options);
}

void Workbench::stepInside() {
    if (!shown()) return;
    uploader.lookInside(session.model());
    asked_.settled = false;
}

void Workbench::say(std::string text, bool problem) {
    panels.notice = std::move(text);
    panels.noticeIsProblem = problem;
}

}  // namespace sgm::window
