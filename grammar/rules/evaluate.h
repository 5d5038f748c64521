// The meaning of the built-in functions, and the value of expressions that need no shape.
// Enters: values, or an Expr and parameter values. Leaves: a value. Assumes kinds and counts as `check` left them.
#pragma once

#include <optional>
#include <span>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// The unit of a product of two numbers: of two lengths it is an area; a share takes the other's unit. Of units whose
/// product has none (m² · m²) it is the first, which the checker refuses by `productHasUnit`.
Unit unitOfProduct(Unit a, Unit b);
/// Whether a product of such numbers is one that a grammar can measure: no m⁴, no square of an angle.
bool productHasUnit(Unit a, Unit b);

/// `fn` over `args`. Numbers act on every component of a vector; units follow (metre · plain = metre, metre / metre =
/// plain, share · metre = metre). Division and remainder by zero give 0, so that no value is ever infinite; `%` is the
/// floor remainder. A comparison of vectors is that of their first components, except == and !=. Fn::Count, Bump,
/// Fbm and Mean give 0.
Value applyFunction(Fn fn, std::span<const Value> args);

/// `vector[index]`: an Axis indexes 0 … 5, a number from 0; past the end gives the last component.
Value component(const Value& vector, const Value& index);
/// What a size says along an axis, 0 … 2: its component, or the one expression that counts for all three.
const Expr& sizeAlong(const Expr& size, size_t axis);

/// Numbers or vectors' components side by side: (a, b, c).
Value tuple(std::span<const Value> parts);

/// a + (b − a)·t, component by component; the unit is a's where it has one, else b's.
Value interpolate(const Value& a, const Value& b, double t);

/// The value of `expr`, or nothing when it depends on a shape, a local, a chain or chance. `params` are values by
/// index; empty: parameters count as unknown.
std::optional<Value> fold(const Expr& expr, std::span<const Value> params);

}  // namespace sgm::rules
