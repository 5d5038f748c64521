// The shaders' text, built into the library from viewer/render/shaders/.
// Enters: the name of a shader. Leaves: GLSL, composed of named parts that field and mesh share.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sgm::render {

/// The text of shaders/NAME.glsl or shaders/NAME.STAGE.glsl; empty when there is none.
std::string_view shaderPart(std::string_view name);

/// One whole shader and what it is made of.
struct Shader {
    std::string_view name;
    std::string_view stage;  ///< comp, vert or frag, as the tools' file endings say
    bool interprets;         ///< starts with the field interpreter
    std::vector<std::string_view> parts;
};

/// Every shader of the viewer.
const std::vector<Shader>& shaders();

/// The source of a shader: the version line, `interpreter` where it takes one, then its parts.
std::string shaderText(std::string_view name, const std::string& interpreter = {});

}  // namespace sgm::render
