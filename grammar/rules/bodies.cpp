// Bodies: elements, what joins the tree, and control around it.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "grammar/rules/bodies.h"
#include "grammar/rules/declarations.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/expressions.h"
#include "grammar/rules/lookup.h"
#include "grammar/rules/make.h"
#include "grammar/rules/operation_checker.h"
#include "grammar/rules/words.h"
#include "grammar/syntax/hints.h"

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

void checkLive(CheckContext& ctx, const syntax::Name& name, Element& out) {
    if (name.empty()) return;
    if (!isNonTerminal(name.text)) {
        ctx.diagnostics.error(
            name.span, fmt::format("a live shape's name begins with a capital: '{}' would be terminal", name.text));
        return;
    }
    out.live = declareSymbol(ctx, name);
    if (ctx.names.ruled.contains(out.live)) return;
    std::vector<std::string> ruled;
    for (const SymbolId id : ctx.names.ruled) ruled.push_back(ctx.grammar.symbols[id].name);
    if (std::string hint = nearestHint(name.text, ruled); !hint.empty())
        ctx.names.misspelt.push_back({name.span, out.live, std::move(hint)});
}

void checkContent(CheckContext& ctx, Place& place, const Written& e, Element& out) {
    const auto symbol = ctx.names.symbols.find(e.text);
    const bool named = e.kind == Written::Kind::Name && symbol != ctx.names.symbols.end();
    if (named && !ctx.grammar.symbols[symbol->second].isMaterial) {
        out.content = Content::ofSymbol(symbol->second);
        out.label = e.text;
        if (!ctx.grammar.symbols[symbol->second].terminal && !ctx.names.ruled.contains(symbol->second))
            failUnknown(ctx, e.span, e.text, fmt::format("there is no rule for '{}'", e.text),
                        hintForSolid(ctx, e.text));
        return;
    }
    if (e.kind == Written::Kind::Call && isNonTerminal(e.text)) {
        ctx.diagnostics.error(e.span, fmt::format("'{}' takes no parameters", e.text),
                              "hand values down with 'with name = …'");
        return;
    }
    Solid made = checkSolid(ctx, place, e);
    out.label = e.text;
    const bool cuts = out.op == Operator::Difference || out.op == Operator::Intersection;
    if (!cuts && out.op != Operator::None) expectBounded(ctx, made, out.op == Operator::Morph ? "morphed" : "added");
    out.content = Content(std::move(made));
}

/// The content operation that an element consists of; null where there is none or, with a message, where it stands
/// beside a shape.
const syntax::Attribute* contentOperation(CheckContext& ctx, const syntax::Element& written) {
    const bool alone = written.kind == syntax::Element::Kind::Shape && !written.solid;
    const syntax::Attribute* found = nullptr;
    for (const auto* list : {&written.before, &written.after})
        for (const syntax::Attribute& a : *list) {
            if (a.operation->phase != Operation::Phase::Content) continue;
            found = &a;
            if (alone) continue;
            ctx.diagnostics.error(a.name.span,
                                  fmt::format("'{}' cuts the scope itself: no shape stands beside it", a.name.text),
                                  "write the shapes into its parts");
        }
    return alone ? found : nullptr;
}

void checkShape(CheckContext& ctx, Place& place, const syntax::Element& written, Element& out) {
    // With an operator there is no matched scope to change: what stands before the newcomer is meant for it.
    std::vector<Attribute> before = checkAttributes(ctx, place, out, written.before);
    out.attributes = checkAttributes(ctx, place, out, written.after);
    const syntax::Attribute* cut = contentOperation(ctx, written);
    if (out.op == Operator::None && !cut)
        out.prefix = std::move(before);
    else
        out.attributes.insert(out.attributes.begin(), before.begin(), before.end());
    for (const Attribute& a : out.prefix)
        if (!a.operation->traits.beforeShape)
            ctx.diagnostics.error(a.span, fmt::format("'{}' can't stand before a shape", a.operation->name),
                                  "write it after the shape");
    if (cut) {
        std::vector<Attribute> none;
        OperationChecker checker(ctx, place, out, none);
        out.content = Content(std::shared_ptr<const Parts>(cut->operation->checkParts(checker, *cut)));
        out.label = cut->operation->name;
    } else if (written.kind == syntax::Element::Kind::Group) {
        out.content =
            Content(std::make_shared<const Body>(written.body ? checkBody(ctx, place, *written.body) : Body{}));
        out.label = "group";
    } else if (written.solid) {
        checkContent(ctx, place, *written.solid, out);
    } else if (!written.live.empty()) {
        ctx.diagnostics.error(written.live.span, fmt::format("no shape stands before ': {}'", written.live.text),
                              fmt::format("leave ':' out to go on with the rules of '{}'", written.live.text));
    } else if (out.op != Operator::None) {
        ctx.diagnostics.error(written.span, "nothing is joined here", "name a shape after the operator");
    }
    checkLive(ctx, written.live, out);
    if (out.op == Operator::Morph) place.morphs = true;
    if (!out.label.empty()) out.ordinal = place.ordinals[out.label]++;
    OperationChecker checker(ctx, place, out, out.attributes);
    for (const Attribute& a : out.prefix)
        if (a.operation->agree && a.operation->phase == Operation::Phase::Scope) a.operation->agree(checker, out, a);
    for (const Attribute& a : out.attributes)
        if (a.operation->agree) a.operation->agree(checker, out, a);
}

