// Selecting by the text, the view and the problems.
// Enters: a place in the text or the view. Leaves: a selection of the workbench, or what its panels show next.
#pragma once

#include "viewer/window/workbench.h"

namespace sgm::window {

/// Selects a row of the document's rules and what it made; asked again for the same, the next of several.
void selectRow(Workbench& bench, const document::RuleRow& row);
/// The same for the smallest row that the text at this byte belongs to; nothing outside starts and rules.
void selectText(Workbench& bench, uint32_t offset);
/// Shows the line of the document that a problem is in.
void revealPlace(Workbench& bench, const document::Problem& problem);
/// What the pointer is over; nothing where that is no shape of the model.
std::optional<Hover> hoverOf(const Workbench& bench, const Pick& pick);
/// Joins a shape at a joint of another: what dropping it there asks for.
void attach(Workbench& bench, derive::ShapeId moved, derive::ShapeId host, uint32_t joint);

}  // namespace sgm::window
