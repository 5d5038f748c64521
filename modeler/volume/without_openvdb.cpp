// load_plugin.cpp in a build without OpenVDB.
#include "modeler/core/packages.h"
#include "modeler/volume/plugin_functions.h"

namespace sgm::volume {

Result<const PluginFunctions*> loadPlugin() { return missingPackage(Package::OpenVdb, "a volume"); }

}  // namespace sgm::volume
