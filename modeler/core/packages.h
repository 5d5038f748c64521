// The packages that a build may leave out.
// Enters: nothing. Leaves: which are there. Assumes the options of CMakeLists.txt: SGM_OPENVDB, SGM_CGAL, SGM_WINDOW.
#pragma once

#include <string>

#include "modeler/core/result.h"

namespace sgm {

enum class Package {
    OpenVdb,  ///< level sets, fog and surveys of caves
    Cgal,     ///< simplification and validation of meshes, straight skeletons
    Window,   ///< the program sgm-viewer, with GLFW, Dear ImGui and FreeType
};

/// Whether the package is part of this build.
bool isBuiltWith(Package package);

/// Error::Input that says which option left the package out: "`subject` needs CGAL: this sgm was built without it
/// (SGM_CGAL=OFF)".
Error missingPackage(Package package, const std::string& subject);

}  // namespace sgm
