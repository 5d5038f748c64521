// What a parameter may be, and the table of parameters for panels and other programs.
// Enters: parameters and values. Leaves: values that fit, or a sentence that says why not. Assumes values of one kind
// and unit a parameter: its default decides, and where that is bare its range does.
#pragma once

#include <string>
#include <string_view>

#include "grammar/rules/grammar.h"
#include "modeler/core/result.h"

namespace sgm::rules {

/// Gives `param` its range, a number for every component; units of default and range are made the same.
/// Returns "" or why the range can't be.
std::string setRange(Param& param, const Value& lo, const Value& hi);

/// `value` as `param` takes it: a bare number gets the unit, one number counts for every component. Error::Input for a
/// wrong kind or unit, a value out of range, a fraction where whole numbers are asked for, or none of the choices.
Result<Value> conform(const Param& param, Value value);
/// `value` fitted to the parameter's kind and unit as by conform(); range and choices aren't looked at.
Result<Value> conformKind(const Param& param, Value value);

/// The style called `name` for the start with this index, else one of that name for any start, or null.
const Style* findStyle(const Grammar& grammar, const std::string& name, uint32_t start);

/// What the parameters are before the user changes any: their defaults, or what `style default` says for this start.
std::vector<Value> valuesOf(const Grammar& grammar, uint32_t start);

/// A component of a value as people read it: metres, degrees, percent.
double shown(const Value& value, size_t component);
/// "integer", "real", "vector", "choice", "color", "boolean", "text", "rotation", "axis".
std::string_view kindName(const Value& value);
/// "m", "deg", "%", "/m", or "".
std::string_view unitName(Unit unit);

/// The parameters as JSON for other programs' panels: a list of {name, kind (integer, real, vector, choice, color,
/// boolean, text), unit, default (for the first start), minimum, maximum, choices, label, group, key, file, line};
/// members that don't apply are left out. Lengths are in metres, angles in degrees, shares in percent, colours
/// "#rrggbb".
std::string paramsJson(const Grammar& grammar);

/// What a panel in another program shows of a grammar, as JSON: {parameters (as `paramsJson` lists them), starts,
/// styles, ways}. A start is {name, values}, where values are those of its `style default`; a style is {name, start
/// (where it is for one), values}, `style default` left out; a way is a name. Values are by the parameter's name,
/// written as in parameters.
std::string panelJson(const Grammar& grammar);

}  // namespace sgm::rules
