#include "grammar/rules/operation_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/bodies.h"
#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/make.h"
#include "grammar/rules/params.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using syntax::ArgumentType;

Want wantOf(ArgumentType type) {
    switch (type) {
        case ArgumentType::Number:
            return Want::Number;
        case ArgumentType::Length:
            return Want::Length;
        case ArgumentType::Angle:
            return Want::Angle;
        case ArgumentType::Rotation:
            return Want::Angles;
        case ArgumentType::Size:
            return Want::Size;
        case ArgumentType::Vector:
            return Want::Offset;
        case ArgumentType::Color:
            return Want::Color;
        default:
            return Want::Anything;
    }
}

bool isWord(ArgumentType type) {
    return type == ArgumentType::Name || type == ArgumentType::Start || type == ArgumentType::Axis ||
           type == ArgumentType::Solid || type == ArgumentType::Symbol;
}

/// Its shares are of the scope, axis by axis.
bool isMeasure(ArgumentType type) { return type == ArgumentType::Size || type == ArgumentType::Vector; }

/// Every constant part of an expression: both ends of a range or ramp, each component, each value to choose from.
template <class Visit>
void eachConstant(const Expr& e, const std::vector<Value>& params, Visit visit) {
    if (const auto value = fold(e, params)) return visit(e, *value);
    if (e.kind == Expr::Kind::Range || e.kind == Expr::Kind::Ramp || e.kind == Expr::Kind::Tuple)
        for (const Expr& arg : e.args) eachConstant(arg, params, visit);
    if (e.kind == Expr::Kind::Choose)
        for (size_t i = 1; i < e.args.size(); i += 2) eachConstant(e.args[i], params, visit);
}

}  // namespace

const Grammar& OperationChecker::grammar() const { return context_.grammar; }
bool OperationChecker::isInChain() const { return place_.where == Place::Where::Chain; }
bool OperationChecker::isInPart() const { return place_.isInPart; }

void OperationChecker::checkArguments(const syntax::Attribute& written) {
    const Operation& operation = *written.operation;
    Attribute out;
    out.operation = &operation;
    out.span = written.span;
    beginDraws(std::string(operation.name));
    for (size_t i = 0; i < written.args.size() && i < operation.arguments.size(); ++i) {
        const syntax::Expr& arg = written.args[i];
        const ArgumentType type = operation.arguments[i].type;
        const std::string what = fmt::format("'{}'", operation.name);
        if (isWord(type))
            out.args.push_back(makeConstant(arg.span, makeWord(arg.text)));
        else if (operation.phase == Operation::Phase::Scope && isMeasure(type))
            out.args.push_back(checkMeasure(context_, place_, arg, wantOf(type), what));
        else
            out.args.push_back(expression(arg, wantOf(type), what));
    }
    const syntax::OperationRange& range = operation.range;
    for (const Expr& arg : out.args) {
        bool said = range.text.empty();
        eachConstant(arg, context_.params.defaults, [&](const Expr& e, const Value& v) {
            for (size_t i = 0; i < v.count && !said && (v.kind == Value::Kind::Number || v.kind == Value::Kind::Vector);
                 ++i) {
                if (v.n[i] >= range.lo && v.n[i] <= range.hi) continue;
                said = true;
                const std::string outside =
                    fmt::format("'{}' is {}, but must be {}", operation.name, toText(v), range.text);
                if (auto suspect = findDoubtWithin(e, context_.params.defaults))
                    error(suspect->span, suspect->message + ", so " + outside, "keep what is divided by from 0");
                else
                    error(e.span, outside,
                          range.hi == 1 && v.units[0] == Unit::None && v.n[i] >= 10 && v.n[i] <= 100
                              ? fmt::format("write '{:g}%'", v.n[i])
                              : std::string(v.n[i] == 0 ? range.ofZero : ""));
            }
        });
    }
    add(std::move(out));
}

