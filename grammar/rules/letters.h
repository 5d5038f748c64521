// The letters that an L-system may ever hold.
// Enters: a checked L-system. Leaves: letters, and warnings about productions for others. Assumes that every production
// is applied some time: conditions, neighbours and the count of passes are not looked at.
#pragma once

#include <cstddef>
#include <set>
#include <utility>

#include "grammar/rules/grammar.h"
#include "grammar/syntax/source.h"

namespace sgm::rules {

/// Letters of the axiom, and of all productions for letters so found: each with how many numbers it has. O(letters of
/// the text times productions).
std::set<std::pair<char, size_t>> lettersOf(const Lsystem& lsystem);

/// Whether `letter`, with whatever numbers, is among `letters`.
bool holdsLetter(const std::set<std::pair<char, size_t>>& letters, char letter);

/// Warns of productions for letters that never stand in the L-system.
void warnOfUnusedProductions(const Lsystem& lsystem, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
