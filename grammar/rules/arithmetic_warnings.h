// Values that a function takes and hardly anybody means: what the checker and a derivation warn of.
// Enters: a call and the values of its arguments. Leaves: a message with its fix.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "grammar/rules/grammar.h"
#include "grammar/rules/type.h"

namespace sgm::rules {

/// What is doubtful about a call, and where.
struct ArithmeticWarning {
    SourceSpan span;
    std::string message, hint;
};

/// The hint of a value beyond a range that is taken all the same.
inline constexpr const char* countsAsNearestEnd = "it counts as the nearest of both ends";

/// A division by 0, the square root of a negative number, a share of a colour beyond 0 … 1. `args` are the values of
/// the arguments of `call`, a Unary, Binary or Call.
std::optional<ArithmeticWarning> findArithmeticWarning(const Expr& call, std::span<const Value> args);

/// What is said of numbers that can't meet under `verb` ("add"), a share and a length: message and hint, at no place.
ArithmeticWarning unlikeNumbers(const Type& a, const Type& b, std::string_view verb);

/// Two numbers of different units under an operator, a function, a range or a ramp, which the checker couldn't know:
/// `args` are the values of its arguments.
std::optional<ArithmeticWarning> findUnlikeNumbers(const Expr& expr, std::span<const Value> args);

/// Says that a value is out of the range of a primitive's parameter, by its index; nothing where it is within.
std::optional<std::string> findOutOfRange(const field::Primitive& row, size_t parameter, const Value& value);

/// The first doubtful call within `e` where the parameters have these values; what they don't decide is left out, and
/// so is the branch of an `if` that isn't taken.
std::optional<ArithmeticWarning> findDoubtWithin(const Expr& e, std::span<const Value> params);

}  // namespace sgm::rules