Attribute* OperationChecker::find(const Operation& operation) {
    const auto found = std::find_if(attributes_.begin(), attributes_.end(),
                                    [&](const Attribute& a) { return a.operation == &operation; });
    return found == attributes_.end() ? nullptr : &*found;
}

void OperationChecker::beginDraws(std::string name) { place_.enter(std::move(name)); }

Expr OperationChecker::expression(const syntax::Expr& e, Want want, std::string_view what) {
    return checkExpression(context_, place_, e, want, what);
}

Expr OperationChecker::measure(const syntax::Expr& e, Want want, std::string_view what, int axis) {
    place_.axis = axis;
    Expr result = checkExpression(context_, place_, e, want, what);
    place_.axis = -1;
    return result;
}

Expr OperationChecker::point(const syntax::Expr& e, std::string_view what) {
    return checkMeasure(context_, place_, e, Want::Triple, what);
}

std::shared_ptr<const Body> OperationChecker::partBody(const syntax::Body& written) {
    const bool outside = std::exchange(place_.isInPart, true);
    auto made = std::make_shared<Body>(checkBody(context_, place_, written));
    place_.isInPart = outside;
    if (!made->grows) return made;
    const auto cutsAbove = [](const Body& body) {
        for (const Element& e : body.siblings[0])
            if (e.kind != Element::Kind::Let) return e.through != none;
        return false;
    };
    if (!cutsAbove(*made)) {
        error(made->span, "a part begins with a shape: nothing stands in it yet that could grow",
              "leave the operator and its joint out and place the shape by 'move', or cut a shape further up by '- … "
              "through Name'");
        return made;
    }
    Element group;
    group.span = made->span;
    group.label = "group";
    group.ordinal = place_.ordinals[group.label]++;
    group.content = Content(std::shared_ptr<const Body>(made));
    auto whole = std::make_shared<Body>();
    whole->span = made->span;
    whole->siblings.push_back({std::move(group)});
    return whole;
}

Expr OperationChecker::material(const syntax::Expr& e) { return checkMaterial(context_, place_, e); }

Typed OperationChecker::value(const syntax::Expr& e) { return checkExpression(context_, place_, e); }
Solid OperationChecker::solid(const syntax::Expr& e) { return checkSolid(context_, place_, e); }
Expr OperationChecker::joint(const syntax::Expr& e) { return checkJoint(context_, place_, e); }

std::shared_ptr<const Body> OperationChecker::body(const syntax::Body& written) {
    return std::make_shared<const Body>(checkBody(context_, place_, written));
}

std::optional<Value> OperationChecker::atDefaults(const Expr& e) const { return fold(e, context_.params.defaults); }

void OperationChecker::checkRange(const Expr& e, const field::Primitive& row, size_t parameter) {
    checkParameterRange(context_, e, row, parameter);
}

FileTables& OperationChecker::files() const { return context_.files; }

std::optional<SymbolId> OperationNames::findStart(const syntax::Expr& name) {
    std::vector<std::string> known;
    for (const auto& [start, span] : context_.seen.starts) known.push_back(start);
    const auto symbol = findSymbol(name.text);
    if (symbol && context_.seen.starts.contains(name.text)) return symbol;
    failUnknown(
        context_, name.span, name.text,
        symbol ? fmt::format("'{}' is no start, and an object of its own begins with one", name.text)
               : fmt::format("there is no start '{}'", name.text),
        symbol ? fmt::format("write 'start {} -> …', or leave 'place' out", name.text) : nearestHint(name.text, known));
    return std::nullopt;
}

