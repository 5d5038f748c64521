#include "viewer/window/bars.h"
#include "viewer/window/framing.h"
#include "viewer/window/pictures.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <array>

#include "viewer/window/plan_overlay.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

using namespace widgets;

constexpr float widthForAll = 62;  // of the bar, in font sizes: a narrower one leaves out what a key does as well

float widthOfToggle(const char* label) { return buttonWidth(label) + ImGui::GetFrameHeight(); }

/// What the shown model is, and the times of its stages, a line each; both empty where there is none.
std::pair<std::string, std::string> factsOf(const Workbench& bench) {
    if (!bench.shown()) return {};
    std::string stages;
    double seconds = bench.status.fieldTimes.prepare;
    for (const auto& [stage, took] : bench.shown()->stages) {
        seconds += took;
        stages += fmt::format("{}  {:.1f} ms\n", stage, took * 1000);
    }
    stages += fmt::format("cells for the rays  {:.1f} ms", bench.status.fieldTimes.prepare * 1000);
    std::string facts = fmt::format("{} shapes  ·  {} steps  ·  made in {:.0f} ms", bench.tree()->shapes.size(),
                                    bench.shown()->model.derivation.steps.size(), seconds * 1000);
    if (bench.view.wantsMesh() && bench.view.mesh.hasMesh())
        facts += fmt::format("  ·  {} triangles", bench.view.mesh.triangleCount());
    return {std::move(facts), std::move(stages)};
}

}  // namespace

void Bars::flow(float width, float space) {
    ImGui::SameLine(0, space);
    if (ImGui::GetCursorScreenPos().x + width <= ImGui::GetWindowPos().x + ImGui::GetWindowWidth() - 8) return;
    ImGui::NewLine();
    ++lines_;
}

void Bars::flowApart(float width) {
    const int line = lines_;
    flow(width, 29);
    if (line != lines_) return;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine({at.x - 15, at.y + 3}, {at.x - 15, at.y + ImGui::GetFrameHeight() - 3},
                                        ImGui::GetColorU32(ImGuiCol_Border));
}

void Bars::top(Workbench& bench) {
    lines_ = 1;
    Report& report = bench.report;
    const document::Document& document = bench.document;
    ImGui::AlignTextToFramePadding();
    ImGui::PushFont(strongFont());
    const std::string name = document.path().empty() ? "untitled" : document.path().filename().string();
    ImGui::TextUnformatted((name + (bench.panels.fileIsNew ? " (new)" : "")).c_str());
    ImGui::PopFont();
    ImGui::SameLine(0, 4);
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(tint::selected), "%s", document.dirty() ? "•" : " ");
    ImGui::SameLine(0, 10);
    if (quietButton(report, "bar.open", "Open", "Open a grammar (Ctrl+O), or drop it on the window")) dialogs_.open();
    ImGui::SameLine(0, 2);
    if (quietButton(report, "bar.save", "Save", "Write the file (Ctrl+S)", document.dirty() || bench.panels.fileIsNew))
        bench.save();
    ImGui::SameLine(0, 2);
    if (ImGui::GetWindowWidth() > ImGui::GetFontSize() * widthForAll) {
        if (quietButton(report, "bar.save_as", "Save as", "Write another file (Ctrl+Shift+S)"))
            bench.panels.naming = Naming{};
        ImGui::SameLine(0, 2);
    }
    const std::string undo = fmt::format("Take back: {} (Ctrl+Z)", document.history().undoLabel()),
                      redo = fmt::format("Do again: {} (Ctrl+Y)", document.history().redoLabel());
    if (quietButton(report, "bar.undo", "Undo", document.history().canUndo() ? undo.c_str() : nullptr,
                    document.history().canUndo()))
        bench.undo();
    ImGui::SameLine(0, 2);
    if (quietButton(report, "bar.redo", "Redo", document.history().canRedo() ? redo.c_str() : nullptr,
                    document.history().canRedo()))
        bench.redo();
    flowApart(buttonWidth("Field") + buttonWidth("Fog") + buttonWidth("Mesh") + buttonWidth("Split") + 3);
    int pane = static_cast<int>(bench.view.look.pane);
    constexpr std::array panes{"Field", "Fog", "Mesh", "Split"};
    constexpr std::array meanings{"The field itself, by rays: exact, and there at once",
                                  "The solid as a cloud of that shape", "The mesh that would be exported",
                                  "Field and mesh side by side"};
    if (oneOf(report, "pane", panes, pane, meanings)) bench.view.look.pane = static_cast<Pane>(pane);
    lookControls(bench);
    if (bench.view.wantsMesh()) meshControls(bench);
}

