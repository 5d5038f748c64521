// The functions of this module that need OpenVDB, as one table.
// Enters: nothing. Leaves: their addresses. `sgm` and the window read it from a module, loaded when they first need a
// volume (on_demand.cpp), for binding OpenVDB's 70,000 symbols takes longer than most of what sgm is asked for; tests
// and bench link the functions themselves.
#pragma once

#include "modeler/volume/air.h"
#include "modeler/volume/dense.h"
#include "modeler/volume/fog.h"
#include "modeler/volume/keep.h"
#include "modeler/volume/renormalize.h"
#include "modeler/volume/volume.h"

namespace sgm::volume {

/// See the functions of these names.
struct PluginFunctions {
    decltype(&volume::airOf) airOf;
    decltype(&volume::dense) dense;
    decltype(&volume::fillVdb) fillVdb;
    decltype(&volume::fog) fog;
    decltype(&volume::keepOnly) keepOnly;
    decltype(&volume::renormalize) renormalize;
    decltype(&volume::sample) sample;
    /// Has TBB start its threads, at most so many, while there is room for them: later it ends the program where it
    /// gets none.
    void (*startThreads)(int most);
};

/// Loads the module and gives its table. Error::Internal where the module or OpenVDB isn't to be found, Error::Budget
/// where there are no threads, Error::Input in a build without OpenVDB.
Result<const PluginFunctions*> loadPlugin();

}  // namespace sgm::volume

/// The module's table.
extern "C" const sgm::volume::PluginFunctions sgm_volume_functions;