/// The values of a loop: `axes`, `sides`, a tuple, or a range of whole numbers.
Expr loopDomain(CheckContext& ctx, Place& place, const Written& e, Type& type) {
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
        for (const Written& end : e.args)
            result.args.push_back(checkExpression(ctx, place, end, Want::Count, "a loop"));
        const auto lo = fold(result.args[0], {}), hi = fold(result.args[1], {});
        if (lo && hi && lo->num() > hi->num() + 1)  // 1..0 is how one writes no turn at all
            ctx.diagnostics.error(e.span, "this loop never runs: its range runs backwards",
                                  fmt::format("write '{}..{}'", e.args[1].span.text(), e.args[0].span.text()));
        return result;
    }
    if (e.kind == Written::Kind::Tuple) {
        bool axes = true;
        for (const Written& part : e.args) {
            Typed value = checkExpression(ctx, place, part);
            axes = axes && value.type.known && value.type.like.kind == Value::Kind::Axis;
            if (!axes) expectType(ctx, value, Want::Count, "a loop", &part);
            result.args.push_back(std::move(value.expr));
        }
        if (!axes) type = Type::number(Unit::None, true);
        return result;
    }
    if (e.kind != Written::Kind::Error)
        ctx.diagnostics.error(
            e.span,
            fmt::format("a loop runs over 'axes', 'sides', a range 1..n or a list (a, b, c), not '{}'", e.span.text()),
            e.kind == Written::Kind::Number ? fmt::format("write '1..{}'", e.span.text())
                                            : syntax::foreignFunctionHint(e.text));
    type = Type::unknown();
    return result;
}

/// What a name means already, for a message: "names a value of the file (line 3)"; "" where it means nothing.
std::string meaningOf(const CheckContext& ctx, const Place& place, const std::string& name) {
    const auto isName = [&](const auto& l) { return l.name == name; };
    const auto lineOf = [](syntax::SourceSpan span) { return span.source->place(span.begin).line; };
    if (std::any_of(place.locals.begin(), place.locals.end(), isName)) return "names another value of this body";
    if (const auto param = ctx.names.params.find(name); param != ctx.names.params.end())
        return fmt::format("names a parameter (line {})", lineOf(ctx.grammar.params[param->second].span));
    if (const auto let = ctx.names.lets.find(name); let != ctx.names.lets.end())
        return fmt::format("names a value of the file (line {})", lineOf(let->second.decl->span));
    return ctx.names.inherited.contains(name) ? "names a value that a 'with' sets" : "";
}

void checkLoop(CheckContext& ctx, Place& place, const syntax::Element& written, Element& out) {
    const size_t outside = place.locals.size();
    place.enter("loop");
    if (written.kind == syntax::Element::Kind::For) {
        Place::Local local{written.variable.text, place.frame++, Type::unknown()};
        if (written.over) out.over = loopDomain(ctx, place, *written.over, local.type);
        local.counts = out.over && out.over->kind == Expr::Kind::Range;
        out.local = local.index;
        const bool again =
            std::any_of(place.locals.begin(), place.locals.end(), [&](const auto& l) { return l.name == local.name; });
        if (again || ctx.names.params.contains(local.name))
            ctx.diagnostics.error(written.variable.span,
                                  fmt::format("'{}' {}", local.name, meaningOf(ctx, place, local.name)),
                                  "give the loop's variable another name");
        else if (local.name != "i" && isTaken(local.name))
            ctx.diagnostics.error(
                written.variable.span,
                fmt::format("'{}' is a word of the language and can't name a loop's variable", local.name));
        place.locals.push_back(std::move(local));
        if (written.guard) out.guard = checkExpression(ctx, place, *written.guard, Want::Truth, "'when'");
    } else if (written.over) {
        const bool isWhile = written.kind == syntax::Element::Kind::While;
        out.guard = checkExpression(ctx, place, *written.over, Want::Truth, isWhile ? "'while'" : "'when'");
        if (const auto holds = fold(*out.guard, {}); isWhile && holds && holds->truth())
            ctx.diagnostics.error(out.guard->span, "this 'while' never ends: its condition always holds");
    }
    out.body = std::make_shared<Body>(written.body ? checkBody(ctx, place, *written.body) : Body{});
    place.leave(outside);
}