std::optional<std::pair<uint32_t, Expr>> OperationChecker::setting(const syntax::Setting& written) {
    const auto param = context_.names.params.find(written.name.text);
    if (written.name.empty()) return std::nullopt;
    if (param == context_.names.params.end()) {
        std::vector<std::string> known;
        for (const Param& p : context_.grammar.params) known.push_back(p.name);
        unknownName(written.name.span, written.name.text, fmt::format("there is no parameter '{}'", written.name.text),
                    nearestHint(written.name.text, known));
        return std::nullopt;
    }
    const uint32_t index = param->second;
    const Param& target = context_.grammar.params[index];
    const syntax::Expr& e = written.value;
    const bool isChoice = e.kind == syntax::Expr::Kind::Name && !names().isParameter(e.text) && !target.choices.empty();
    beginDraws("place." + target.name);
    Typed value = isChoice ? makeTyped(e.span, makeWord(e.text)) : checkExpression(context_, place_, e);
    if (context_.params.broken.contains(index) || !value.type.known) return std::pair(index, std::move(value.expr));
    const auto constant = fold(value.expr, {});
    Value sample = constant ? *constant : value.type.like;
    if (sample.kind == Value::Kind::Number && target.value.integer)
        sample.integer = !constant || sample.num() == std::floor(sample.num());
    // What isn't constant derivation looks at.
    const auto fitted = constant ? conform(target, sample) : conformKind(target, sample);
    if (!fitted.ok()) error(e.span, fitted.error().message, nearestHint(sample.text, target.choices));
    return std::pair(index, std::move(value.expr));
}

std::optional<uint32_t> OperationChecker::report(const syntax::Expr& name, const Typed& value) {
    if (name.kind != syntax::Expr::Kind::Name) return std::nullopt;
    if (value.type.known && value.type.like.kind != Value::Kind::Number) {
        error(value.expr.span, fmt::format("'report' sums numbers, and this is {}", describe(value.type)));
        return std::nullopt;
    }
    auto& all = context_.grammar.reports;
    const auto known = std::find_if(all.begin(), all.end(), [&](const Report& r) { return r.name == name.text; });
    if (known == all.end()) {
        if (isTaken(name.text) || names().isParameter(name.text))
            error(name.span, fmt::format("'{}' has a meaning already: what is reported needs another name", name.text));
        all.push_back({name.text, value.type.like, name.span});
        return static_cast<uint32_t>(all.size() - 1);
    }
    if (value.type.known && value.type.like.units[0] != known->like.units[0])
        error(value.expr.span, fmt::format("'{}' is reported as {} elsewhere, and this is {}", name.text,
                                           describe(Type::of(known->like)), describe(value.type)));
    return static_cast<uint32_t>(known - all.begin());
}

std::optional<uint32_t> OperationNames::findLsystem(std::string_view name) const {
    const auto& all = context_.grammar.lsystems;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Lsystem& l) { return l.name == name; });
    return found == all.end() ? std::nullopt : std::optional(static_cast<uint32_t>(found - all.begin()));
}

std::optional<uint32_t> OperationNames::findRoads(std::string_view name) const {
    const auto& all = context_.grammar.roads;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Roads& r) { return r.name == name; });
    return found == all.end() ? std::nullopt : std::optional(static_cast<uint32_t>(found - all.begin()));
}

std::optional<SymbolId> OperationNames::findSymbol(std::string_view name) const {
    return findReferenced(context_, std::string(name));
}

bool OperationNames::isParameter(std::string_view name) const {
    return context_.names.params.contains(std::string(name));
}
bool OperationNames::isJoint(std::string_view name) const { return context_.names.joints.contains(std::string(name)); }

std::vector<std::string> OperationNames::symbols() const { return symbolNames(context_, false); }

void OperationChecker::error(SourceSpan span, std::string message, std::string fix) {
    context_.diagnostics.error(span, std::move(message), std::move(fix));
}

void OperationChecker::warning(SourceSpan span, std::string message, std::string fix) {
    context_.diagnostics.warning(span, std::move(message), std::move(fix));
}

void OperationChecker::unknownName(SourceSpan span, const std::string& name, std::string message, std::string fix) {
    failUnknown(context_, span, name, std::move(message), std::move(fix));
}

bool OperationNames::areErrorsSuppressed(const std::string& name) const { return context_.suppressed.contains(name); }
bool OperationChecker::hasErrors() const { return context_.diagnostics.hasErrors(); }

size_t OperationChecker::problemCount() const { return context_.diagnostics.all().size(); }

}  // namespace sgm::rules
