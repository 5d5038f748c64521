// Where the camera of a workbench looks.
// Enters: a workbench with its model. Leaves: an orbit around all of it or a part, and how its mesh is drawn.
#pragma once

#include "viewer/window/workbench.h"

namespace sgm::window {

/// Of the model, metres.
Box3d bounds(const Workbench& bench);
/// Bounds of a shape and all below it, metres.
Box3d boundsOf(const Workbench& bench, derive::ShapeId shape);
void frameAll(Workbench& bench);
/// All, where nothing is selected.
void frameSelection(Workbench& bench);
/// How the mesh is drawn, with the section where one is shown.
render::MeshStyle meshStyle(const Workbench& bench);
/// The height of the model's ground below a place, metres; nothing where there is none.
std::optional<double> groundBelow(const Workbench& bench, Vec3d from);

}  // namespace sgm::window
