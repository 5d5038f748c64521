// Expressions that depend on the place in the plan: maps, bumps, noise, means.
// Enters: a checked Expr and where it stands. Leaves: values. Assumes kinds as `check` left them.
#pragma once

#include "grammar/derive/expressions.h"

namespace sgm::derive {

/// bump and fbm at the middle of the scope.
rules::Value ofPlace(rules::Fn fn, const rules::Expr& expr, const Place& place);
/// The value of a map where the shape stands; a failure in objects that `place` puts. A formula's depth is bounded by
/// the number of maps: each evaluates those above it.
rules::Value ofMap(const rules::Expr& expr, const Place& place);
/// Whether a map of classes says a word where the shape stands, for 'map == word', which plans ask at a hundred
/// thousand places; nothing for other expressions.
std::optional<bool> isOfClass(const rules::Expr& comparison, const Place& place);
/// The mean of what an expression says over the scope's plan, by a lattice of places about its middle.
rules::Value meanOf(const rules::Expr& value, const Place& place);

}  // namespace sgm::derive
