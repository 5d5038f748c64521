#include "viewer/window/style.h"

#include <imgui_freetype.h>

#include <filesystem>
#include <initializer_list>

namespace sgm::window {
namespace {

/// The first of the fonts that this system has; ImGui's own, scaled, where it has none.
void addFont(std::initializer_list<const char*> files, float size, float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    // Latin, Greek, punctuation, arrows, operators and shapes: what labels and the panels' signs need.
    static const ImWchar ranges[] = {0x20,   0x17f,  0x370,  0x3ff,  0x2010, 0x2044, 0x2190, 0x21ff,
                                     0x2200, 0x22ff, 0x25a0, 0x25ff, 0x2713, 0x2717, 0};
    std::error_code ignored;
    for (const char* file : files)
        if (std::filesystem::exists(file, ignored)) {
            fonts.AddFontFromFileTTF(file, size * scale, nullptr, ranges);
            // Signs that the font lacks.
            const char* more = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
            if (std::filesystem::exists(more, ignored)) {
                ImFontConfig merge;
                merge.MergeMode = true;
                fonts.AddFontFromFileTTF(more, size * scale * 0.92f, &merge, ranges);
            }
            return;
        }
    ImFontConfig own;
    own.SizePixels = size * scale;
    fonts.AddFontDefault(&own);
}

ImVec4 grey(float level, float alpha = 1) { return {level * 0.97f, level, level * 1.06f, alpha}; }

void color() {
    ImVec4* c = ImGui::GetStyle().Colors;
    const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(tint::accent);
    const auto accented = [&](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
    c[ImGuiCol_Text] = ImGui::ColorConvertU32ToFloat4(tint::text);
    c[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(tint::faint);
    c[ImGuiCol_WindowBg] = c[ImGuiCol_ChildBg] = grey(0.125f);
    c[ImGuiCol_PopupBg] = grey(0.15f, 0.98f);
    c[ImGuiCol_Border] = grey(0.23f);
    c[ImGuiCol_BorderShadow] = {0, 0, 0, 0};
    c[ImGuiCol_FrameBg] = grey(0.19f);
    c[ImGuiCol_FrameBgHovered] = grey(0.23f);
    c[ImGuiCol_FrameBgActive] = grey(0.26f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = grey(0.15f);
    c[ImGuiCol_MenuBarBg] = grey(0.15f);
    c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    c[ImGuiCol_ScrollbarGrab] = grey(0.28f);
    c[ImGuiCol_ScrollbarGrabHovered] = grey(0.34f);
    c[ImGuiCol_ScrollbarGrabActive] = grey(0.4f);
    c[ImGuiCol_CheckMark] = accent;
    c[ImGuiCol_SliderGrab] = accented(0.55f);
    c[ImGuiCol_SliderGrabActive] = accent;
    c[ImGuiCol_Button] = grey(0.21f);
    c[ImGuiCol_ButtonHovered] = grey(0.27f);
    c[ImGuiCol_ButtonActive] = accented(0.6f);
    c[ImGuiCol_Header] = accented(0.22f);
    c[ImGuiCol_HeaderHovered] = accented(0.16f);
    c[ImGuiCol_HeaderActive] = accented(0.34f);
    c[ImGuiCol_Separator] = grey(0.2f);
    c[ImGuiCol_SeparatorHovered] = c[ImGuiCol_SeparatorActive] = accented(0.7f);
    c[ImGuiCol_ResizeGrip] = c[ImGuiCol_ResizeGripHovered] = c[ImGuiCol_ResizeGripActive] = {0, 0, 0, 0};
    c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = grey(0.125f);
    c[ImGuiCol_TabHovered] = grey(0.24f);
    c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = grey(0.21f);
    c[ImGuiCol_PlotHistogram] = accent;
    c[ImGuiCol_TextSelectedBg] = accented(0.4f);
    c[ImGuiCol_DragDropTarget] = ImGui::ColorConvertU32ToFloat4(tint::selected);
    c[ImGuiCol_NavHighlight] = accented(0.6f);
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.5f};
    c[ImGuiCol_TableBorderLight] = c[ImGuiCol_TableBorderStrong] = grey(0.2f);
}

}  // namespace

void dress(float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    fonts.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    addFont({"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
             "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"},
            15, scale);
    addFont({"/usr/share/fonts/truetype/hack/Hack-Regular.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"},
            14, scale);
    addFont({"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
             "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"},
            15, scale);
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowPadding = {10, 8};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 14;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 8;
    style.WindowRounding = style.ChildRounding = 0;
    style.FrameRounding = style.GrabRounding = style.TabRounding = style.PopupRounding = 4;
    style.ScrollbarRounding = 6;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.TabBorderSize = 0;
    style.ScaleAllSizes(scale);
    color();
}

ImFont* codeFont() { return ImGui::GetIO().Fonts->Fonts[1]; }
ImFont* strongFont() { return ImGui::GetIO().Fonts->Fonts[2]; }

}  // namespace sgm::window
