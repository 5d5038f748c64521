// L-systems that draw plans: parallel rewriting, and a turtle that reads the string.
// Enters: a checked L-system, parameters and a stream. Leaves: strings and outlines. Assumes letters of one byte.
// Sources: P. Prusinkiewicz, A. Lindenmayer, "The Algorithmic Beauty of Plants", 1990, chapter 1; the building letters
// are those of "Building Generation with 3D L-System" (docs/papers.md, paper L).
#pragma once

#include "grammar/derive/expressions.h"
#include "modeler/plan/polygon.h"

namespace sgm::derive {

/// The string after all passes. Each letter draws by the productions above it, so that a change of one production
/// leaves the draws of the others. Error::Budget when it has more than `mostLetters`.
inline constexpr size_t mostLetters = 4'000'000;
Result<std::string> rewritten(const rules::Lsystem& lsystem, const Place& place);

/// The outline that the turtle walks, from (0, 0) along +x: F and G step and draw an edge, f and g step without drawing
/// and begin another outline, + and - turn left and right by the angle, | turns round, [ and ] keep and recall where it
/// stands; other letters become words of the tag of the edge before them. Outlines are closed from their end to their
/// start, and resolved where they cross themselves. Error::Input where no outline has an area, Error::Budget for more
/// than `mostWalls`, whose crossings would take minutes.
inline constexpr int64_t mostWalls = 20'000;
Result<plan::Footprint> drawOutline(const rules::Lsystem& lsystem, const Place& place);

}  // namespace sgm::derive