/// A value of the body: in sight from here to the end of the body.
void checkLet(CheckContext& ctx, Place& place, const syntax::Element& written, Element& out) {
    const std::string& name = written.variable.text;
    place.enter("let " + name);
    place.material = true;
    Typed value = written.over ? checkExpression(ctx, place, *written.over) : Typed{{}, Type::unknown()};
    place.material = false;
    const bool isWord = isTaken(name) || axisNumber(name) >= 0;
    const std::string meaning =
        isWord ? "is a word of the language and can't name a value" : meaningOf(ctx, place, name);
    if (!meaning.empty())
        ctx.diagnostics.error(written.variable.span, fmt::format("'{}' {}", name, meaning),
                              "give the value another name");
    out.over = std::move(value.expr);
    out.local = place.frame++;
    place.locals.push_back({name, out.local, value.type});
}

void checkChoose(CheckContext& ctx, Place& place, const syntax::Element& written, Element& out) {
    if (!written.variable.empty())
        if (const auto* local =
                findCounter(ctx, place, written.variable.span, written.variable.text, written.cases.size())) {
            out.series = written.variable.text == "distinct" ? Series::Distinct : Series::Shuffled;
            out.local = local->index;
        }
    for (const syntax::Case& c : written.cases) {
        Choice choice;
        choice.weight = makeConstant(c.span, Value::number(1));
        place.enter("weight");
        if (c.label) choice.weight = checkWeight(ctx, place, *c.label);
        if (c.repeated || !c.tag.empty()) ctx.diagnostics.error(c.span, "a choice is 'weight: body'");
        choice.body = std::make_shared<Body>(c.body ? checkBody(ctx, place, *c.body) : Body{});
        out.choices.push_back(std::move(choice));
    }
    std::vector<const Expr*> weights;
    for (const Choice& c : out.choices) weights.push_back(&c.weight);
    checkWeights(ctx, weights, written.span);
    const auto grow = [](const Choice& c) { return grows(*c.body); };
    if (std::any_of(out.choices.begin(), out.choices.end(), grow))
        for (const Choice& c : out.choices)
            if (c.body->span.source && !grow(c) && !isNil(*c.body))  // without one the text was refused before
                ctx.diagnostics.error(c.body->span, "this alternative replaces what stands, but others grow on it",
                                      "begin every alternative with an operator, or none");
}

Element checkElement(CheckContext& ctx, Place& place, const syntax::Element& written) {
    using Kind = syntax::Element::Kind;
    Element out;
    out.span = written.span;
    out.op = written.op;
    out.inMatchedFrame = versionOf(ctx.grammar, written.span) >= 2;
    switch (written.kind) {
        case Kind::Shape:
        case Kind::Group:
            checkShape(ctx, place, written, out);
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
            checkChoose(ctx, place, written, out);
            return out;
        case Kind::Let:
            out.kind = Element::Kind::Let;
            out.label = "let " + written.variable.text;
            checkLet(ctx, place, written, out);
            return out;
    }
    checkLoop(ctx, place, written, out);
    return out;
}

/// A shape of a sibling that is alone in it and only says how large it is, or where.
void warnOfNothing(CheckContext& ctx, const std::vector<syntax::Element>& chain, const std::vector<Element>& checked) {
    const auto isShape = [](const syntax::Element& e) { return e.kind != syntax::Element::Kind::Let; };
    const auto alone = std::ranges::find_if(chain, isShape);
    if (std::ranges::count_if(chain, isShape) != 1 || alone->kind != syntax::Element::Kind::Shape) return;
    const Element& element = checked[static_cast<size_t>(alone - chain.begin())];
    const bool reports = std::ranges::any_of(
        element.prefix, [](const Attribute& a) { return a.operation->phase == Operation::Phase::Whole; });
    const bool names = alone->solid || !alone->live.empty() || !element.label.empty();
    if (alone->before.empty() || names || element.op != Operator::None || reports) return;
    ctx.diagnostics.warning(alone->span, "this adds nothing: it names no shape",
                            "name one behind it, such as 'cube', or write 'nil' where nothing is meant");
}

}  // namespace

Body checkBody(CheckContext& ctx, Place& place, const syntax::Body& written) {
    Body result;
    result.span = written.span;
    const size_t outside = place.locals.size();
    for (const auto& chain : written.siblings) {
        std::vector<Element>& elements = result.siblings.emplace_back();
        for (const syntax::Element& e : chain) elements.push_back(checkElement(ctx, place, e));
        warnOfNothing(ctx, chain, elements);
        if (!elements.empty() && elements.back().kind == Element::Kind::Let)
            ctx.diagnostics.error(elements.back().span, "no shape stands behind this value",
                                  "write the shape behind it");
    }
    place.leave(outside);
    result.grows = grows(result);
    return result;
}

}  // namespace sgm::rules
