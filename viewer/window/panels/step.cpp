#include <fmt/format.h>
#include <imgui.h>

#include "viewer/document/picking.h"
#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {

using namespace widgets;

namespace {

constexpr size_t longestHint = 1000;  // bytes of a way: more fills the screen

}  // namespace

void StepPanel::begin(Workbench& bench) {
    ImGui::PushTextWrapPos(0);
    faint(
        "Derive by hand: pick a live shape here or in the view, and one of the rules that match it. The way can be "
        "kept as a `derive` line.");
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0, 4});
    if (!bench.shown()) return;
    if (button(bench.report, "step.begin", "Begin at the start")) bench.beginSteps("");
    const std::vector<std::string> ways = document::waysOf(*bench.shown()->grammar);
    if (!ways.empty()) heading("Walk a way");
    for (const std::string& way : ways) {
        if (button(bench.report, "step.way." + way, way.c_str())) bench.beginSteps(way);
        ImGui::SameLine();
    }
    if (!ways.empty()) ImGui::NewLine();
    letters_.show(bench);
}

void StepPanel::show(Workbench& bench) {
    const std::shared_ptr<const document::StepView> view = bench.steps.view();
    if (!view) return begin(bench);
    const bool idle = !bench.steps.running();
    if (button(bench.report, "step.undo", "Back", "Take the last step back", idle && view->canUndo)) bench.steps.undo();
    ImGui::SameLine();
    if (button(bench.report, "step.redo", "Forward", "Do it again", idle && view->canRedo)) bench.steps.redo();
    ImGui::SameLine();
    if (button(bench.report, "step.rest", "The rest", "Go on automatically until no rule matches", idle))
        bench.steps.applyRest();
    ImGui::SameLine();
    if (button(bench.report, "step.end", "End", "Back to the automatic derivation")) {
        bench.endSteps();
        return;
    }
    shapes(bench, *view);
    save(bench, *view);
}

void StepPanel::shapes(Workbench& bench, const document::StepView& view) {
    const float below = ImGui::GetFrameHeightWithSpacing() * 3.4f;
    std::optional<std::pair<derive::ShapeId, document::StepRule>> chosen;
    if (ImGui::BeginChild("live", {0, -below})) {
        size_t waiting = 0;
        for (const document::StepRow& row : view.rows) waiting += !row.rules.empty();
        const size_t live = view.rows.size();
        heading(fmt::format("{} live shape{}, {} of them matched", live, live == 1 ? "" : "s", waiting).c_str());
        const derive::ShapeId meant = document::selected(view.tree, bench.document.choice().selection);
        const document::StepRow* const picked = meant == derive::none ? nullptr : view.rowOf(meant);
        for (const document::StepRow& row : view.rows) {
            ImGui::PushID(static_cast<int>(row.shape));
            const bool selected = picked == &row;
            ImGui::PushStyleColor(ImGuiCol_Text, row.rules.empty() ? tint::faint : tint::nonTerminal);
            if (ImGui::Selectable(row.path.c_str(), selected)) bench.selectLive(seen_ = row.shape);
            ImGui::PopStyleColor();
            bench.report.mark("live." + row.path);
            hint(fmt::format("{:.2f} x {:.2f} x {:.2f} m{}{}", row.size_m.x, row.size_m.y, row.size_m.z,
                             row.closed.empty() ? "" : "\n", row.closed)
                     .c_str());
            if (selected && row.shape != seen_) {
                ImGui::SetScrollHereY();
                seen_ = row.shape;
            }
            ImGui::Indent();
            for (const document::StepRule& r : row.rules) {
                if (button(bench.report, fmt::format("apply.{}.{}", row.path, r.name), r.name.c_str(),
                           std::string(r.span.text()).c_str()))
                    chosen = {row.shape, r};
                ImGui::SameLine();
            }
            if (!row.rules.empty()) ImGui::NewLine();
            ImGui::Unindent();
            ImGui::PopID();
        }
    }
    ImGui::EndChild();
    if (chosen) bench.steps.apply(chosen->first, chosen->second);
}

void StepPanel::save(Workbench& bench, const document::StepView& view) {
    ImGui::Separator();
    const Result<std::string> way = view.way(way_);
    const std::string& whole = way ? *way : way.error().message;
    if (way) ImGui::PushFont(codeFont());
    faint(shortened(whole, ImGui::GetContentRegionAvail().x));
    if (way) ImGui::PopFont();
    hint(whole.size() <= longestHint ? whole.c_str() : (whole.substr(0, longestHint) + "…").c_str());
    const FieldWithButton row{.field = "step.name",
                              .empty = "Name of the way",
                              .button = "step.save",
                              .label = "Save way",
                              .buttonHint = "Write it into the text as a `derive` line"};
    if (fieldWithButton(bench.report, row, way_, [&] { return way.ok() && !bench.steps.running(); }))
        bench.steps.save(bench.document.ast(), way_);
}

}  // namespace sgm::window
