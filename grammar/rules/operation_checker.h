// What the `check` of an operation works with: the checker's services at one spot of a body.
// Enters: written arguments. Leaves: attributes of one element, and diagnostics. Assumes it lives while its element is
// checked.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/rules/grammar.h"
#include "grammar/rules/type.h"

namespace sgm::rules {

class Checker;
struct Place;
struct Typed;

class OperationChecker {
public:
    OperationChecker(Checker& checker, Place& place, Element& element, std::vector<Attribute>& attributes)
        : checker_(checker), place_(place), element_(element), attributes_(attributes) {}

    /// The element that the operation is said of; its content and `live` are known in `agree` alone.
    Element& element() { return element_; }
    const Grammar& grammar() const;
    /// In the body of a rule with `repeat`; behind its `finally`.
    bool isInChain() const;
    bool isInFinally() const;

    /// Every argument as its type asks, numbers within the operation's range: what an operation without `check` gets.
    void checkArguments(const syntax::Attribute& written);
    /// Adds an attribute to the element.
    void add(Attribute attribute) { attributes_.push_back(std::move(attribute)); }
    /// What `operation` was said so far of the element, or null.
    Attribute* find(const Operation& operation);

    /// Names the draws of the ranges in what is checked next: the same name at the same shape draws the same numbers.
    void beginDraws(std::string name);
    /// A checked expression that fits `want`; `what` names it in a message.
    Expr expression(const syntax::Expr& e, Want want, std::string_view what);
    /// The same of a measure along an axis of the scope (0 … 2), in which shares and lengths may meet: 100% - 1m.
    Expr measure(const syntax::Expr& e, Want want, std::string_view what, int axis);
    /// A point of the scope: three measures, each along its axis.
    Expr point(const syntax::Expr& e, std::string_view what);
    /// The body of a part of the scope. One that begins by cutting a shape further up stands in a group that holds
    /// nothing else; any other operator is refused.
    std::shared_ptr<const Body> partBody(const syntax::Body& written);
    /// A `material` by name, or a value that holds one.
    Expr material(const syntax::Expr& e);
    Typed value(const syntax::Expr& e);
    Solid solid(const syntax::Expr& e);
    /// A joint by name, or a value that is a direction.
    Expr joint(const syntax::Expr& e);
    std::shared_ptr<const Body> body(const syntax::Body& written);
    /// The body of something that runs several times, in sight of a whole number `name` whose local is `local`.
    template <class Check>
    void withLocal(const std::string& name, uint32_t& local, Check&& check) {
        const size_t outside = pushLocal(name, local);
        check();
        popLocals(outside);
    }

    /// The value at the defaults of all parameters, or nothing where a shape, a local or chance decides.
    std::optional<Value> atDefaults(const Expr& e) const;
    /// Refuses a constant that a primitive's parameter can't take.
    void checkRange(const Expr& e, const field::Primitive& row, size_t parameter);
    static Solid solidOfRow(SourceSpan span, const field::Primitive& row);

    /// The place in Grammar::outlines of the file that `name` (a text) stands for, read here; nothing after an error.
    std::optional<uint32_t> readOutlines(const syntax::Expr& name);
    /// The place in Grammar::images of the picture that `name` (a text) stands for, read here; nothing after an error.
    std::optional<uint32_t> readImage(const syntax::Expr& name);
    /// The symbol of the start of that name, wherever in the text it stands; nothing after an error.
    std::optional<SymbolId> findStart(const syntax::Expr& name);
    /// A parameter by index and a value for it, which may depend on the shape; nothing after an error.
    std::optional<std::pair<uint32_t, Expr>> setting(const syntax::Setting& written);
    /// The index of an lsystem of the grammar.
    std::optional<uint32_t> findLsystem(std::string_view name) const;
    /// The index of `roads` of the grammar.
    std::optional<uint32_t> findRoads(std::string_view name) const;
    std::optional<SymbolId> findSymbol(std::string_view name) const;
    /// The index in Grammar::reports of a name that `value` is reported under; nothing after an error.
    std::optional<uint32_t> report(const syntax::Expr& name, const Typed& value);
    bool isParameter(std::string_view name) const;
    /// True when some terminal or primitive declares a joint of that name.
    bool isJoint(std::string_view name) const;
    /// "did you mean 'x'?", or "".
    std::string nearest(std::string_view word, const std::vector<std::string>& candidates) const;
    std::vector<std::string> symbolNames() const;

    void error(SourceSpan span, std::string message, std::string fix = {});
    /// An error about a name, silent where the name stands in a text that could not be read.
    void unknownName(SourceSpan span, const std::string& name, std::string message, std::string fix = {});
    /// True when nothing should be said of a name, since its declaration could not be read.
    bool areErrorsSuppressed(const std::string& name) const;
    size_t problemCount() const;

private:
    size_t pushLocal(const std::string& name, uint32_t& local);
    void popLocals(size_t outside);

    Checker& checker_;
    Place& place_;
    Element& element_;
    std::vector<Attribute>& attributes_;
};

}  // namespace sgm::rules
