// L-systems: parallel rewriting, and turtles that read the string.
// Enters: a checked L-system, parameters and a stream. Leaves: letters, outlines and steps in space. Assumes letters of
// one byte. Sources: P. Prusinkiewicz, A. Lindenmayer, "The Algorithmic Beauty of Plants", 1990, chapter 1; the
// building letters are those of "Building Generation with 3D L-System" (docs/papers.md, paper L).
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "grammar/derive/expressions.h"
#include "modeler/plan/polygon.h"

namespace sgm::derive {

/// Letters after all passes; letter i has the numbers from[i] … from[i + 1].
struct Letters {
    std::string text;
    std::vector<uint32_t> from;
    std::vector<double> numbers;
    std::vector<uint64_t> keys;  ///< by letter: the way of productions that made it
    std::span<const double> of(size_t i) const { return {numbers.data() + from[i], from[i + 1] - from[i]}; }
};

/// The string after all passes. A production applies where its letter, the letters beside it, how many numbers it has
/// and its condition agree; among several one is drawn by weight. Letters beside one are looked for past the turtle's
/// commands and past branches. Each letter draws by the productions above it, so that a change of one production leaves
/// the draws of the others. Passes beyond `mostPasses` aren't made. Error::Budget when it has more than `mostLetters`.
inline constexpr size_t mostLetters = 4'000'000;
Result<Letters> rewritten(const rules::Lsystem& lsystem, const Place& place,
                          double mostPasses = std::numeric_limits<double>::infinity());

/// The outline that the turtle walks, from (0, 0) along +x: F and G step and draw an edge, f and g step without drawing
/// and begin another outline, + and - turn left and right by the angle, | turns round, [ and ] keep and recall where it
/// stands; other letters become words of the tag of the edge before them. Outlines are closed from their end to their
/// start, and resolved where they cross themselves. Error::Input where no outline has an area, Error::Budget for more
/// than `mostWalls`, whose crossings would take minutes.
inline constexpr int64_t mostWalls = 20'000;
Result<plan::Footprint> drawOutline(const rules::Lsystem& lsystem, const Place& place);
/// What lies within half of `width_m` of the walls that the turtle draws, branches included.
Result<plan::Footprint> drawWalls(const rules::Lsystem& lsystem, const Place& place, double width_m);

/// A letter as the turtle in space met it.
struct TurtleStep {
    char letter = 'F';
    uint32_t at = 0;  ///< its index among the letters
    uint64_t key = 0;
    Vec3d from, to;           ///< the same where the letter draws no step
    Vec3d heading, left, up;  ///< unit, square to each other
    double width_m = 0;
};
/// All letters but commands, in order, from the origin: along +x with y up, or upward (`rises`). Beside the letters of
/// outlines & and ^ pitch down and up, \\ and / roll, $ rolls level, ! sets the width (without a number by 10 % less),
/// % cuts off what is left of a branch. O(letters).
std::vector<TurtleStep> walk(const rules::Lsystem& lsystem, const Letters& letters, const Place& place, bool rises,
                             double width_m);

}  // namespace sgm::derive
