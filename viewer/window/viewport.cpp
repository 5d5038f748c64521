#include "viewer/window/viewport.h"
#include "viewer/window/framing.h"
#include "viewer/window/selecting.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "viewer/window/camera_keys.h"
#include "viewer/window/overlay.h"
#include "viewer/window/plan_overlay.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

constexpr float clickSlack = 4;  // pixels a click may wander

ImTextureID textureOf(uint32_t id) { return reinterpret_cast<ImTextureID>(static_cast<intptr_t>(id)); }

enum class Grip { None, Turn, Move, Approach };

/// What the pressed buttons do to the camera.
Grip gripOf(NavigationPreset preset) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto down = [](int button) { return ImGui::IsMouseDragging(button, clickSlack); };
    if (preset == NavigationPreset::Blender) {
        if (!down(ImGuiMouseButton_Middle)) return Grip::None;
        return io.KeyShift ? Grip::Move : io.KeyCtrl ? Grip::Approach : Grip::Turn;
    }
    // With Alt the same buttons mean the same, as users of Maya expect.
    if (down(ImGuiMouseButton_Left)) return io.KeyShift ? Grip::Move : Grip::Turn;
    if (down(ImGuiMouseButton_Middle)) return Grip::Move;
    return down(ImGuiMouseButton_Right) ? Grip::Approach : Grip::None;
}

void moveCamera(Workbench& bench, float height) {
    const ImGuiIO& io = ImGui::GetIO();
    const double x = io.MouseDelta.x / height, y = io.MouseDelta.y / height;
    switch (gripOf(bench.view.look.navigation)) {
        case Grip::Turn:
            bench.view.orbit.turn(x, y);
            break;
        case Grip::Move:
            bench.view.orbit.move(x, y);
            break;
        case Grip::Approach:
            bench.view.orbit.approach(std::exp(2.5 * (y - x)));
            break;
        case Grip::None:
            break;
    }
}

/// What lies under a place of the picture.
std::optional<Hover> hoverAt(Workbench& bench, ImVec2 low, ImVec2 mouse) {
    const auto pick = bench.view.field.pick(static_cast<int>(mouse.x - low.x), static_cast<int>(mouse.y - low.y));
    return pick ? hoverOf(bench, *pick) : std::nullopt;
}

/// Tells a test where joints are.
void markJoints(Workbench& bench, const std::vector<ScreenJoint>& joints) {
    if (!bench.report.active()) return;
    const float r = ImGui::GetFontSize() * 0.3f;
    for (const ScreenJoint& joint : joints)
        bench.report.mark(fmt::format("joint.{}.{}", bench.tree()->path(joint.mark.shape, true), joint.mark.name),
                          {joint.at.x - r, joint.at.y - r}, {joint.at.x + r, joint.at.y + r});
}

/// A shape that is dragged here from the Shapes panel is joined at the joint under the pointer. Those that it can be
/// joined at show; where there are none, why, and at a joint of another shape what to write for it.
void takeShape(Workbench& bench, const Projection& project, ImDrawList& list) {
    const ImGuiPayload* dragged = ImGui::GetDragDropPayload();
    if (!dragged || !dragged->IsDataType("shape") || !bench.tree()) return;
    const auto moved = *static_cast<const derive::ShapeId*>(dragged->Data);
    const auto hosts = document::hostsFor(bench.document, *bench.shown(), moved);
    if (!hosts.ok()) return bench.say(hosts.error().message, true);
    const std::vector<ScreenJoint> joints = screenJoints(*bench.tree(), *hosts, project);
    drawJoints(joints, list);
    markJoints(bench, joints);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const ScreenJoint* nearest = nearestJoint(joints, mouse, ImGui::GetFontSize());
    if (nearest) list.AddCircle(nearest->at, ImGui::GetFontSize() * 0.5f, tint::selected, 0, 2.5f);
    // A joint of a shape that another rule matches tells why it can't be had, and what to write.
    std::vector<ScreenJoint> others;
    if (!nearest) others = screenJoints(*bench.tree(), everyOwner(*bench.tree()), project);
    markJoints(bench, others);
    if (!nearest) nearest = nearestJoint(others, mouse, ImGui::GetFontSize());
    if (nearest && !others.empty()) {
        list.AddCircle(nearest->at, ImGui::GetFontSize() * 0.5f, tint::faint, 0, 2.5f);
        const document::edits::Edit refused =
            document::attach(bench.document, *bench.shown(), moved, nearest->mark.shape, nearest->mark.joint);
        if (!refused) widgets::tooltip(refused.error().message.c_str());
    }
    if (!ImGui::BeginDragDropTarget()) return;
    if (const ImGuiPayload* dropped = ImGui::AcceptDragDropPayload("shape", ImGuiDragDropFlags_AcceptNoDrawDefaultRect);
        dropped && nearest)
        attach(bench, moved, nearest->mark.shape, nearest->mark.joint);
    ImGui::EndDragDropTarget();
}

render::PictureOptions optionsFor(const Workbench& bench, ImVec2 size) {
    render::PictureOptions options;
    options.width = static_cast<int>(size.x);
    options.height = static_cast<int>(size.y);
    options.camera = bench.view.orbit.camera(size.x / size.y);
    options.ground = bench.view.look.ground && bench.view.orbit.lamp_m == 0;
    return options;
}

