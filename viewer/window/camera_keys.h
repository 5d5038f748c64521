// Keys that move the camera: W A S D Q E and K, by the motion that is chosen.
// Enters: the workbench. Leaves: its camera moved. Assumes a frame of ImGui in which no text takes keys.
#pragma once

#include "viewer/window/workbench.h"

namespace sgm::window {

/// Moves the camera by the keys that are held. A key that the grammar gives a parameter is the grammar's.
void cameraKeys(Workbench& bench);

}  // namespace sgm::window
