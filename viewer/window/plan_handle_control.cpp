#include "viewer/window/plan_handle_control.h"

#include <cmath>

#include "viewer/window/overlay.h"
#include "viewer/window/style.h"

namespace sgm::window {
namespace {

/// Where the pointer's ray meets the level of `height_m`; nothing where it looks along it or away.
std::optional<Vec3d> onLevel(const Projection& project, ImVec2 mouse, double height_m) {
    const double x = static_cast<double>((mouse.x - project.low.x) / project.size.x) * 2 - 1,
                 y = 1 - static_cast<double>((mouse.y - project.low.y) / project.size.y) * 2;
    const Vec3d way = normalized(project.view.forward + project.view.right * x + project.view.up * y);
    if (std::abs(way.y) < 1e-3) return std::nullopt;
    const double t = (height_m - project.view.eye.y) / way.y;
    return t > 0 ? std::optional(project.view.eye + way * t) : std::nullopt;
}

/// Metres that a pixel spans at a place.
double pixel_m(const Projection& project, Vec3d at) {
    const double depth = dot(at - project.view.eye, project.view.forward);
    return 2 * depth * length(project.view.up) / static_cast<double>(project.size.y);
}

}  // namespace

void PlanHandleControl::renew(const Workbench& bench) {
    if (drag_ || (shown_.lock() == bench.session.model() && selected_ == bench.selected())) return;
    if (!bench.shown() || !document::isCurrent(bench.document, *bench.shown())) return;
    handles_ = document::PlanHandles::of(bench.document, *bench.shown(), bench.selected());
    shown_ = bench.session.model();
    selected_ = bench.selected();
}

bool PlanHandleControl::use(Workbench& bench, const Projection& project, ImDrawList& list, bool hovered) {
    renew(bench);
    const bool wasDragging = isDragging();
    if (drag_) drag(bench, project);
    if (!drag_ && handles_.ast() != bench.document.ast()) return wasDragging;
    const float r = ImGui::GetFontSize() * .32f;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<size_t> under;
    for (size_t i = 0; i < handles_.all().size(); ++i) {
        const document::PlanHandle& handle = handles_.all()[i];
        const bool isDragged = drag_ && drag_->handle == i;
        const auto at = project(isDragged ? drag_->to : handle.at);
        if (!at) continue;
        if (std::hypot(at->x - mouse.x, at->y - mouse.y) < 1.6f * r) under = i;
        const ImU32 color = isDragged || under == i ? tint::selected : IM_COL32(250, 250, 245, 255);
        if (handle.kind == document::PlanHandle::Kind::Side) {
            const auto from = project(handle.ends[0]), to = project(handle.ends[1]);
            if (from && to && !isDragged) list.AddLine(*from, *to, IM_COL32(250, 250, 245, 150), 1.5f);
            list.AddRectFilled({at->x - r, at->y - r}, {at->x + r, at->y + r}, IM_COL32(10, 12, 16, 200));
            list.AddRectFilled({at->x - r + 2, at->y - r + 2}, {at->x + r - 2, at->y + r - 2}, color);
        } else {
            list.AddCircleFilled(*at, r, IM_COL32(10, 12, 16, 200));
            list.AddCircleFilled(*at, r - 2, color);
        }
        bench.report.mark("handle." + handle.name, {at->x - r, at->y - r}, {at->x + r, at->y + r});
    }
    if (wasDragging) return true;
    if (!hovered || !under) return false;
    ImGui::SetTooltip("%s: drag", handles_.all()[*under].name.c_str());
    if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return true;
    const Vec3d at = handles_.all()[*under].at;
    if (const auto grip = onLevel(project, mouse, at.y)) {
        drag_ = Drag{*under, at, *grip, at};
        bench.document.beginDrag();
    }
    return true;
}

/// The edit is of the text that the drag began with, so the document gets what leads from its present text there.
void PlanHandleControl::drag(Workbench& bench, const Projection& project) {
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        bench.document.endDrag();
        drag_.reset();
        shown_.reset();
        return;
    }
    const auto place = onLevel(project, ImGui::GetIO().MousePos, drag_->from.y);
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (!place || (moved.x == 0 && moved.y == 0)) return;
    drag_->to = drag_->from + *place - drag_->grip;
    const auto edit = handles_.move(drag_->handle, drag_->to, pixel_m(project, drag_->to));
    if (!edit.ok()) return bench.say(edit.error().message, true);
    const std::string text = document::applied(handles_.ast()->source->text(), *edit);
    bench.edit(document::difference(bench.document.text(), text), "Move " + handles_.all()[drag_->handle].name);
}

}  // namespace sgm::window
