#include "grammar/rules/operation_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/rules/arithmetic_warnings.h"
#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
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

const Grammar& OperationChecker::grammar() const { return checker_.grammar_; }
bool OperationChecker::isInChain() const { return place_.where == Place::Where::Chain; }
bool OperationChecker::isInFinally() const { return place_.where == Place::Where::Finally; }

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
            out.args.push_back(checker_.measured(place_, arg, wantOf(type), what));
        else
            out.args.push_back(expression(arg, wantOf(type), what));
    }
    const syntax::OperationRange& range = operation.range;
    for (const Expr& arg : out.args) {
        bool said = range.text.empty();
        eachConstant(arg, checker_.defaults_, [&](const Expr& e, const Value& v) {
            for (size_t i = 0; i < v.count && !said && (v.kind == Value::Kind::Number || v.kind == Value::Kind::Vector);
                 ++i) {
                if (v.n[i] >= range.lo && v.n[i] <= range.hi) continue;
                said = true;
                const std::string outside =
                    fmt::format("'{}' is {}, but must be {}", operation.name, toText(v), range.text);
                if (auto suspect = findDoubtWithin(e, checker_.defaults_))
                    error(suspect->span, suspect->message + ", so " + outside, "keep what is divided by from 0");
                else
                    error(e.span, outside);
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
    return checker_.expression(place_, e, want, what);
}

Expr OperationChecker::measure(const syntax::Expr& e, Want want, std::string_view what, int axis) {
    place_.axis = axis;
    Expr result = checker_.expression(place_, e, want, what);
    place_.axis = -1;
    return result;
}

Expr OperationChecker::point(const syntax::Expr& e, std::string_view what) {
    return checker_.measured(place_, e, Want::Triple, what);
}

std::shared_ptr<const Body> OperationChecker::partBody(const syntax::Body& written) {
    auto made = std::make_shared<Body>(checker_.body(place_, written));
    if (!made->grows) return made;
    const auto cutsAbove = [](const Body& body) {
        for (const Element& e : body.siblings[0])
            if (e.kind != Element::Kind::Let) return e.through != none;
        return false;
    };
    if (!cutsAbove(*made)) {
        error(made->span, "a part begins with a shape: nothing stands in it yet that could grow",
              "leave the operator out, or cut a shape further up by '- … through Name'");
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

Expr OperationChecker::material(const syntax::Expr& e) { return checker_.material(place_, e); }

Typed OperationChecker::value(const syntax::Expr& e) { return checker_.expression(place_, e); }
Solid OperationChecker::solid(const syntax::Expr& e) { return checker_.solid(place_, e); }
Expr OperationChecker::joint(const syntax::Expr& e) { return checker_.joint(place_, e); }

std::shared_ptr<const Body> OperationChecker::body(const syntax::Body& written) {
    return std::make_shared<const Body>(checker_.body(place_, written));
}

size_t OperationChecker::pushLocal(const std::string& name, uint32_t& local) {
    const size_t outside = place_.locals.size();
    local = place_.frame++;
    place_.locals.push_back({name, local, Type::number(Unit::None, true), true});
    return outside;
}

void OperationChecker::popLocals(size_t outside) {
    place_.locals.resize(outside, Place::Local{{}, 0, Type::unknown()});
}

std::optional<Value> OperationChecker::atDefaults(const Expr& e) const { return fold(e, checker_.defaults_); }

void OperationChecker::checkRange(const Expr& e, const field::Primitive& row, size_t parameter) {
    checker_.inRange(e, row, parameter);
}

Solid OperationChecker::solidOfRow(SourceSpan span, const field::Primitive& row) {
    return Checker::solidOfRow(span, row);
}

std::optional<uint32_t> OperationChecker::readOutlines(const syntax::Expr& name) { return checker_.outlinesOf(name); }

std::optional<uint32_t> OperationChecker::readImage(const syntax::Expr& name) { return checker_.imageOf(name); }

std::optional<SymbolId> OperationChecker::findStart(const syntax::Expr& name) {
    std::vector<std::string> known;
    for (const auto& [start, span] : checker_.seenStarts_) known.push_back(start);
    const auto symbol = findSymbol(name.text);
    if (symbol && checker_.seenStarts_.contains(name.text)) return symbol;
    unknownName(
        name.span, name.text,
        symbol ? fmt::format("'{}' is no start, and an object of its own begins with one", name.text)
               : fmt::format("there is no start '{}'", name.text),
        symbol ? fmt::format("write 'start {} -> …', or leave 'place' out", name.text) : nearest(name.text, known));
    return std::nullopt;
}

std::optional<std::pair<uint32_t, Expr>> OperationChecker::setting(const syntax::Setting& written) {
    const auto param = checker_.params_.find(written.name.text);
    if (written.name.empty()) return std::nullopt;
    if (param == checker_.params_.end()) {
        std::vector<std::string> known;
        for (const Param& p : checker_.grammar_.params) known.push_back(p.name);
        unknownName(written.name.span, written.name.text, fmt::format("there is no parameter '{}'", written.name.text),
                    nearest(written.name.text, known));
        return std::nullopt;
    }
    const uint32_t index = param->second;
    const Param& target = checker_.grammar_.params[index];
    const syntax::Expr& e = written.value;
    const bool isChoice = e.kind == syntax::Expr::Kind::Name && !isParameter(e.text) && !target.choices.empty();
    beginDraws("place." + target.name);
    Typed value = isChoice ? makeTyped(e.span, makeWord(e.text)) : checker_.expression(place_, e);
    if (checker_.brokenParams_.contains(index) || !value.type.known) return std::pair(index, std::move(value.expr));
    const auto constant = fold(value.expr, {});
    Value sample = constant ? *constant : value.type.like;
    if (sample.kind == Value::Kind::Number && target.value.integer)
        sample.integer = !constant || sample.num() == std::floor(sample.num());
    // What isn't constant derivation looks at.
    const auto fitted = constant ? conform(target, sample) : conformKind(target, sample);
    if (!fitted.ok()) error(e.span, fitted.error().message, nearest(sample.text, target.choices));
    return std::pair(index, std::move(value.expr));
}

std::optional<uint32_t> OperationChecker::report(const syntax::Expr& name, const Typed& value) {
    if (name.kind != syntax::Expr::Kind::Name) return std::nullopt;
    if (value.type.known && value.type.like.kind != Value::Kind::Number) {
        error(value.expr.span, fmt::format("'report' sums numbers, and this is {}", describe(value.type)));
        return std::nullopt;
    }
    auto& all = checker_.grammar_.reports;
    const auto known = std::find_if(all.begin(), all.end(), [&](const Report& r) { return r.name == name.text; });
    if (known == all.end()) {
        if (isTaken(name.text) || isParameter(name.text))
            error(name.span, fmt::format("'{}' has a meaning already: what is reported needs another name", name.text));
        all.push_back({name.text, value.type.like, name.span});
        return static_cast<uint32_t>(all.size() - 1);
    }
    if (value.type.known && value.type.like.units[0] != known->like.units[0])
        error(value.expr.span, fmt::format("'{}' is reported as {} elsewhere, and this is {}", name.text,
                                           describe(Type::of(known->like)), describe(value.type)));
    return static_cast<uint32_t>(known - all.begin());
}

std::optional<uint32_t> OperationChecker::findLsystem(std::string_view name) const {
    const auto& all = checker_.grammar_.lsystems;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Lsystem& l) { return l.name == name; });
    return found == all.end() ? std::nullopt : std::optional(static_cast<uint32_t>(found - all.begin()));
}

std::optional<uint32_t> OperationChecker::findRoads(std::string_view name) const {
    const auto& all = checker_.grammar_.roads;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Roads& r) { return r.name == name; });
    return found == all.end() ? std::nullopt : std::optional(static_cast<uint32_t>(found - all.begin()));
}

std::optional<SymbolId> OperationChecker::findSymbol(std::string_view name) const {
    const auto symbol = checker_.symbols_.find(std::string(name));
    return symbol == checker_.symbols_.end() ? std::nullopt : std::optional(symbol->second);
}

bool OperationChecker::isParameter(std::string_view name) const { return checker_.params_.contains(std::string(name)); }
bool OperationChecker::isJoint(std::string_view name) const { return checker_.jointNames_.contains(std::string(name)); }

std::string OperationChecker::nearest(std::string_view word, const std::vector<std::string>& candidates) const {
    return checker_.nearest(word, candidates);
}

std::vector<std::string> OperationChecker::symbolNames() const { return checker_.symbolNames(false); }

void OperationChecker::error(SourceSpan span, std::string message, std::string fix) {
    checker_.diagnostics_.error(span, std::move(message), std::move(fix));
}

void OperationChecker::unknownName(SourceSpan span, const std::string& name, std::string message, std::string fix) {
    checker_.unknown(span, name, std::move(message), std::move(fix));
}

bool OperationChecker::areErrorsSuppressed(const std::string& name) const { return checker_.excused_.contains(name); }
size_t OperationChecker::problemCount() const { return checker_.diagnostics_.all().size(); }

}  // namespace sgm::rules
