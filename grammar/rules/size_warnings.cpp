// Sizes that do something else than they seem to: shares of a start's scope of 1 m, none at all, heights that nothing
// reads.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/rules/evaluate.h"
#include "grammar/rules/params.h"
#include "grammar/rules/static_analysis.h"
#include "grammar/rules/traverse.h"
#include "grammar/rules/value.h"

namespace sgm::rules {
namespace {

/// Whether a component is a share other than 0 and 100 %.
bool isShare(const Value& v) {
    for (size_t i = 0; i < std::min<size_t>(v.count, v.units.size()); ++i)
        if (v.units[i] == Unit::Share && v.n[i] != 1 && v.n[i] != 0) return true;
    return false;
}

/// Whether such a share is written somewhere in it.
bool holdsShare(const Expr& e) {
    if (e.kind == Expr::Kind::Constant && isShare(e.value)) return true;
    return std::any_of(e.args.begin(), e.args.end(), holdsShare);
}

bool takes(const Attribute& a, syntax::ArgumentType type) {
    return !a.args.empty() && !a.operation->arguments.empty() && a.operation->arguments[0].type == type;
}

bool givesSize(const Attribute& a) { return takes(a, syntax::ArgumentType::Size); }

/// Whether anything says how large the element is: a size, a plan, a height, or points that it spans.
bool isSized(const Element& e) {
    const auto sizes = [](const Attribute& a) {
        return a.operation->phase == Operation::Phase::Scope &&
               (givesSize(a) || a.plan || takes(a, syntax::ArgumentType::Length) ||
                takes(a, syntax::ArgumentType::Point));
    };
    return std::any_of(e.prefix.begin(), e.prefix.end(), sizes) ||
           std::any_of(e.attributes.begin(), e.attributes.end(), sizes);
}

/// Whether 100 % of a width stands beside a length, as in the size of a roof that is meant for what stands already.
bool isWholeBesideLength(const Value& v) {
    bool hasWhole = false, hasLength = false;
    for (size_t i = 0; i < std::min<size_t>(v.count, v.units.size()); ++i) {
        hasWhole |= i != 1 && v.units[i] == Unit::Share && v.n[i] == 1;
        hasLength |= v.units[i] == Unit::Metre && v.n[i] != 0;
    }
    return hasWhole && hasLength;
}

/// Warns of a share among the sizes and moves of an element whose scope is that of a start, 1 m; of 100 % where it
/// `joins` what stands.
void findSharesOfNothing(const Element& element, bool joins, const std::vector<Value>& params,
                         syntax::Diagnostics& diagnostics) {
    for (const Attribute& a : element.attributes) {
        const bool moves = a.operation->phase == Operation::Phase::Scope && takes(a, syntax::ArgumentType::Vector);
        if (!givesSize(a) && !moves) continue;
        const auto value = fold(a.args[0], params);
        const bool isWhole = joins && givesSize(a) && value && isWholeBesideLength(*value);
        if (isWhole || (value ? isShare(*value) : holdsShare(a.args[0])))
            diagnostics.warning(a.span, "a share of what? A start's own scope is 1m",
                                isWhole ? "write lengths; in a rule of what the start names 100% is that shape's size"
                                        : "write lengths, such as '.5m' for 50%");
    }
}

/// Whether a rule for the symbol fills its scope with a solid whose size nothing says.
bool fillsScope(const Grammar& grammar, SymbolId symbol) {
    return std::ranges::any_of(grammar.symbols[symbol].rules, [&](uint32_t r) {
        const Body& body = grammar.rules[r].body;
        return !body.grows && std::ranges::any_of(body.siblings, [&](const std::vector<Element>& chain) {
            const Element* first = chain.empty() ? nullptr : &chain[0];
            if (!first || first->kind != Element::Kind::Shape || isSized(*first)) return false;
            if (const Solid* solid = first->content.solid()) return solid->kind != Solid::Kind::Nil;
            return first->content.symbol() != none && grammar.symbols[first->content.symbol()].terminal;
        });
    });
}

/// Whether a shape is a roof, whose pitch tells its height.
bool hasOwnHeight(const Element& e) {
    const Solid* solid = e.content.solid();
    return solid && solid->primitive && solid->primitive->plan == field::PlanUse::OwnHeight;
}

/// Whether a size says three components of which the second is a length.
bool saysHeight(const Attribute& a) {
    if (a.operation->phase != Operation::Phase::Scope || !givesSize(a)) return false;
    const Expr& size = a.args[0];
    const auto value = fold(size, {});
    if (value) return value->kind == Value::Kind::Vector && value->count == 3 && value->units[1] == Unit::Metre;
    if (size.kind != Expr::Kind::Tuple || size.args.size() != 3) return false;
    const auto height = fold(size.args[1], {});
    return height && height->units[0] == Unit::Metre;
}

/// Whether an element has another plan than the scope that it stands in, as far as constants tell.
bool hasOtherPlan(const Element& e) {
    const auto changes = [](const Attribute& a) {
        if (a.operation->phase != Operation::Phase::Scope) return false;
        if (a.plan) return true;
        if (!givesSize(a)) return false;
        for (const size_t axis : {0u, 2u}) {
            const auto value = fold(sizeAlong(a.args[0], axis), {});
            const size_t at = value && value->count == 3 ? axis : 0;
            if (value && (value->units[at] == Unit::Metre || (value->units[at] == Unit::Share && value->n[at] != 1)))
                return true;
        }
        return false;
    };
    return std::any_of(e.prefix.begin(), e.prefix.end(), changes) ||
           std::any_of(e.attributes.begin(), e.attributes.end(), changes);
}

}  // namespace

void findSharesOfNothing(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    for (uint32_t s = 0; s < grammar.starts.size(); ++s) {
        const std::vector<Value> params = valuesOf(grammar, s);
        for (const auto& chain : grammar.starts[s].body.siblings) {
            if (chain.empty() || chain[0].kind != Element::Kind::Shape || chain[0].content.empty()) continue;
            const bool hasSize = std::any_of(chain[0].prefix.begin(), chain[0].prefix.end(), givesSize);
            for (const Element& element : chain)
                if (&element == &chain[0] ? !hasSize : element.inMatchedFrame && !element.on)
                    findSharesOfNothing(element, &element != &chain[0], params, diagnostics);
        }
    }
}

void findUnsized(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    for (const Start& start : grammar.starts) {
        for (const auto& chain : start.body.siblings) {
            if (chain.empty() || chain[0].kind != Element::Kind::Shape || !isSized(chain[0])) continue;
            for (size_t i = 1; i < chain.size(); ++i) {
                const Element& e = chain[i];
                if (e.kind != Element::Kind::Shape || !e.inMatchedFrame || e.on || isSized(e)) continue;
                if (e.content.solid() && e.content.solid()->kind == Solid::Kind::Nil) continue;
                const SymbolId symbol = e.content.symbol();
                if (!e.content.solid() &&
                    (symbol == none || !(grammar.symbols[symbol].terminal || fillsScope(grammar, symbol))))
                    continue;
                diagnostics.warning(
                    e.span, fmt::format("'{}' has no size, and a start's own scope is 1m", e.label),
                    fmt::format("write its size, such as 'size (4, {}, 4)'; in a rule of what the start names it fills "
                                "that shape's scope",
                                hasOwnHeight(e) ? "100%" : "3"));
            }
        }
    }
}

void findRoofsOverTheScope(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    for (const Rule& rule : grammar.rules) {
        if (rule.span.source != grammar.sources[0].get()) continue;
        for (const auto& chain : rule.body.siblings) {
            if (chain.empty() || chain[0].kind != Element::Kind::Shape || !hasOtherPlan(chain[0])) continue;
            for (size_t i = 1; i < chain.size(); ++i) {
                const Element& e = chain[i];
                if (e.kind != Element::Kind::Shape || e.op != Operator::Sum || !e.inMatchedFrame || e.on ||
                    !hasOwnHeight(e) || isSized(e))
                    continue;
                diagnostics.warning(e.span,
                                    fmt::format("'{}' stands over the whole scope of '{}', not over the '{}' before it",
                                                e.label, grammar.symbols[rule.symbol].name, chain[0].label),
                                    fmt::format("write ': Top' behind '{}' and 'rule Top -> + {} … at +y', or give "
                                                "the roof the same footprint or size",
                                                chain[0].label, e.label));
            }
        }
    }
}

void findUnusedHeights(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const auto look = [&](const Element& e) {
        if (e.span.source != grammar.sources[0].get()) return;
        // Of a roof that nothing joins the height says where its foot stands.
        const bool isRoof = e.op != Operator::None && hasOwnHeight(e);
        const auto spans = [](const Attribute& a) { return takes(a, syntax::ArgumentType::Point); };
        const bool isSpan = std::any_of(e.attributes.begin(), e.attributes.end(), spans);
        if (!isRoof && !isSpan) return;
        const std::string what =
            isSpan ? "'from … to …' says how long the shape is"
                   : fmt::format("'{}' is as high as its parameters make it", e.content.solid()->primitive->name);
        // A size before the shape says what its shares are of as well.
        for (const Attribute& a : e.attributes)
            if (saysHeight(a))
                diagnostics.warning(a.span, fmt::format("the height of this size does nothing: {}", what),
                                    "write '100%' for it");
    };
    for (const Start& start : grammar.starts) forEachElement(start.body, look);
    for (const Rule& rule : grammar.rules) {
        forEachElement(rule.body, look);
        if (rule.finally_) forEachElement(*rule.finally_, look);
    }
}

}  // namespace sgm::rules