float Bars::height() const {
    return ImGui::GetFrameHeight() + 14 + static_cast<float>(lines_ - 1) * ImGui::GetFrameHeightWithSpacing();
}

void Bars::lookControls(Workbench& bench) {
    Report& report = bench.report;
    const float em = ImGui::GetFontSize();
    static const std::vector<std::string> joints{"No joints", "Its joints", "All joints"};
    int shown = static_cast<int>(bench.view.look.joints);
    flowApart(em * 7);
    if (choice(report, "look.joints", joints, shown, em * 7)) bench.view.look.joints = static_cast<JointsShown>(shown);
    hint("Joints of the selected shape or of all: red joins to a centre, green face to face, bonded ones filled");
    flow(widthOfToggle("Ground"));
    toggle(report, "look.ground", "Ground", bench.view.look.ground, "Stand the model on a plane that takes its shadow");
    const bool within = bench.view.orbit.lamp_m > 0;
    flow(buttonWidth("Outside"));
    if (button(report, "look.inside", within ? "Outside" : "Inside",
               "Stand in the largest hollow with a lamp, or leave it", bench.view.field.hasField()))
        within ? frameAll(bench) : bench.stepInside();
    if (bench.shown() && !bench.shown()->grammar->maps.empty()) {
        flow(em * 7);
        bench.view.mapLayer.choose(bench);
    }
    if (bench.session.plan()) {
        flow(widthOfToggle("Plan"));
        choosePlan(bench);
    }
    static const std::vector<std::string> motions{"Orbit", "Fly", "Walk"};
    int motion = static_cast<int>(bench.view.look.motion);
    flow(em * 5);
    if (choice(report, "look.motion", motions, motion, em * 5)) {
        bench.view.look.motion = static_cast<Motion>(motion);
        bench.view.orbit.stands = bench.view.look.motion != Motion::Orbit;
    }
    hint("W A S D Q E turn about the model, fly through it, or walk on its ground");
    flow(buttonWidth("?"));
    if (quietButton(report, "bar.help", "?", "Keys and buttons (F1)")) help_ = !help_;
}

void Bars::meshControls(Workbench& bench) {
    Report& report = bench.report;
    const float em = ImGui::GetFontSize();
    static const std::vector<std::string> looks{"Materials",  "Normals", "Curvature", "Rules",
                                                "Components", "Labels",  "Creases"};
    int look = static_cast<int>(bench.view.look.mesh.look);
    flowApart(em * 7);
    if (choice(report, "mesh.look", looks, look, em * 7))
        bench.view.look.mesh.look = static_cast<render::MeshLook>(look);
    hint("What the mesh's colours tell");
    static const std::vector<std::string> sizes{"64", "128", "192", "256", "384"};
    int size = 0;
    for (int i = 0; i < static_cast<int>(sizes.size()); ++i)
        if (std::stoi(sizes[size_t(i)]) == bench.view.look.meshResolution) size = i;
    flow(em * 4);
    if (choice(report, "mesh.cells", sizes, size, em * 4))
        bench.view.look.meshResolution = std::stoi(sizes[size_t(size)]);
    hint("Cells along the longest side: more are finer and slower");
    flow(widthOfToggle("Wire"));
    toggle(report, "mesh.wire", "Wire", bench.view.look.mesh.wireframe, "The edges of the triangles");
    flow(widthOfToggle("Section"));
    toggle(report, "mesh.section", "Section", bench.view.look.section, "Cut the mesh open along an axis");
    if (!bench.view.look.section) return;
    flow(3 * buttonWidth("x") + 2);
    constexpr std::array axes{"x", "y", "z"};
    oneOf(report, "section.axis", axes, bench.view.look.sectionAxis);
    flow(em * 6);
    ImGui::SetNextItemWidth(em * 6);
    ImGui::SliderFloat("##section", &bench.view.look.sectionShare, 0, 1, "");
    report.mark("section.share");
}

