// Rule and start bodies: elements, what joins the tree, and control around it.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "grammar/rules/checker.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"

namespace sgm::rules {
namespace {

using Written = syntax::Expr;

bool isNil(const Body& body) {
    return body.siblings.size() == 1 && body.siblings[0].size() == 1 &&
           body.siblings[0][0].kind == Element::Kind::Shape && body.siblings[0][0].content.solid() &&
           body.siblings[0][0].content.solid()->kind == Solid::Kind::Nil;
}

/// A body grows on the matched content when its first shape has an operator; `nil` beside growing choices adds nothing.
bool grows(const Body& body) {
    if (body.siblings.empty()) return false;
    const auto& chain = body.siblings[0];
    const auto begin =
        std::find_if(chain.begin(), chain.end(), [](const Element& e) { return e.kind != Element::Kind::Let; });
    if (begin == chain.end()) return false;
    const Element& first = *begin;
    switch (first.kind) {
        case Element::Kind::Shape:
            return first.op != Operator::None;
        case Element::Kind::For:
        case Element::Kind::While:
        case Element::Kind::When:
            return first.body && grows(*first.body);
        case Element::Kind::Choose:
            return std::any_of(first.choices.begin(), first.choices.end(),
                               [](const Choice& c) { return grows(*c.body); });
        case Element::Kind::Let:
            break;
    }
    return false;
}

}  // namespace

void Checker::live(const syntax::Name& name, Element& out) {
    if (name.empty()) return;
    if (!isNonTerminal(name.text)) {
        diagnostics_.error(name.span,
                           fmt::format("a live shape's name begins with a capital: '{}' would be terminal", name.text));
        return;
    }
    out.live = nonTerminal(name);
    if (ruled_.contains(out.live)) return;
    std::vector<std::string> ruled;
    for (const SymbolId id : ruled_) ruled.push_back(grammar_.symbols[id].name);
    if (std::string hint = nearest(name.text, ruled); !hint.empty())
        diagnostics_.warning(name.span, fmt::format("no rule matches '{}', so nothing will grow here", name.text),
                             std::move(hint));
}

void Checker::content(Place& place, const Written& e, Element& out) {
    const auto symbol = symbols_.find(e.text);
    const bool named = e.kind == Written::Kind::Name && symbol != symbols_.end();
    if (named && !grammar_.symbols[symbol->second].isMaterial) {
        out.content = Content::ofSymbol(symbol->second);
        out.label = e.text;
        if (!grammar_.symbols[symbol->second].terminal && !ruled_.contains(symbol->second))
            unknown(e.span, e.text, fmt::format("there is no rule for '{}'", e.text), unknownSolid(e.text));
        return;
    }
    if (e.kind == Written::Kind::Call && isNonTerminal(e.text)) {
        diagnostics_.error(e.span, fmt::format("'{}' takes no parameters", e.text),
                           "hand values down with 'with name = …'");
        return;
    }
    Solid made = solid(place, e);
    out.label = e.text;
    const bool cuts = out.op == Operator::Difference || out.op == Operator::Intersection;
    if (!cuts && out.op != Operator::None) bounded(made, out.op == Operator::Morph ? "morphed" : "added");
    out.content = Content(std::move(made));
}

/// The content operation that an element consists of; null where there is none or, with a message, where it stands
/// beside a shape.
const syntax::Attribute* Checker::contentOperation(const syntax::Element& written) {
    const bool alone = written.kind == syntax::Element::Kind::Shape && !written.solid;
    const syntax::Attribute* found = nullptr;
    for (const auto* list : {&written.before, &written.after})
        for (const syntax::Attribute& a : *list) {
            if (a.operation->phase != Operation::Phase::Content) continue;
            found = &a;
            if (alone) continue;
            diagnostics_.error(a.name.span,
                               fmt::format("'{}' cuts the scope itself: no shape stands beside it", a.name.text),
                               "write the shapes into its parts");
        }
    return alone ? found : nullptr;
}

void Checker::shape(Place& place, const syntax::Element& written, Element& out) {
    // With an operator there is no matched scope to change: what stands before the newcomer is meant for it.
    std::vector<Attribute> before = attributes(place, out, written.before);
    out.attributes = attributes(place, out, written.after);
    const syntax::Attribute* cut = contentOperation(written);
    if (out.op == Operator::None && !cut)
        out.prefix = std::move(before);
    else
        out.attributes.insert(out.attributes.begin(), before.begin(), before.end());
    for (const Attribute& a : out.prefix)
        if (!a.operation->beforeShape)
            diagnostics_.error(a.span, fmt::format("'{}' can't stand before a shape", a.operation->name),
                               "write it after the shape");
    if (cut) {
        std::vector<Attribute> none;
        OperationChecker checker(*this, place, out, none);
        out.content = Content(std::shared_ptr<const Parts>(cut->operation->checkParts(checker, *cut)));
        out.label = cut->operation->name;
    } else if (written.kind == syntax::Element::Kind::Group) {
        out.content = Content(std::make_shared<const Body>(written.body ? body(place, *written.body) : Body{}));
        out.label = "group";
    } else if (written.solid) {
        content(place, *written.solid, out);
    } else if (!written.live.empty()) {
        diagnostics_.error(written.live.span, fmt::format("no shape stands before ': {}'", written.live.text),
                           fmt::format("leave ':' out to go on with the rules of '{}'", written.live.text));
    } else if (out.op != Operator::None) {
        diagnostics_.error(written.span, "nothing is joined here", "name a shape after the operator");
    }
    live(written.live, out);
    if (out.op == Operator::Morph) place.morphs = true;
    if (!out.label.empty()) out.ordinal = place.ordinals[out.label]++;
    OperationChecker checker(*this, place, out, out.attributes);
    for (const Attribute& a : out.attributes)
        if (a.operation->agree) a.operation->agree(checker, out, a);
}

/// The values of a loop: `axes`, `sides`, a tuple, or a range of whole numbers.
Expr Checker::loopDomain(Place& place, const Written& e, Type& type) {
    Expr result;
    result.span = e.span;
    result.kind = Expr::Kind::Tuple;
    type = Type::of(Value::Kind::Axis);
    if (e.kind == Written::Kind::Name && (e.text == "axes" || e.text == "sides")) {
        for (int axis = 0; axis < 6; ++axis)
            if (e.text == "axes" || axis / 2 != 1) result.args.push_back(makeConstant(e.span, makeAxis(axis)));
        return result;
    }
    if (e.kind == Written::Kind::Range) {
        type = Type::number(Unit::None, true);
        result.kind = Expr::Kind::Range;
        for (const Written& end : e.args) result.args.push_back(expression(place, end, Want::Count, "a loop"));
        const auto lo = fold(result.args[0], {}), hi = fold(result.args[1], {});
        if (lo && hi && lo->num() > hi->num() + 1)  // 1..0 is how one writes no turn at all
            diagnostics_.error(e.span, "this loop never runs: its range runs backwards",
                               fmt::format("write '{}..{}'", e.args[1].span.text(), e.args[0].span.text()));
        return result;
    }
    if (e.kind == Written::Kind::Tuple) {
        bool axes = true;
        for (const Written& part : e.args) {
            Typed value = expression(place, part);
            axes = axes && value.type.known && value.type.like.kind == Value::Kind::Axis;
            if (!axes) expectType(value, Want::Count, "a loop", &part);
            result.args.push_back(std::move(value.expr));
        }
        if (!axes) type = Type::number(Unit::None, true);
        return result;
    }
    if (e.kind != Written::Kind::Error)
        diagnostics_.error(
            e.span,
            fmt::format("a loop runs over 'axes', 'sides', a range 1..n or a list (a, b, c), not '{}'", e.span.text()));
    type = Type::unknown();
    return result;
}

void Checker::loop(Place& place, const syntax::Element& written, Element& out) {
    const size_t outside = place.locals.size();
    place.enter("loop");
    if (written.kind == syntax::Element::Kind::For) {
        Place::Local local{written.variable.text, place.frame++, Type::unknown()};
        if (written.over) out.over = loopDomain(place, *written.over, local.type);
        local.counts = out.over && out.over->kind == Expr::Kind::Range;
        out.local = local.index;
        const bool again =
            std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == local.name; });
        if (again || params_.contains(local.name))
            diagnostics_.error(written.variable.span, fmt::format("'{}' already means something else here", local.name),
                               "give the loop's variable another name");
        else if (local.name != "i" && isTaken(local.name))
            diagnostics_.error(
                written.variable.span,
                fmt::format("'{}' is a word of the language and can't name a loop's variable", local.name));
        place.locals.push_back(std::move(local));
        if (written.guard) out.guard = expression(place, *written.guard, Want::Truth, "'when'");
    } else if (written.over) {
        const bool isWhile = written.kind == syntax::Element::Kind::While;
        out.guard = expression(place, *written.over, Want::Truth, isWhile ? "'while'" : "'when'");
        if (const auto holds = fold(*out.guard, {}); isWhile && holds && holds->truth())
            diagnostics_.error(out.guard->span, "this 'while' never ends: its condition always holds");
    }
    out.body = std::make_shared<Body>(written.body ? body(place, *written.body) : Body{});
    place.locals.resize(outside, Place::Local{{}, 0, Type::unknown()});
}

