// Checks of expressions: names found, units compared, constants folded.
// Enters: written expressions and their Place. Leaves: checked ones with their types, and diagnostics.
// For this folder's sources alone; operations call OperationChecker.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "grammar/rules/check_context.h"
#include "grammar/rules/functions.h"
#include "grammar/rules/place.h"

namespace sgm::rules {

/// A value of any kind.
Typed checkExpression(CheckContext& ctx, Place& place, const syntax::Expr& e);
/// A value that fits `want`; `what` names what takes it in messages.
Expr checkExpression(CheckContext& ctx, Place& place, const syntax::Expr& e, Want want, std::string_view what);
/// A plain value: no parameters, no shape, no chance. Where `word` holds, a name stands for itself.
std::optional<Value> plainValue(CheckContext& ctx, const syntax::Expr& e, bool word);
/// A measure of the scope, one number or three. One that mixes shares and lengths is another along each axis.
Expr checkMeasure(CheckContext& ctx, Place& place, const syntax::Expr& e, Want want, std::string_view what);

// expect.cpp
/// Reports an error; what it gives is of no known type.
Typed fail(CheckContext& ctx, SourceSpan span, std::string message, std::string hint = {});
/// Reports an unknown name, but for one that may be declared in what couldn't be read.
Typed failUnknown(CheckContext& ctx, SourceSpan span, const std::string& word, std::string message,
                  std::string hint = {});
/// `kind` over `args`, folded where everything is constant; its type is that of the samples.
Typed makeApplied(CheckContext& ctx, Expr::Kind kind, Fn fn, SourceSpan span, std::vector<Typed> args);
/// Whether units of these may differ while deriving: one isn't known, and another isn't a plain number, which meets
/// all.
bool mayDiffer(std::span<const Type> types);
/// Reports two values that can't be added or compared, as `verb` says.
bool sameType(CheckContext& ctx, const Typed& a, const Typed& b, std::string_view verb);
/// Reports a value that doesn't fit `want`.
bool expectType(CheckContext& ctx, const Typed& value, Want want, std::string_view what, const syntax::Expr* written);

// operators.cpp
Typed checkCall(CheckContext& ctx, Place& place, const syntax::Expr& e);
Typed checkUnary(CheckContext& ctx, Place& place, const syntax::Expr& e);
Typed checkBinary(CheckContext& ctx, Place& place, const syntax::Expr& e);

// chance.cpp
Typed checkRange(CheckContext& ctx, Place& place, const syntax::Expr& e);
Typed checkRamp(CheckContext& ctx, Place& place, const syntax::Expr& e);
Typed checkChoice(CheckContext& ctx, Place& place, const syntax::Expr& e);
/// A draw of this attribute's own, without its arguments.
Expr makeDraw(Place& place, const syntax::Expr& e);
/// The number that counts the turns of the repetition around a `choose distinct` or `choose shuffled`; null, with a
/// message, where there is none.
const Place::Local* findCounter(CheckContext& ctx, const Place& place, SourceSpan span, std::string_view word,
                                size_t alternatives);
Expr checkWeight(CheckContext& ctx, Place& place, const syntax::Expr& e);
/// Refuses weights that are 0 whatever the parameters are.
void checkWeights(CheckContext& ctx, const std::vector<const Expr*>& weights, SourceSpan span);

// measures.cpp
/// A constant of the file, in its place.
Typed checkConstant(CheckContext& ctx, Place& place, const syntax::Expr& e, Constant& constant);
/// One of two numbers becomes metres where it is a share of the scope and the other a length: 100% - 1m. What another
/// shape set by `with` is found to be one or the other where it is read.
bool mixShares(Place& place, Typed& a, Typed& b);

// maps.cpp
/// The value of a map where the shape stands.
Typed checkMapName(CheckContext& ctx, Place& place, const syntax::Expr& e, uint32_t index);
/// mean(people): over the plan of the shape's scope.
Typed checkMean(CheckContext& ctx, Place& place, const syntax::Expr& e);

}  // namespace sgm::rules
