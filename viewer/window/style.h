// How the window looks: fonts and colours.
// Enters: the screen's scale. Leaves: ImGui's style. Assumes a current ImGui context before its first frame.
#pragma once

#include <imgui.h>

namespace sgm::window {

/// Sets fonts, sizes and colours; `scale` is 1 for some 96 dots an inch.
void dress(float scale);

/// The font of code, of the same height as the other.
ImFont* codeFont();
/// For headings and what is stressed.
ImFont* strongFont();

/// Colours with a meaning, the same in every panel.
namespace tint {
inline constexpr ImU32 faint = IM_COL32(128, 134, 144, 255);
inline constexpr ImU32 text = IM_COL32(222, 225, 230, 255);
inline constexpr ImU32 accent = IM_COL32(92, 158, 224, 255);
inline constexpr ImU32 selected = IM_COL32(255, 184, 77, 255);
inline constexpr ImU32 error = IM_COL32(235, 104, 92, 255);
inline constexpr ImU32 warning = IM_COL32(226, 178, 84, 255);
inline constexpr ImU32 good = IM_COL32(122, 190, 130, 255);
inline constexpr ImU32 terminal = IM_COL32(226, 102, 88, 255);  ///< figure 1 of the SG-M paper
inline constexpr ImU32 nonTerminal = IM_COL32(98, 152, 226, 255);
}  // namespace tint

}  // namespace sgm::window