/// A value of the body: in sight from here to the end of the body.
void Checker::let(Place& place, const syntax::Element& written, Element& out) {
    const std::string& name = written.variable.text;
    place.enter("let " + name);
    place.material = true;
    Typed value = written.over ? expression(place, *written.over) : Typed{{}, Type::unknown()};
    place.material = false;
    const auto isName = [&](const auto& l) { return l.name == name; };
    const bool taken = isTaken(name) || axisNumber(name) >= 0;
    if (taken || std::any_of(place.locals.begin(), place.locals.end(), isName) || params_.contains(name) ||
        lets_.contains(name) || withNames_.contains(name))
        diagnostics_.error(written.variable.span,
                           fmt::format("'{}' {}", name,
                                       taken ? "is a word of the language and can't name a value"
                                             : "already means something else here"),
                           "give the value another name");
    out.over = std::move(value.expr);
    out.local = place.frame++;
    place.locals.push_back({name, out.local, value.type});
}

void Checker::choose(Place& place, const syntax::Element& written, Element& out) {
    if (!written.variable.empty())
        if (const auto* local = counter(place, written.variable.span, written.variable.text, written.cases.size())) {
            out.series = written.variable.text == "distinct" ? Series::Distinct : Series::Shuffled;
            out.local = local->index;
        }
    for (const syntax::Case& c : written.cases) {
        Choice choice;
        choice.weight = makeConstant(c.span, Value::number(1));
        place.enter("weight");
        if (c.label) choice.weight = weight(place, *c.label);
        if (c.repeated || !c.tag.empty()) diagnostics_.error(c.span, "a choice is 'weight: body'");
        choice.body = std::make_shared<Body>(c.body ? body(place, *c.body) : Body{});
        out.choices.push_back(std::move(choice));
    }
    std::vector<const Expr*> weights;
    for (const Choice& c : out.choices) weights.push_back(&c.weight);
    checkWeights(weights, written.span);
    const auto grow = [](const Choice& c) { return grows(*c.body); };
    if (std::any_of(out.choices.begin(), out.choices.end(), grow))
        for (const Choice& c : out.choices)
            if (!grow(c) && !isNil(*c.body))
                diagnostics_.error(c.body->span, "this alternative replaces what stands, but others grow on it",
                                   "begin every alternative with an operator, or none");
}

