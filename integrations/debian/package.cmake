# The Debian package, by `cpack -G DEB` in the build folder or `./run.sh package out deb`.
set(CPACK_PACKAGE_NAME sgm)
set(CPACK_PACKAGE_VENDOR "the authors of sgm")
set(CPACK_PACKAGE_CONTACT "the authors of sgm <sgm@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "shape-grammar and morphing implicit modeler")
set(CPACK_PACKAGE_DESCRIPTION "A grammar's rules grow a tree of shapes that meet at joints; the tree becomes one implicit field; the \
field becomes a picture at once, and a closed mesh or a volume that other programs take without repair. Caves, clouds, \
buildings and towns.\n.\nThe package holds the programs sgm and sgm-viewer, the library with its headers, the standard library \
of grammars, and examples.")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_MONOLITHIC_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libgl1-mesa-dri, fonts-roboto-unhinted, fonts-hack-ttf")
include(CPack)