void showField(Workbench& bench, ImVec2 low, ImVec2 size) {
    bench.view.field.setLook(optionsFor(bench, size));
    // A camera that moves always has a picture, if a coarse one.
    if (!bench.view.field.visible())
        if (const Status s = bench.view.field.step(); !s) bench.say(s.error().message, true);
    if (!bench.view.field.visible()) return;
    const ImVec2 high(low.x + size.x, low.y + size.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddImage(textureOf(bench.view.field.coarse()), low, high);
    list.AddImage(textureOf(bench.view.field.fine()), low, high);
}

void showMesh(Workbench& bench, ImVec2 low, ImVec2 size) {
    bench.view.mesh.setLook(optionsFor(bench, size), meshStyle(bench));
    if (!bench.view.mesh.visible())
        if (const Status s = bench.view.mesh.step(); !s) bench.say(s.error().message, true);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (bench.view.mesh.visible())
        list.AddImage(textureOf(bench.view.mesh.texture()), low, ImVec2(low.x + size.x, low.y + size.y));
    if (bench.view.mesh.hasMesh()) return;
    const char* text = bench.busy() ? "Meshing…" : "No mesh";
    const ImVec2 half = ImGui::CalcTextSize(text);
    list.AddText(ImVec2(low.x + (size.x - half.x) / 2, low.y + (size.y - half.y) / 2), tint::faint, text);
}

/// Keeps what is told of the place under the pointer true: it is looked up anew once the camera rests.
void followPointer(Workbench& bench, ImVec2 low) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool moving = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
    if (bench.view.orbit != bench.view.seenFrom)
        bench.view.hover.reset();
    else if (!ImGui::IsAnyMouseDown() && (moving || !bench.view.hover))
        bench.view.hover = hoverAt(bench, low, io.MousePos);
}

void tellHover(const Hover& hover) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10, 6));
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(hover.text.c_str());
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

/// One picture with its input and overlays; `name` is what the report calls it. True while the pointer is over it.
bool view(Workbench& bench, const char* name, ImVec2 low, ImVec2 size, bool isMesh) {
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton(
        name, size,
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle | ImGuiButtonFlags_MouseButtonRight);
    bench.report.mark(name);
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    if (ImGui::IsItemActive() && !bench.view.planHandles.isDragging()) moveCamera(bench, size.y);
    if (hovered && io.MouseWheel != 0) bench.view.orbit.approach(std::pow(0.85, io.MouseWheel));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(low, ImVec2(low.x + size.x, low.y + size.y), true);
    isMesh ? showMesh(bench, low, size) : showField(bench, low, size);
    const Projection project(bench.view.orbit.camera(size.x / size.y), low, size);
    if (bench.tree() && bench.selected() != derive::none) drawScope(bench, bench.selected(), project, list);
    drawFace(bench, project, list, hovered);
    bench.view.mapLayer.draw(bench, project, list);
    drawPlan(bench, project, list);
    drawBonds(bench, project, list);
    drawAxes(project, list);
    takeShape(bench, project, list);
    const bool onHandle = bench.view.planHandles.use(bench, project, list, hovered);
    list.PopClipRect();
    if (hovered) followPointer(bench, low);
    const ImVec2 wandered = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    const bool click = hovered && !onHandle && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
                       std::hypot(wandered.x, wandered.y) < clickSlack;
    if (click) {
        bench.view.hover = hoverAt(bench, low, io.MousePos);
        bench.select(bench.view.hover ? bench.view.hover->shape : derive::none);
        if (bench.view.hover) bench.view.face = bench.view.hover->face;
    }
    if (hovered && !onHandle && bench.view.hover && !ImGui::IsAnyMouseDown()) tellHover(*bench.view.hover);
    return hovered;
}

}  // namespace

void viewport(Workbench& bench) {
    const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const ImVec2 size(std::floor(std::max(room.x, 32.0f)), std::floor(std::max(room.y, 32.0f)));
    bool hovered = false;
    if (bench.view.look.pane == Pane::Split) {
        const float half = std::floor((size.x - 2) / 2);
        hovered = view(bench, "view.field", low, {half, size.y}, false);
        hovered |= view(bench, "view.mesh", {low.x + half + 2, low.y}, {half, size.y}, true);
    } else {
        const bool isMesh = bench.view.look.pane == Pane::Mesh;
        // Picking asks the field, so its look follows even where it isn't shown.
        if (isMesh) bench.view.field.setLook(optionsFor(bench, size));
        hovered = view(bench, isMesh ? "view.mesh" : "view.field", low, size, isMesh);
    }
    if (!hovered) bench.view.hover.reset();
    bench.view.seenFrom = bench.view.orbit;
}

void viewKeys(Workbench& bench) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl || io.KeyAlt || io.KeySuper) return;
    // The grammar's own keys go first.
    const auto pressed = [&](int key) {
        return ImGui::IsKeyPressed(key, false) &&
               bench.panels.hotkeys.find(static_cast<char>(std::tolower(key & 127))) == std::string::npos;
    };
    cameraKeys(bench);
    if (pressed(GLFW_KEY_F)) frameSelection(bench);
    if (ImGui::IsKeyPressed(GLFW_KEY_HOME, false)) {
        bench.view.orbit.look(StandardView::ThreeQuarter);
        frameAll(bench);
    }
    for (int view = 1; view <= 7; ++view)
        if (pressed(GLFW_KEY_0 + view) || pressed(GLFW_KEY_KP_0 + view))
            bench.view.orbit.look(static_cast<StandardView>(view));
}

}  // namespace sgm::window