Element Checker::element(Place& place, const syntax::Element& written) {
    using Kind = syntax::Element::Kind;
    Element out;
    out.span = written.span;
    out.op = written.op;
    out.inMatchedFrame = versionOf(grammar_, written.span) >= 2;
    switch (written.kind) {
        case Kind::Shape:
        case Kind::Group:
            shape(place, written, out);
            return out;
        case Kind::For:
            out.kind = Element::Kind::For;
            break;
        case Kind::While:
            out.kind = Element::Kind::While;
            break;
        case Kind::When:
            out.kind = Element::Kind::When;
            break;
        case Kind::Choose:
            out.kind = Element::Kind::Choose;
            choose(place, written, out);
            return out;
        case Kind::Let:
            out.kind = Element::Kind::Let;
            out.label = "let " + written.variable.text;
            let(place, written, out);
            return out;
    }
    loop(place, written, out);
    return out;
}

Body Checker::body(Place& place, const syntax::Body& written) {
    Body result;
    result.span = written.span;
    const size_t outside = place.locals.size();
    for (const auto& chain : written.siblings) {
        std::vector<Element>& elements = result.siblings.emplace_back();
        for (const syntax::Element& e : chain) elements.push_back(element(place, e));
        if (!elements.empty() && elements.back().kind == Element::Kind::Let)
            diagnostics_.error(elements.back().span, "no shape stands behind this value", "write the shape behind it");
    }
    place.locals.resize(outside, Place::Local{{}, 0, Type::unknown()});
    result.grows = grows(result);
    return result;
}

