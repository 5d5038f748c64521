// The shaders' text, built into the library from viewer/shaders/.
// Enters: names of parts (file names up to the first dot). Leaves: GLSL.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace sgm::viewer {

/// The text of shaders/NAME.glsl or shaders/NAME.STAGE.glsl; empty when there is none.
std::string_view shaderPart(std::string_view name);

/// A whole shader: the version line, `head`, then the parts in order.
inline std::string composeShader(const std::string& head, std::initializer_list<std::string_view> parts) {
    std::string text = "#version 430 core\n" + head;
    for (const std::string_view part : parts) text.append(shaderPart(part)).append("\n");
    return text;
}

}  // namespace sgm::viewer