void Bars::status(Workbench& bench) {
    const float right = ImGui::GetWindowWidth();
    ImGui::SetCursorPosY((ImGui::GetWindowHeight() - ImGui::GetFrameHeight()) / 2);
    ImGui::AlignTextToFramePadding();
    const auto progress = [&](std::string_view stage, double fraction, const char* name, const char* hint) {
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 3);
        ImGui::ProgressBar(static_cast<float>(fraction), {ImGui::GetFontSize() * 10, ImGui::GetFrameHeight() - 6},
                           std::string(stage).c_str());
        ImGui::SameLine();
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() - 3);
        const bool cancelled = button(bench.report, name, "Cancel", hint);
        ImGui::SameLine();
        return cancelled;
    };
    if (bench.busy()) {
        const auto show = [&](const auto& worker) {
            return progress(worker.stage(), worker.fraction(), "progress.cancel",
                            "Keep the model as it is; Esc while a slider is held");
        };
        if (bench.steps.running()  ? show(bench.steps)
            : bench.session.busy() ? show(bench.session)
                                   : show(bench.uploader))
            bench.cancel();
    }
    if (bench.exporting.running() && progress(bench.exporting.stage(), bench.exporting.fraction(), "export.cancel",
                                              "Stop the export; the file stays as it was"))
        bench.exporting.cancel();
    const auto [facts, stages] = factsOf(bench);
    const float from = right - ImGui::CalcTextSize(facts.c_str()).x - 12;
    const std::string& notice =
        bench.view.hover && !bench.panels.noticeIsProblem ? bench.view.hover->text : bench.panels.notice;
    ImGui::PushStyleColor(ImGuiCol_Text, bench.panels.noticeIsProblem ? tint::error : tint::faint);
    const std::string seen = shortened(notice, from - ImGui::GetCursorPosX() - 12);
    ImGui::TextUnformatted(seen.c_str());
    ImGui::PopStyleColor();
    if (seen != notice) hint(notice.c_str());
    ImGui::SameLine(from);
    faint(facts);
    hint(stages.empty() ? nullptr : stages.c_str());
}

void Bars::leaveField(Workbench& bench) {
    const auto pressed = [](int key) { return ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(key, false); };
    leftField_ = ImGui::GetIO().WantTextInput && !bench.panels.typing && !ImGui::GetTopMostPopupModal() &&
                 (pressed(GLFW_KEY_S) || pressed(GLFW_KEY_O));
    if (!leftField_) return;
    ImGui::ClearActiveID();
    bench.say("");  // what is said from here on is about the field
}

bool Bars::takesKeys(const Workbench& bench) const {
    if (ImGui::GetTopMostPopupModal()) return false;
    return !ImGui::GetIO().WantTextInput || bench.panels.typing || leftField_;
}

void Bars::save(Workbench& bench) {
    const Panels& panels = bench.panels;
    const std::string refused = leftField_ && panels.noticeIsProblem ? panels.notice : "";
    bench.save();
    if (!refused.empty() && !panels.noticeIsProblem)
        bench.say(fmt::format("{}, without what was refused: {}", panels.notice, refused), true);
}

