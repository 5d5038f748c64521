#include <fmt/format.h>
#include <imgui.h>

#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

using namespace widgets;

}  // namespace

void ShapesPanel::show(Workbench& bench) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushFont(strongFont());
    ImGui::TextUnformatted("Shapes");
    ImGui::PopFont();
    const auto& shown = bench.session.model();
    if (!shown) return faint("They come with the first model.");
    ImGui::SameLine();
    const float live = ImGui::CalcTextSize("Live").x + ImGui::GetFrameHeight() + 3 * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(std::max(40.0f, ImGui::GetContentRegionAvail().x - live));
    // Filters as one types.
    static_assert(std::is_same_v<decltype(filter_.text), std::string>);
    char text[128] = "";
    filter_.text.copy(text, sizeof text - 1);
    if (ImGui::InputTextWithHint("##filter", "Filter by shape or rule", text, sizeof text)) filter_.text = text;
    bench.report.mark("shapes.filter");
    ImGui::SameLine();
    toggle(bench.report, "shapes.live", "Live", filter_.liveOnly, "Only those that rules may still rewrite");
    if (bench.selected() != seen_ && bench.selected() != derive::none) {
        document::reveal(*bench.tree(), bench.selected(), folded_);
        stale_ = true;
    }
    if (listed_ != shown || !(listedFilter_ == filter_) || stale_) {
        rows_ = shapeRows(shown->model.derivation, filter_, folded_);
        listed_ = shown;
        listedFilter_ = filter_;
        stale_ = false;
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 2));
    if (ImGui::BeginChild("rows")) {
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(rows_.size()), ImGui::GetTextLineHeight() + 6);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) row(bench, rows_[size_t(i)]);
        if (bench.selected() != seen_) {
            for (size_t i = 0; i < rows_.size(); ++i)
                if (rows_[i].shape == bench.selected())
                    ImGui::SetScrollY(std::max(
                        0.0f, (ImGui::GetTextLineHeight() + 6) * static_cast<float>(i) - ImGui::GetWindowHeight() / 2));
            seen_ = bench.selected();
        }
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

void ShapesPanel::row(Workbench& bench, const document::ShapeRow& row) {
    const derive::Derivation& derivation = bench.shown()->model.derivation;
    const derive::Shape& shape = derivation.tree.shapes[row.shape];
    const document::ShapeLabel label = document::labelOf(derivation, row.shape);
    ImGui::PushID(static_cast<int>(row.shape));
    const float height = ImGui::GetTextLineHeight() + 4, indent = static_cast<float>(std::min(row.depth, 24u)) * 11;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::Selectable("##row", bench.selected() == row.shape, ImGuiSelectableFlags_AllowItemOverlap, {0, height})) {
        const bool onArrow = row.hasChildren && ImGui::GetIO().MousePos.x < low.x + indent + 14;
        if (!onArrow)
            bench.select(row.shape);
        else if (!folded_.erase(shape.key))
            folded_.insert(shape.key);
        stale_ |= onArrow;
        seen_ = bench.selected();
    }
    bench.report.mark("shape." + derivation.tree.path(row.shape, true));
    if (ImGui::IsItemHovered() && !ImGui::IsMouseDown(ImGuiMouseButton_Left))
        if (const std::string closed = document::closedJoints(derivation, row.shape); !closed.empty())
            tooltip(closed.c_str());
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload("shape", &row.shape, sizeof row.shape);
        ImGui::TextUnformatted(fmt::format("{}: drop it on a joint", label.name).c_str());
        ImGui::EndDragDropSource();
    }
    float x = low.x + indent;
    const float y = low.y + 2, middle = low.y + height / 2;
    if (row.hasChildren) {
        const ImU32 color = ImGui::GetColorU32(ImGuiCol_TextDisabled);
        row.open ? list.AddTriangleFilled({x + 2, middle - 2}, {x + 10, middle - 2}, {x + 6, middle + 3}, color)
                 : list.AddTriangleFilled({x + 4, middle - 4}, {x + 4, middle + 4}, {x + 9, middle}, color);
    }
    x += 15;
    const auto say = [&](std::string_view text, ImU32 color) {
        list.AddText({x, y}, color, text.data(), text.data() + text.size());
        x += ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
    };
    if (!label.sign.empty()) {
        say(label.sign, tint::faint);
        x += 5;
    }
    ImU32 color = label.terminal ? tint::terminal : tint::nonTerminal;
    if (!row.matches) color = tint::faint;
    say(label.name, color);
    if (label.live) say("  live", tint::good);
    const float ruleWidth = ImGui::CalcTextSize(label.rule.c_str()).x;
    if (low.x + width - ruleWidth > x + 12)
        list.AddText({low.x + width - ruleWidth - 4, y}, tint::faint, label.rule.c_str());
    ImGui::PopID();
}

}  // namespace sgm::window
