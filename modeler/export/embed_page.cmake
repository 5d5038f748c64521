# Writes OUTPUT, a .cpp with the text of page/page.html, its styles and scripts inside, so that the programs need no files at
# run time. INPUTS are the scripts in their order.
file(READ ${FOLDER}/page.html page)
file(READ ${FOLDER}/page.css style)
set(script "")
foreach(file ${INPUTS})
  file(READ ${file} text)
  string(APPEND script "${text}\n")
endforeach()
string(REPLACE "@STYLE@" "${style}" page "${page}")
string(REPLACE "@SCRIPT@" "${script}" page "${page}")
file(WRITE ${OUTPUT} "#include \"modeler/export/page_text.h\"

namespace sgm::exporter {

std::string_view pageText() { return R\"page(${page})page\"; }

}  // namespace sgm::exporter
")
