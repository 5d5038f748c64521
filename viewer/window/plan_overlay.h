// The plan of a town over the view: roads, blocks, lots, waters and parks as lines.
// Enters: the workbench. Leaves: lines in ImGui's draw list. Assumes a frame of ImGui.
#pragma once

#include <imgui.h>

namespace sgm::window {

class Workbench;
struct Projection;

/// A switch for the plan, where the model is a town. False, with nothing drawn, where it has none.
bool choosePlan(Workbench& bench);
/// The newest plan, at the height of the ground; while a slider is dragged it is there before the buildings.
void drawPlan(Workbench& bench, const Projection& project, ImDrawList& list);

}  // namespace sgm::window
