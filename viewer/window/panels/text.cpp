#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <nlohmann/json.hpp>

#include "viewer/window/panels.h"
#include "viewer/window/selecting.h"
#include "viewer/window/style.h"

namespace sgm::window {
namespace {

/// Problems of the document's own file, as far as they are about its present text.
std::vector<LineNote> notesOf(const Workbench& bench) {
    std::vector<LineNote> notes;
    const std::string& name = bench.document.ast()->source->name();
    for (const document::Problem& p : bench.session.problems()) {
        if (p.file != name || p.line == 0) continue;
        const uint32_t end = p.endLine == p.line ? p.endColumn - 1 : ~uint32_t(0) >> 1;
        notes.push_back({p.line - 1, p.column - 1, end, p.message + (p.hint.empty() ? "" : "  (" + p.hint + ")"),
                         p.severity == syntax::Severity::Error ? tint::error : tint::warning});
    }
    return notes;
}

}  // namespace

void TextPanel::show(Workbench& bench) {
    if (colored_ != bench.document.ast()) {
        colored_ = bench.document.ast();
        colors_ = document::colours(*colored_);
    }
    if (bench.panels.reveal) {
        editor_.reveal(bench.panels.reveal->first, bench.panels.reveal->second);
        bench.panels.reveal.reset();
    }
    if (!ImGui::GetTopMostPopupModal() && (editor_.active() || !ImGui::GetIO().WantTextInput))
        search_.keys(bench.document.text(), editor_);
    const bool found = search_.show(bench.report, bench.document.text(), editor_);
    const std::optional<std::string> typed = editor_.show(bench.report, bench.document.text(), colors_, notesOf(bench));
    if (found) editor_.enter();
    bench.panels.typing = editor_.active();
    const auto [begin, end] = editor_.selection();
    if (bench.report.active()) {
        bench.report.state()["textSelection"] =
            bench.document.text().substr(std::min<size_t>(begin, bench.document.text().size()), end - begin);
        bench.report.state()["caret"] = editor_.caret();
        bench.report.state()["textScroll"] = editor_.scrolled();
    }
    if (typed)
        bench.document.type(*typed);
    else if (editor_.clicked())
        selectText(bench, editor_.caret());
}

}  // namespace sgm::window
