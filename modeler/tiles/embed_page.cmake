# Writes OUTPUT, a .cpp with the page (PAGE) and its script, which BUNDLE makes in WORK, so that sgm needs no files at run time.
execute_process(COMMAND ${BUNDLE} ${WORK} ${WORK}/viewer.js COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PAGE} page)
file(READ ${WORK}/viewer.js script)
file(WRITE ${OUTPUT} "#include \"modeler/tiles/page.h\"

namespace sgm::tiles {

std::string_view pageText() { return R\"citypage(${page})citypage\"; }
std::string_view pageScript() { return R\"citypage(${script})citypage\"; }

}  // namespace sgm::tiles
")
