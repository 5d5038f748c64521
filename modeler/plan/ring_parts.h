// Parts of one ring, found without booleans: exact to rounding, and a tenth of their time.
// Enters: rings that don't cross themselves. Leaves: rings, or nothing where booleans are needed; `clipped` and
// `setback` take whichever does.
#pragma once

#include <optional>
#include <span>

#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// Whether the ring turns left alone. O(n).
bool isConvex(const Ring& ring);

/// Whether each side of the line dot(n, p) = at has one piece of the ring at most: it is convex, or crosses the line
/// twice or never and has no corner within 2 mm of it. O(n).
bool isCutOnce(const Ring& ring, Vec2 n, double at);

/// The part where dot(n, p) ≤ at of a ring that `isCutOnce` (Sutherland & Hodgman 1974); its new edge is `edge`. Points
/// nearer than a millimetre to the one before are left out. Fewer than three points where nothing is left. Both sides
/// of a cut, n and −n, get the same points. O(n).
Ring partBelow(const Ring& ring, Vec2 n, double at, Edge edge = {0, EdgeSource::Cut});

/// Where the lines of two edges with the unit directions `along` and `alongNext` cross when each is moved to its left
/// by its distance, metres, ≥ 0: from the corner between them. Nothing where that is farther off than four times the
/// larger distance.
std::optional<Vec2> cornerMovedIn(Vec2 along, Vec2 alongNext, double in_m, double inNext_m);

/// The ring with each edge moved to its left by its distance, metres, ≥ 0, one an edge. Of a convex ring, what all the
/// moved lines leave, fewer than three points where that is nothing; of others the corners of the moved lines, where
/// every edge keeps its direction and the moved ring doesn't cross itself. Nothing elsewhere, and where a corner has
/// no cornerMovedIn. O(n²) for convex rings, O(n log n) for others.
std::optional<Ring> movedIn(const Ring& ring, std::span<const double> distances_m);

}  // namespace sgm::plan
