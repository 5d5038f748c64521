# Writes OUTPUT, a .cpp with the text of every file in INPUTS, so that the programs need no shader files at run time.
set(entries "")
foreach(file ${INPUTS})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "    if (name == \"${name}\") return R\"glsl(${text})glsl\";\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"viewer/render/shader_text.h\"

namespace sgm::render {

std::string_view shaderPart(std::string_view name) {
${entries}    return {};
}

}  // namespace sgm::render
")
