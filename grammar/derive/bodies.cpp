// Control in the bodies of rules: siblings, for, while, when, choose; and what fills a shape.
#include <bit>
#include <cmath>

#include "grammar/derive/parts_context.h"
#include "modeler/core/random.h"

namespace sgm::derive {

using rules::Element;
using rules::Value;

namespace {

/// A loop's turn is known by its value, so inserting a direction leaves the draws of the others alone.
uint64_t turnKey(uint64_t loop, double value) { return combine(loop, std::bit_cast<uint64_t>(value + 0.0)); }

/// What `for` runs over: the values of a tuple or vector, or the integers of a range.
std::vector<Value> valuesOver(const rules::Expr& over, const Place& place) {
    std::vector<Value> values;
    if (over.kind == rules::Expr::Kind::Tuple) {
        for (const rules::Expr& arg : over.args) values.push_back(evaluate(arg, place));
        return values;
    }
    const Value v = evaluate(over, place);
    for (uint8_t k = 0; k < v.count; ++k) {
        Value one;
        one.kind = v.kind == Value::Kind::Vector ? Value::Kind::Number : v.kind;
        one.n[0] = v.n[k];
        one.units[0] = v.units[std::min<size_t>(k, v.units.size() - 1)];
        one.integer = v.integer;
        one.text = v.text;
        values.push_back(std::move(one));
    }
    return values;
}

/// The value of a `let`: a range of whole numbers gives one of them.
Value drawnOnce(const rules::Expr& expr, const Place& place) {
    const bool whole = expr.kind == rules::Expr::Kind::Range && evaluate(expr.args[0], place).integer &&
                       evaluate(expr.args[1], place).integer;
    if (!whole) return evaluate(expr, place);
    Value value = Value::number(wholeNumber(expr, place));
    value.integer = true;
    return value;
}

}  // namespace

bool Interpreter::runBody(const rules::Body& body, const Frame& frame, uint64_t loop) {
    for (const Elements& sibling : body.siblings) {
        Frame own = frame;
        Target target{frame.node, frame.matched};
        if (!runElements(sibling, own, target, loop, false)) return false;
    }
    return true;
}

/// The body of a loop or a choice goes on with the chain it stands in.
bool Interpreter::runInner(const rules::Body& body, Frame& frame, Target& target, uint64_t loop, bool followed) {
    for (const Elements& sibling : body.siblings) {
        Target own = target;
        Frame inner = frame;
        if (!runElements(sibling, inner, own, loop, followed)) return false;
        if (body.siblings.size() == 1) target = own;
    }
    return true;
}

bool Interpreter::runElements(const Elements& elements, Frame& frame, Target& target, uint64_t loop, bool followed) {
    for (const Element& e : elements)
        if (!runElement(e, frame, target, loop, followed || elements.size() > 1)) return false;
    return true;
}

bool Interpreter::runElement(const Element& e, Frame& frame, Target& target, uint64_t loop, bool followed) {
    switch (e.kind) {
        case Element::Kind::For:
            return runFor(e, frame, target, loop, followed);
        case Element::Kind::While:
            return runWhile(e, frame, target, loop, followed);
        case Element::Kind::Choose:
            return runChoose(e, frame, target, loop, followed);
        case Element::Kind::When:
            frame.place.key = combine(combine(frame.key, hashText("when")), loop);
            return !e.guard || !holds(*e.guard, frame.place) || runInner(*e.body, frame, target, loop, followed);
        case Element::Kind::Let: {
            Place place = frame.place;
            place.key = combine(combine(frame.key, hashText(e.label)), loop);
            locals_[e.local] = drawnOnce(*e.over, place);
            return !builder_.monitor().failed();
        }
        case Element::Kind::Shape:
            break;
    }
    const uint64_t key = combine(combine(frame.key, maker_.factsOf(e).hash), loop);
    if (e.content.empty()) {
        annotate(e, frame, key);
        return !builder_.monitor().failed();
    }
    const bool nil = e.content.solid() && e.content.solid()->kind == rules::Solid::Kind::Nil;
    if (nil && e.op != rules::Operator::Intersection) return true;
    return e.op == rules::Operator::None ? placeHead(e, frame, target, key, followed)
                                         : placeGrown(e, frame, target, key);
}

bool Interpreter::runFor(const Element& e, Frame& frame, Target& target, uint64_t loop, bool followed) {
    frame.place.key = combine(combine(frame.key, hashText("for")), loop);
    const auto turn = [&](Value value) {
        const uint64_t key = turnKey(loop, value.num());
        locals_[e.local] = std::move(value);
        frame.place.key = combine(combine(frame.key, hashText("for")), key);
        if (!builder_.monitor().work()) return false;
        return (e.guard && !holds(*e.guard, frame.place)) || runInner(*e.body, frame, target, key, followed);
    };
    if (e.over->kind != rules::Expr::Kind::Range) {
        for (Value& value : valuesOver(*e.over, frame.place))
            if (!turn(std::move(value))) return false;
        return true;
    }
    const double lo = std::ceil(number(e.over->args[0], frame.place)), hi = number(e.over->args[1], frame.place);
    for (double v = lo; v <= hi; ++v) {
        Value value = Value::number(v);
        value.integer = true;
        count(e.local, v, combine(frame.key, loop));
        if (!turn(std::move(value))) return false;
    }
    return true;
}

bool Interpreter::runWhile(const Element& e, Frame& frame, Target& target, uint64_t loop, bool followed) {
    for (uint64_t turn = 1;; ++turn) {
        const uint64_t key = turnKey(loop, static_cast<double>(turn));
        frame.place.key = combine(combine(frame.key, hashText("while")), key);
        if (!builder_.monitor().work()) return false;
        if (!e.guard || !holds(*e.guard, frame.place)) return true;
        if (!runInner(*e.body, frame, target, key, followed)) return false;
    }
}

bool Interpreter::runChoose(const Element& e, Frame& frame, Target& target, uint64_t loop, bool followed) {
    const uint64_t key = combine(combine(combine(frame.key, hashText("choose")), e.ordinal), loop);
    frame.place.key = key;
    std::vector<double> weights;
    for (const rules::Choice& c : e.choices) weights.push_back(number(c.weight, frame.place));
    if (weights.size() > 1) builder_.monitor().noteChance();
    const uint64_t draw = combine(hashText("choose"), e.ordinal);
    const uint32_t at = e.series == rules::Series::None
                            ? drawByWeight(weights, combine(key, hashText("weight")))
                            : drawInSeries(weights, e.series, e.local, draw, frame.place, e.span);
    if (at != none) return runInner(*e.choices[at].body, frame, target, loop, followed);
    builder_.monitor().fail(Error::Kind::Input, std::string(allZero), e.span);
    return false;
}

/// What stands inside a shape: the non-terminal that `: Name` wraps, the shapes of a group, or the parts of a content
/// operation.
bool Interpreter::fill(const Element& e, ShapeId id, const Frame& frame) {
    const Shape& s = builder_.tree().shapes[id];
    if (e.content.group() || e.content.parts()) {
        RunState state;
        state.root = state.last = id;
        Frame inner = frame;
        inner.matched = inner.node = id;
        inner.key = s.key;
        inner.state = &state;
        inner.wholeContent = false;
        inner.place.scope = s.scope;
        inner.place.host = id;
        inner.place.valuesAt = s.valuesAt;
        if (const rules::Body* group = e.content.group()) return runBody(*group, inner, 0);
        PartsContext parts(*this, inner);
        return e.content.parts()->operation->run(parts, *e.content.parts());
    }
    const rules::SymbolId symbol = e.content.symbol();
    if (e.live == rules::none || symbol == rules::none || grammar_.symbols[symbol].terminal) return true;
    Shape inner;
    inner.key = combine(s.key, hashText("content"));
    inner.parent = id;
    inner.symbol = symbol;
    inner.live = true;
    inner.scope = s.scope;
    inner.span = e.span;
    inner.label = maker_.labelIndex(grammar_.symbols[inner.symbol].name);
    return builder_.add(inner) != none;
}

}  // namespace sgm::derive
