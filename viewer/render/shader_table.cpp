#include "viewer/render/shader_text.h"

namespace sgm::render {

const std::vector<Shader>& shaders() {
    static const std::vector<Shader> table{
        {"trace", "comp", true, {"view", "sky", "light", "ground", "cells", "jobs", "trace"}},
        {"surface", "comp", true, {"view", "sky", "light", "ground", "cells", "jobs", "surface"}},
        {"shade", "comp", false, {"view", "sky", "light", "ground", "tonemap", "jobs", "shade"}},
        {"fog", "comp", false, {"view", "sky", "light", "ground", "tonemap", "jobs", "fog"}},
        {"evaluate", "comp", true, {"evaluate"}},
        {"corners", "comp", true, {"corners"}},
        {"triangles", "comp", false, {"triangles"}},
        {"mesh", "vert", false, {"mesh"}},
        {"screen", "vert", false, {"screen"}},
        {"crease", "vert", false, {"crease"}},
        {"crease_color", "frag", false, {"crease_color"}},
        {"position", "frag", false, {"position"}},
        {"depth", "frag", false, {"depth"}},
        {"mask", "frag", false, {"mask"}},
        {"encode", "frag", false, {"encode"}},
        {"blur_depth", "frag", false, {"blur_depth"}},
        {"mesh_color",
         "frag",
         false,
         {"view", "sky", "light", "ground", "tonemap", "visibility", "whole", "mesh_color"}},
        {"mesh_section",
         "frag",
         false,
         {"view", "sky", "light", "ground", "tonemap", "visibility", "section", "mesh_color"}},
        {"backdrop", "frag", false, {"view", "sky", "light", "ground", "tonemap", "visibility", "backdrop"}},
    };
    return table;
}

std::string shaderText(std::string_view name, const std::string& interpreter) {
    std::string text = "#version 430 core\n";
    for (const Shader& shader : shaders()) {
        if (shader.name != name) continue;
        if (shader.interprets) text += interpreter;
        for (const std::string_view part : shader.parts) text.append(shaderPart(part)).append("\n");
    }
    return text;
}

}  // namespace sgm::render
