// What can be known of a grammar's derivations before any is run.
// Enters: a checked Grammar. Leaves: warnings and errors. Assumes nothing about parameters: what one of their values
// could prevent isn't proven.
#pragma once

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// Warns of rules of the main file that no start can reach.
void findUnreachable(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Refuses reachable rules that never end: whose symbol always makes another live one of its kind, with no guard,
/// repeat, choice, or joint that could run out to stop it.
void findEndless(const Grammar& grammar, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
