// The GLSL value: an op's body as shader text.
// Enters: operands as GLSL expressions. Leaves: statements that name every intermediate once, and the result's
// expression. Assumes GLSL 3.30 or later. Integers are missing: rows that need them are variadic and bring their own
// text.
#pragma once

#include <charconv>
#include <string>

namespace sgm::eval {

/// The statements so far; temporaries are t0, t1, …
struct GlslBody {
    std::string text;
    int temporaries = 0;

    /// Stores an expression in a new temporary and gives its name.
    std::string store(const char* type, const std::string& expression) {
        const std::string name = std::string("t").append(std::to_string(temporaries++));
        text += std::string(type) + " " + name + " = " + expression + "; ";
        return name;
    }
};

/// A boolean expression.
struct GlslMask {
    std::string expression;
    GlslBody* body = nullptr;

    friend GlslMask operator&(const GlslMask& a, const GlslMask& b) {
        return {"(" + a.expression + " && " + b.expression + ")", a.body};
    }
    friend GlslMask operator|(const GlslMask& a, const GlslMask& b) {
        return {"(" + a.expression + " || " + b.expression + ")", a.body};
    }
    friend GlslMask operator!(const GlslMask& a) { return {"(!" + a.expression + ")", a.body}; }
};

/// A float expression: a constant (no body) or a name whose statements are in `body`.
struct GlslText {
    using Mask = GlslMask;

    std::string expression;
    GlslBody* body = nullptr;

    GlslText(float value) : expression(number(value)) {}
    GlslText(std::string text, GlslBody* into) : expression(std::move(text)), body(into) {}

    friend GlslText operator+(const GlslText& a, const GlslText& b) { return infix(a, " + ", b); }
    friend GlslText operator-(const GlslText& a, const GlslText& b) { return infix(a, " - ", b); }
    friend GlslText operator*(const GlslText& a, const GlslText& b) { return infix(a, " * ", b); }
    friend GlslText operator/(const GlslText& a, const GlslText& b) { return infix(a, " / ", b); }
    friend GlslText operator-(const GlslText& a) { return a.stored("-" + a.expression); }
    friend GlslMask operator<(const GlslText& a, const GlslText& b) { return compare(a, " < ", b); }
    friend GlslMask operator<=(const GlslText& a, const GlslText& b) { return compare(a, " <= ", b); }
    friend GlslMask operator>(const GlslText& a, const GlslText& b) { return compare(a, " > ", b); }
    friend GlslMask operator>=(const GlslText& a, const GlslText& b) { return compare(a, " >= ", b); }
    friend GlslText min(const GlslText& a, const GlslText& b) { return call("min", a, b); }
    friend GlslText max(const GlslText& a, const GlslText& b) { return call("max", a, b); }
    friend GlslText abs(const GlslText& a) { return a.stored("abs(" + a.expression + ")"); }
    friend GlslText sqrt(const GlslText& a) { return a.stored("sqrt(" + a.expression + ")"); }
    friend GlslText floor(const GlslText& a) { return a.stored("floor(" + a.expression + ")"); }
    friend GlslText powerOfTwo(const GlslText& a) { return a.stored("exp2(" + a.expression + ")"); }
    friend GlslText select(const GlslMask& m, const GlslText& a, const GlslText& b) {
        const GlslText into{"", m.body};
        return into.stored("(" + m.expression + " ? " + a.expression + " : " + b.expression + ")");
    }

private:
    /// The shortest decimal that reads back as the same float.
    static std::string number(float value) {
        char digits[48];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        std::string s(digits, end);
        if (s.find_first_of(".e") == std::string::npos) s += ".0";
        return value < 0 ? "(" + s + ")" : s;
    }
    GlslText stored(const std::string& text) const {
        return body ? GlslText(body->store("float", text), body) : GlslText("(" + text + ")", nullptr);
    }
    static GlslBody* bodyOf(const GlslText& a, const GlslText& b) { return a.body ? a.body : b.body; }
    static GlslText infix(const GlslText& a, const char* sign, const GlslText& b) {
        return GlslText("", bodyOf(a, b)).stored(a.expression + sign + b.expression);
    }
    static GlslText call(const std::string& name, const GlslText& a, const GlslText& b) {
        return GlslText("", bodyOf(a, b)).stored(name + "(" + a.expression + ", " + b.expression + ")");
    }
    static GlslMask compare(const GlslText& a, const char* sign, const GlslText& b) {
        return {"(" + a.expression + sign + b.expression + ")", bodyOf(a, b)};
    }
};

}  // namespace sgm::eval
