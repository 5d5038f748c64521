// What can be known of a grammar's derivations before any is run.
// Enters: a checked Grammar. Leaves: warnings and errors. Assumes nothing about parameters: what one of their values
// could prevent isn't proven.
#pragma once

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// Warns of rules of the main file that no start can reach.
void findUnreachable(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of rules of the main file that another rule for their symbol shadows: one whose condition always holds comes
/// first; and of `beside` rules that a rule without a condition is drawn against.
void findShadowed(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of shares (%) at the first shapes of a start, which have no scope but the start's own of 1 m.
void findSharesOfNothing(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of solids that join the first shape of a start, which has a size, without one of their own: they are 1 m.
void findUnsized(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of roofs in rules of the main file that join a shape with a plan or a size of its own, and have none: they
/// stand over the whole scope, not over that shape.
void findRoofsOverTheScope(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of heights in sizes behind shapes that do nothing: roofs that grow on others are as high as their pitch makes
/// them, shapes between two points as long as these are apart.
void findUnusedHeights(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of weights of rules of the main file that a condition chooses, not chance.
void findUnusedWeights(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of rules of the main file whose `repeat` makes one solid and goes on from it: the next step replaces it.
void findReplacingSteps(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Warns of symbols that wait for each other by `after`: nothing decides which comes first. Once a cycle.
void findWaitingCycles(const Grammar& grammar, syntax::Diagnostics& diagnostics);

/// Refuses reachable rules that never end: whose symbol always makes another live one of its kind, with no guard,
/// repeat, choice, or joint that could run out to stop it.
void findEndless(const Grammar& grammar, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