void Bars::keys(Workbench& bench) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [](int key) { return ImGui::IsKeyPressed(key, false); };
    const bool listOpen = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    if (pressed(GLFW_KEY_ESCAPE)) {
        if (listOpen) ImGui::ClosePopupToLevel(0, true);
        help_ = false;
        bench.pictures.turntable.reset();
        // A user who drags a slider can't click Cancel.
        if (bench.document.dragging() && bench.busy()) bench.cancel();
    }
    if (io.KeyCtrl) {
        if (pressed(GLFW_KEY_S)) io.KeyShift ? void(bench.panels.naming = Naming{}) : save(bench);
        if (pressed(GLFW_KEY_O)) dialogs_.open();
        if (ImGui::IsKeyPressed(GLFW_KEY_Z)) io.KeyShift ? bench.redo() : bench.undo();
        if (ImGui::IsKeyPressed(GLFW_KEY_Y)) bench.redo();
        return;
    }
    if (bench.panels.typing || listOpen) return;
    const auto free = [&](int key) {
        return pressed(key) && bench.panels.hotkeys.find(static_cast<char>(std::tolower(key))) == std::string::npos;
    };
    if (pressed(GLFW_KEY_F1)) help_ = !help_;
    if (free(GLFW_KEY_P)) bench.pictures.wanted = true;
    if (free(GLFW_KEY_T)) startTurntable(bench, 36);
}

void Bars::dialogs(Workbench& bench) {
    if (help_) cheatSheet(bench);
    dialogs_.show(bench);
}

void Bars::cheatSheet(Workbench& bench) {
    const bool blender = bench.view.look.navigation == NavigationPreset::Blender;
    const bool orbits = bench.view.look.motion == Motion::Orbit;
    const std::pair<const char*, const char*> rows[] = {
        {blender ? "MMB drag" : "LMB drag", "Turn"},
        {blender ? "Shift MMB" : "MMB drag", "Move"},
        {blender ? "Ctrl MMB" : "RMB drag", "Nearer, farther"},
        {"Wheel", "Nearer, farther"},
        {"Click", "Select what is there, and its text"},
        {"Ctrl+Click", "On a slider: type its value"},
        {"W S  A D", orbits ? "Turn up, down, left, right" : "Ahead, back, left, right"},
        {"Q E", orbits ? "Narrow the view, widen it" : "Down, up"},
        {"K  Shift+K", "Nearer, farther"},
        {"F", "Frame the selection"},
        {"Home", "All, from the usual side"},
        {"1 - 7", "Front, back, right, left, top, bottom, three-quarter"},
        {"P", "Picture of the view beside the file"},
        {"T", "Turntable: 36 pictures"},
        {"Ctrl+S  Ctrl+O", "Save, open"},
        {"Ctrl+Shift+S", "Save under another name"},
        {"Ctrl+Z  Ctrl+Y", "Undo, redo"},
        {"Ctrl+F  F3", "In the text: find, go on"},
        {"Ctrl+/  Tab", "In the text: make comments of lines, indent them"},
        {"F1", "This sheet"}};
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    if (ImGui::Begin(
            "Keys and buttons", &help_,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        if (ImGui::BeginTable("keys", 2)) {
            const auto row = [](const char* key, const char* what) {
                ImGui::TableNextColumn();
                ImGui::PushFont(strongFont());
                ImGui::TextUnformatted(key);
                ImGui::PopFont();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(what);
            };
            for (const auto& [key, what] : rows) row(key, what);
            if (bench.shown())
                for (const rules::Param& param : bench.shown()->grammar->params)
                    if (!param.key.empty())
                        row(param.key.c_str(),
                            fmt::format("{} (Shift reverses)", param.label.empty() ? param.name : param.label).c_str());
            ImGui::EndTable();
        }
        int preset = static_cast<int>(bench.view.look.navigation);
        constexpr std::array presets{"Usual buttons", "Blender's"};
        if (oneOf(bench.report, "navigation", presets, preset))
            bench.view.look.navigation = static_cast<NavigationPreset>(preset);
        bench.report.mark(
            "help", ImGui::GetWindowPos(),
            {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
    }
    ImGui::End();
}

}  // namespace sgm::window
