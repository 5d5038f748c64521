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
#include "grammar/rules/place.h"
#include "grammar/rules/type.h"
#include "grammar/rules/typed.h"

namespace sgm::rules {

struct CheckContext;
class FileTables;

/// What names mean where an operation stands.
class OperationNames {
public:
    explicit OperationNames(CheckContext& context) : context_(context) {}

    /// As findReferenced.
    std::optional<SymbolId> findSymbol(std::string_view name) const;
    /// The symbol of the start of that name, wherever in the text it stands; nothing after an error.
    std::optional<SymbolId> findStart(const syntax::Expr& name);
    /// The index of an lsystem of the grammar.
    std::optional<uint32_t> findLsystem(std::string_view name) const;
    /// The index of `roads` of the grammar.
    std::optional<uint32_t> findRoads(std::string_view name) const;
    bool isParameter(std::string_view name) const;
    /// True when some terminal or primitive declares a joint of that name.
    bool isJoint(std::string_view name) const;
    std::vector<std::string> symbols() const;
    /// True when nothing should be said of a name, since its declaration could not be read.
    bool areErrorsSuppressed(const std::string& name) const;

private:
    CheckContext& context_;
};

class OperationChecker {
public:
    OperationChecker(CheckContext& context, Place& place, Element& element, std::vector<Attribute>& attributes)
        : context_(context), place_(place), element_(element), attributes_(attributes) {}

    /// The element that the operation is said of; its content and `live` are known in `agree` alone.
    Element& element() { return element_; }
    const Grammar& grammar() const;
    /// In the body of a rule with `repeat`.
    bool isInChain() const;
    /// In a part of a scope, which begins empty.
    bool isInPart() const;

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
        const size_t outside = place_.locals.size();
        local = place_.frame++;
        place_.locals.push_back({name, local, Type::number(Unit::None, true), true});
        check();
        place_.leave(outside);
    }

    /// The value at the defaults of all parameters, or nothing where a shape, a local or chance decides.
    std::optional<Value> atDefaults(const Expr& e) const;
    /// Refuses a constant that a primitive's parameter can't take.
    void checkRange(const Expr& e, const field::Primitive& row, size_t parameter);

    /// What names mean here.
    OperationNames names() const { return OperationNames(context_); }
    /// The files that the grammar names, each read once.
    FileTables& files() const;
    /// A parameter by index and a value for it, which may depend on the shape; nothing after an error.
    std::optional<std::pair<uint32_t, Expr>> setting(const syntax::Setting& written);
    /// The index in Grammar::reports of a name that `value` is reported under; nothing after an error.
    std::optional<uint32_t> report(const syntax::Expr& name, const Typed& value);

    void error(SourceSpan span, std::string message, std::string fix = {});
    void warning(SourceSpan span, std::string message, std::string fix = {});
    /// An error about a name, silent where the name stands in a text that could not be read.
    void unknownName(SourceSpan span, const std::string& name, std::string message, std::string fix = {});
    size_t problemCount() const;
    bool hasErrors() const;

private:
    CheckContext& context_;
    Place& place_;
    Element& element_;
    std::vector<Attribute>& attributes_;
};

}  // namespace sgm::rules
