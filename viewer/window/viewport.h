// The view itself: pictures of field and mesh, camera control, picking, joints and bonds.
// Enters: the workbench. Leaves: the view in the present ImGui window. Assumes a frame of ImGui.
#pragma once

#include "viewer/window/workbench.h"

namespace sgm::window {

/// Fills the rest of the present ImGui window.
void viewport(Workbench& bench);

/// Keys of the view: frames, standard views, panes. Call once a frame, when no text takes keys.
void viewKeys(Workbench& bench);

}  // namespace sgm::window