void Checker::rule(const syntax::RuleDecl& decl) {
    if (!isNonTerminal(decl.symbol.text)) {
        diagnostics_.error(
            decl.symbol.span,
            fmt::format("rules rewrite shapes whose names begin with a capital, and '{}' doesn't", decl.symbol.text));
        return;
    }
    Rule out;
    out.span = decl.span;
    out.symbolSpan = decl.symbol.span;
    out.symbol = nonTerminal(decl.symbol);
    out.besideWins = versionOf(grammar_, decl.span) >= 2 && !decl.beside.empty();
    out.name = decl.name.text;
    if (out.name.empty()) out.name = fmt::format("{}#{}", decl.symbol.text, ++unnamedRules_[out.symbol]);
    Place guard(Place::Where::Guard);
    const auto condition = [&](const std::optional<Written>& e, const char* word, Want want) -> std::optional<Expr> {
        guard.enter(word);
        return e ? std::optional(expression(guard, *e, want, fmt::format("'{}'", word))) : std::nullopt;
    };
    out.when = condition(decl.when, "when", Want::Truth);
    out.weight = condition(decl.weight, "weight", Want::Number);
    out.repeat = condition(decl.repeat, "repeat", Want::Count);
    if (out.weight)
        if (const auto weight = fold(*out.weight, defaults_); weight && weight->num() < 0)
            diagnostics_.error(out.weight->span, fmt::format("a weight is no less than 0, not {}", toText(*weight)));
    const auto symbolOf = [&](const syntax::Name& name) {
        if (name.empty()) return none;
        const auto symbol = symbols_.find(name.text);
        if (symbol != symbols_.end()) return symbol->second;
        unknown(name.span, name.text, fmt::format("there is no shape called '{}'", name.text),
                nearest(name.text, symbolNames(false)));
        return none;
    };
    out.beside = symbolOf(decl.beside);
    out.after = symbolOf(decl.after);
    if (out.after == out.symbol && out.after != none)
        diagnostics_.error(decl.after.span, fmt::format("'{}' would wait for itself", decl.after.text));
    Place place(out.repeat ? Place::Where::Chain : Place::Where::Body);
    if (out.repeat) {
        out.stepLocal = place.frame++;
        place.locals.push_back({"i", out.stepLocal, Type::number(Unit::None, true), true});
    }
    out.body = body(place, decl.body);
    out.morphic = std::exchange(place.morphs, false);
    if (decl.finally_) {
        if (!out.repeat)
            diagnostics_.error(decl.finally_->span, "'finally' closes a chain, and there is none here",
                               "give the rule a 'repeat'");
        place.where = Place::Where::Finally;
        place.locals.clear();
        out.finally_ = body(place, *decl.finally_);
        out.finallyMorphic = place.morphs;
    }
    out.locals = place.frame;
    rules_.emplace(out.name, static_cast<uint32_t>(grammar_.rules.size()));
    grammar_.symbols[out.symbol].rules.push_back(static_cast<uint32_t>(grammar_.rules.size()));
    grammar_.rules.push_back(std::move(out));
}

void Checker::start(const syntax::StartDecl& decl) {
    if (!isNonTerminal(decl.symbol.text)) {
        diagnostics_.error(decl.symbol.span,
                           fmt::format("a start's name begins with a capital, and '{}' doesn't", decl.symbol.text));
        return;
    }
    Place place(Place::Where::Body);
    Start out;
    out.span = decl.span;
    out.symbol = nonTerminal(decl.symbol);
    out.body = body(place, decl.body);
    out.locals = place.frame;
    if (out.body.grows)
        diagnostics_.error(decl.body.span, "a start begins with a shape: nothing stands yet that could grow",
                           "leave the operator out");
    for (const auto& chain : out.body.siblings)
        for (const Element& e : chain)
            if (e.op == Operator::None && e.content.solid()) bounded(*e.content.solid(), "a start");
    grammar_.starts.push_back(std::move(out));
}

void Checker::productions(const syntax::Ast& ast) {
    for (const auto& decl : ast.starts) start(decl);
    for (const auto& decl : ast.rules) rule(decl);
}

}  // namespace sgm::rules
