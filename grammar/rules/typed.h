// A checked expression with what it will be.
// Enters: nothing. Leaves: what the checks of expressions hand to each other. Assumes type.h.
#pragma once

#include <utility>

#include "grammar/rules/make.h"
#include "grammar/rules/type.h"

namespace sgm::rules {

/// A value with what it will be.
struct Typed {
    Expr expr;
    Type type;
};

inline Typed makeTyped(SourceSpan span, Value value) {
    const Type type = Type::of(value);
    return {makeConstant(span, std::move(value)), type};
}

}  // namespace sgm::rules
