// Checks of what stands in bodies: solids, attributes, elements.
// Enters: written elements and their Place. Leaves: checked ones, and diagnostics. For this folder's sources alone;
// operations call OperationChecker.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grammar/rules/check_context.h"
#include "grammar/rules/place.h"

namespace sgm::rules {

Body checkBody(CheckContext& ctx, Place& place, const syntax::Body& written);

// attributes.cpp
/// Operations that speak of another one come last: it may stand behind them.
std::vector<Attribute> checkAttributes(CheckContext& ctx, Place& place, Element& element,
                                       const std::vector<syntax::Attribute>& written);
/// A `material` by name, or a value that holds one.
Expr checkMaterial(CheckContext& ctx, Place& place, const syntax::Expr& e);
/// A joint by name, or a value that is a direction: a local, or one that `with` sets.
Expr checkJoint(CheckContext& ctx, Place& place, const syntax::Expr& e);

// solids.cpp
Solid checkSolid(CheckContext& ctx, Place& place, const syntax::Expr& e);
/// The solid of a row of the table, every parameter at its default.
Solid solidOfRow(SourceSpan span, const field::Primitive& row);
/// The solid that a terminal stands for.
Solid terminalSolid(CheckContext& ctx, const syntax::Name& name);
/// Refuses a solid without an end; `verb` is what can't be done with it.
void expectBounded(CheckContext& ctx, const Solid& solid, std::string_view verb);
/// Refuses numbers that are known already and outside the parameter's range.
void checkParameterRange(CheckContext& ctx, const Expr& expr, const field::Primitive& row, size_t index);
/// How a solid of a name that is unknown may be written.
std::string hintForSolid(CheckContext& ctx, std::string_view word);

}  // namespace sgm::rules
