// The letters of an L-system, pass by pass, and the way that its turtle goes: what the Step panel shows.
// Enters: a shown model. Leaves: letters and steps on a plane. Assumes that the model's derivation read the L-system:
// its letters are drawn by the stream of the first shape that did.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/derive/lsystem.h"
#include "viewer/document/session.h"

namespace sgm::document {

/// A point of a drawing, metres.
struct DrawnPoint {
    double right = 0, up = 0;
};
/// A step of the turtle in the plane that shows it best: the plan, with −z up, or seen from the front where it rises.
struct LetterStep {
    uint32_t at = 0;  ///< index of its letter
    DrawnPoint from, to;
};

/// An L-system after some passes.
struct LettersShown {
    uint32_t lsystem = 0;  ///< index into Grammar::lsystems
    uint32_t passes = 0;   ///< made
    uint32_t all = 0;      ///< passes that the model makes
    derive::Letters letters;
    std::vector<LetterStep> steps;  ///< those that draw something, in order
};

/// The L-systems that the model read, by index in Grammar::lsystems, in the order they were met.
std::vector<uint32_t> lettersRead(const BuiltModel& shown);
/// The letters after at most `passes` passes. Error::Input where the model didn't read that L-system; Error::Budget as
/// derive::rewritten.
Result<LettersShown> lettersAfter(const BuiltModel& shown, uint32_t lsystem, uint32_t passes);
/// Letters from `begin` on, `count` at most, with their numbers as the language writes them: "F(2.5) [+ L]".
std::string textOf(const derive::Letters& letters, size_t begin, size_t count);

}  // namespace sgm::document
