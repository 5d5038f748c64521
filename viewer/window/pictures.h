// Pictures of the view, written to files.
// Enters: a workbench. Leaves: files beside its document.
#pragma once

#include "viewer/window/workbench.h"

namespace sgm::window {

/// Asks for pictures from all around.
void startTurntable(Workbench& bench, int count);
/// Writes pictures that were asked for on a thread of their own, one after the other, once the view is whole. True when
/// the view moves on or a file is done. One that can't be written ends a turntable.
Result<bool> takePictures(Workbench& bench);

}  // namespace sgm::window
