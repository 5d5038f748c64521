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
    if (!bench.stepper) return begin(bench);
    document::Stepper& stepper = *bench.stepper;
    if (button(bench.report, "step.undo", "Back", "Take the last step back", stepper.canUndo()))
        bench.stepped(stepper.undo(), "A step back");
    ImGui::SameLine();
    if (button(bench.report, "step.redo", "Forward", "Do it again", stepper.canRedo()))
        bench.stepped(stepper.redo(), "A step forward");
    ImGui::SameLine();
    if (button(bench.report, "step.rest", "The rest", "Go on automatically until no rule matches"))
        bench.stepped(stepper.applyRest(), "The rest by itself");
    ImGui::SameLine();
    if (button(bench.report, "step.end", "End", "Back to the automatic derivation")) {
        bench.endSteps();
        return;
    }
    shapes(bench);
    save(bench);
}

void StepPanel::shapes(Workbench& bench) {
    const float below = ImGui::GetFrameHeightWithSpacing() * 3.4f;
    std::optional<std::pair<derive::ShapeId, uint32_t>> chosen;
    std::string rule;
    if (ImGui::BeginChild("live", {0, -below})) {
        size_t waiting = 0;
        for (const document::StepRow& row : bench.stepper->rows()) waiting += !row.rules.empty();
        const size_t live = bench.stepper->rows().size();
        heading(fmt::format("{} live shape{}, {} of them matched", live, live == 1 ? "" : "s", waiting).c_str());
        const derive::ShapeId meant = document::selected(bench.stepper->tree(), bench.document.choice().selection);
        const document::StepRow* const picked = meant == derive::none ? nullptr : bench.stepper->rowOf(meant);
        for (const document::StepRow& row : bench.stepper->rows()) {
            ImGui::PushID(static_cast<int>(row.shape));
            const bool selected = picked == &row;
            ImGui::PushStyleColor(ImGuiCol_Text, row.rules.empty() ? tint::faint : tint::nonTerminal);
            if (ImGui::Selectable(row.path.c_str(), selected)) bench.selectLive(seen_ = row.shape);
            ImGui::PopStyleColor();
            bench.report.mark("live." + row.path);
            hint(fmt::format("{:.2f} x {:.2f} x {:.2f} m", row.size_m.x, row.size_m.y, row.size_m.z).c_str());
            if (selected && row.shape != seen_) {
                ImGui::SetScrollHereY();
                seen_ = row.shape;
            }
            ImGui::Indent();
            for (const document::StepRule& r : row.rules) {
                if (button(bench.report, fmt::format("apply.{}.{}", row.path, r.name), r.name.c_str(),
                           std::string(r.span.text()).c_str())) {
                    chosen = {row.shape, r.rule};
                    rule = r.name;
                }
                ImGui::SameLine();
            }
            if (!row.rules.empty()) ImGui::NewLine();
            ImGui::Unindent();
            ImGui::PopID();
        }
    }
    ImGui::EndChild();
    if (chosen) bench.stepped(bench.stepper->apply(chosen->first, chosen->second), "Applied " + rule);
}

void StepPanel::save(Workbench& bench) {
    ImGui::Separator();
    const Result<std::string> way = bench.stepper->way(way_);
    const std::string& whole = way ? *way : way.error().message;
    if (way) ImGui::PushFont(codeFont());
    faint(shortened(whole, ImGui::GetContentRegionAvail().x));
    if (way) ImGui::PopFont();
    hint(whole.size() <= longestHint ? whole.c_str() : (whole.substr(0, longestHint) + "…").c_str());
    const float width = ImGui::CalcTextSize("Save way").x + 2 * ImGui::GetStyle().FramePadding.x;
    field(bench.report, "step.name", way_, "Name of the way",
          ImGui::GetContentRegionAvail().x - width - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SameLine();
    if (button(bench.report, "step.save", "Save way", "Write it into the text as a `derive` line", way.ok()))
        bench.edit(bench.stepper->save(*bench.document.ast(), way_), "Save way " + way_);
}

}  // namespace sgm::window
