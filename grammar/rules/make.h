// Expressions and values made in place of written ones.
// Enters: a span and what stands there. Leaves: an Expr. Assumes the span is what a message should point at.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

inline Expr makeConstant(SourceSpan span, Value value) {
    Expr e;
    e.span = span;
    e.value = std::move(value);
    return e;
}

/// Stands for what was refused: it has no number that another check could complain about.
inline Expr makeUnreadable(SourceSpan span) {
    Expr e;
    e.kind = Expr::Kind::Local;
    e.span = span;
    return e;
}

inline Value makeWord(std::string text) {
    Value value;
    value.kind = Value::Kind::Word;
    value.text = std::move(text);
    return value;
}

/// 0 … 5 for +x −x +y −y +z −z, 6 for centre.
inline Value makeAxis(int axis) {
    Value value;
    value.kind = Value::Kind::Axis;
    value.n[0] = axis;
    return value;
}

inline Value makeWhole(double n) {
    Value value = Value::number(n);
    value.integer = true;
    return value;
}

/// `fn` over `args`, as a Unary, Binary or Call.
inline Expr makeCall(Expr::Kind kind, Fn fn, SourceSpan span, std::vector<Expr> args) {
    Expr e;
    e.kind = kind;
    e.span = span;
    e.index = static_cast<uint32_t>(fn);
    e.args = std::move(args);
    return e;
}

}  // namespace sgm::rules
