#include <fmt/format.h>
#include <imgui.h>

#include "viewer/window/panels.h"
#include "viewer/window/selecting.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {

void problemsPanel(Workbench& bench) {
    const std::vector<document::Problem>& problems = bench.session.problems();
    ImGui::BeginChild("rows");
    for (size_t i = 0; i < problems.size(); ++i) {
        const document::Problem& p = problems[i];
        ImGui::PushID(static_cast<int>(i));
        const bool isError = p.severity == syntax::Severity::Error;
        ImGui::PushStyleColor(ImGuiCol_Text, isError ? tint::error : tint::warning);
        ImGui::TextUnformatted(isError ? "error" : "warning");
        ImGui::PopStyleColor();
        ImGui::SameLine();
        const bool isOwn = p.file == bench.document.ast()->source->name();
        const std::string file = isOwn ? "" : std::filesystem::path(p.file).filename().string() + ", ";
        const std::string place = p.line ? fmt::format("{}line {}: ", file, p.line) : std::string();
        const std::string text = place + p.message + (p.hint.empty() ? "" : "  -  " + p.hint);
        if (ImGui::Selectable(text.c_str()) && p.line) revealPlace(bench, p);
        // A row may be cut, and what to write instead stands at its end.
        widgets::hint((place + p.message + (p.hint.empty() ? "" : "\n" + p.hint)).c_str());
        bench.report.mark(fmt::format("problem.{}", i));
        ImGui::PopID();
    }
    ImGui::EndChild();
}

}  // namespace sgm::window
