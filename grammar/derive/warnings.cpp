// What a derivation tells of itself: what was hardly meant, and why nothing is left of it.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "grammar/derive/derive.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/traverse.h"

namespace sgm::derive {

namespace {

/// Where the elements of loops begin that ask for one joint of the matched shape: the first copy closes it.
std::set<std::pair<const syntax::Source*, uint32_t>> sharedJoints(const rules::Grammar& grammar) {
    std::set<std::pair<const syntax::Source*, uint32_t>> places;
    const auto isOne = [](const rules::Element& e) {
        return e.kind == rules::Element::Kind::Shape && e.at && !e.at->free && !e.at->each &&
               e.at->joints.size() == 1 && e.at->joints[0].kind == rules::Expr::Kind::Constant && !e.on;
    };
    const auto look = [&](const rules::Element& e) {
        if (e.kind != rules::Element::Kind::For) return;
        for (const auto& chain : e.body->siblings)
            if (!chain.empty() && isOne(chain[0])) places.insert({chain[0].span.source, chain[0].span.begin});
    };
    for (const rules::Rule& rule : grammar.rules) {
        rules::forEachElement(rule.body, look);
        if (rule.finally_) rules::forEachElement(*rule.finally_, look);
    }
    for (const rules::Start& start : grammar.starts) rules::forEachElement(start.body, look);
    return places;
}

/// The elements, by their places, before which another newcomer stands in their chain, and which don't say on what they
/// grow.
std::set<std::pair<const syntax::Source*, uint32_t>> laterNewcomers(const rules::Grammar& grammar) {
    std::set<std::pair<const syntax::Source*, uint32_t>> places;
    const auto isNewcomer = [](const rules::Element& e) { return e.op != rules::Operator::None; };
    const std::function<void(const rules::Body&)> visit = [&](const rules::Body& body) {
        for (const auto& chain : body.siblings) {
            bool follows = false;
            for (const rules::Element& e : chain) {
                if (follows && isNewcomer(e) && !e.on) places.insert({e.span.source, e.span.begin});
                follows = follows || isNewcomer(e);
                rules::forEachInnerBody(e, visit);
            }
        }
    };
    for (const rules::Start& start : grammar.starts) visit(start.body);
    for (const rules::Rule& rule : grammar.rules) {
        visit(rule.body);
        if (rule.finally_) visit(*rule.finally_);
    }
    return places;
}

/// Why an element grew nowhere: the shapes that closed its joints where it came first.
std::string whyNowhere(const Derivation& derivation, const Closed& closed, bool asksFree) {
    const std::string closer = closedBy(derivation, closed);
    if (asksFree)
        return "none of these joints is free any more, so this grows nowhere" + (closer.empty() ? "" : ": " + closer);
    return (closer.empty() ? "another shape has closed its joint" : closer) + ", so this grows nowhere";
}

}  // namespace

syntax::Diagnostics ungrown(const Derivation& derivation) {
    syntax::Diagnostics warnings;
    if (derivation.closed.empty()) return warnings;
    const auto shared = sharedJoints(*derivation.grammar), later = laterNewcomers(*derivation.grammar);
    for (const Closed& closed : derivation.closed) {
        const auto isOf = [&](const Shape& s) {
            return s.span.source == closed.span.source && s.span.begin == closed.span.begin &&
                   s.span.end == closed.span.end;
        };
        const auto& shapes = derivation.tree.shapes;
        const bool asksFree = closed.span.text().find("at free") != std::string_view::npos;
        if (std::none_of(shapes.begin(), shapes.end(), isOf))
            warnings.warning(closed.span, whyNowhere(derivation, closed, asksFree),
                             asksFree ? "name more joints in 'free(…)', or place it by 'move'"
                             : later.contains({closed.span.source, closed.span.begin})
                                 ? "write 'on last' to let it grow on the shape before it, choose another "
                                   "joint of ours, 'at free(…)', or place it by 'move'"
                                 : "choose another joint of ours, 'at free(…)', or place it by 'move'");
        else if (shared.contains({closed.span.source, closed.span.begin}))
            warnings.warning(closed.span,
                             fmt::format("the first of these copies closes the joint that all ask for, so {} grew "
                                         "nowhere",
                                         closed.count),
                             "leave 'at' out and place the copies by 'move'");
    }
    return warnings;
}

namespace {

/// Whether nothing stands at a shape, which no chain made in passing.
bool isEmpty(const ShapeTree& tree, ShapeId id) {
    const Shape shape = tree.shapes[id];
    const Extras* extras = tree.extrasOf(id);
    return shape.firstChild == none && shape.solid == none && shape.chainRule == none &&
           (!extras || extras->object == none);
}

/// Whether the shape ends a recursion: one above it has its symbol.
bool isWithinOwn(const ShapeTree& tree, ShapeId id) {
    const rules::SymbolId symbol = tree.shapes[id].symbol;
    for (ShapeId above = tree.shapes[id].parent; above != none; above = tree.shapes[above].parent)
        if (tree.shapes[above].symbol == symbol) return true;
    return false;
}

/// Whether an element of the rule met a closed joint.
bool isClosed(const Derivation& derivation, const rules::Rule& rule) {
    return std::any_of(derivation.closed.begin(), derivation.closed.end(), [&](const Closed& c) {
        return c.span.source == rule.span.source && c.span.begin >= rule.span.begin && c.span.end <= rule.span.end;
    });
}

}  // namespace

syntax::Diagnostics unmatched(const Derivation& derivation) {
    syntax::Diagnostics warnings;
    if (derivation.planAlone || derivation.isAlongWay) return warnings;
    const rules::Grammar& grammar = *derivation.grammar;
    std::map<rules::SymbolId, ShapeId> first;
    for (ShapeId s = 0; s != none && !derivation.tree.shapes.empty(); s = derivation.tree.next(s)) {
        if (!derivation.tree.shapes.record(s).live || !isEmpty(derivation.tree, s)) continue;
        const rules::SymbolId symbol = derivation.tree.shapes[s].symbol;
        if (symbol != rules::none && !isWithinOwn(derivation.tree, s)) first.try_emplace(symbol, s);
    }
    for (const auto& [id, shape] : first) {
        const rules::Symbol& symbol = grammar.symbols[id];
        // What a rule without a condition doesn't match has closed joints, of which `ungrown` tells; what parameters
        // decide is a switch. A `beside` is a condition.
        const auto asksTheShape = [&](uint32_t r) {
            const rules::Rule& rule = grammar.rules[r];
            const bool isConditional = rule.when && !rules::fold(*rule.when, derivation.params);
            return (isConditional || rule.beside != rules::none) && !isClosed(derivation, rule);
        };
        if (symbol.rules.empty() || !std::all_of(symbol.rules.begin(), symbol.rules.end(), asksTheShape)) continue;
        const rules::Rule& rule = grammar.rules[symbol.rules[0]];
        warnings.warning(rule.when ? rule.when->span : rule.symbolSpan,
                         fmt::format("a '{}' that no rule matches stays empty", symbol.name),
                         fmt::format("the first is '{0}'; add 'rule {1} -> …' for it, or 'rule {1} -> nil' where "
                                     "nothing is meant",
                                     derivation.tree.path(shape), symbol.name));
    }
    return warnings;
}

Error nothingSolid(const Derivation& derivation) {
    const std::string root = derivation.tree.path(0);
    syntax::Diagnostics causes = derivation.selections.warnings(&derivation.tree);
    if (causes.all().empty()) causes = warnings(derivation);
    if (causes.all().empty())
        return syntax::errorAt(derivation.tree.shapes[0].span, Error::Kind::Input,
                               fmt::format("nothing solid is left of '{}': name a solid in it, such as 'cube'", root));
    const syntax::Diagnostic& cause = causes.all().front();
    return syntax::errorAt(cause.span, Error::Kind::Input,
                           fmt::format("{}, and nothing solid is left of '{}'; {}", cause.message, root, cause.hint));
}

syntax::Diagnostics warnings(const Derivation& derivation) {
    std::vector<syntax::Diagnostic> list;
    for (const Warning& r : derivation.warnings) list.push_back({syntax::Severity::Warning, r.span, r.message, r.hint});
    for (const syntax::Diagnostics& found : {derivation.selections.warnings(&derivation.tree), ungrown(derivation),
                                             unmatched(derivation), uncut(derivation), unseenLooks(derivation)})
        list.insert(list.end(), found.all().begin(), found.all().end());
    const auto& sources = derivation.grammar->sources;
    const auto rank = [&](const syntax::Diagnostic& d) {
        const auto at =
            std::find_if(sources.begin(), sources.end(), [&](const auto& s) { return s.get() == d.span.source; });
        return std::pair(at - sources.begin(), d.span.begin);
    };
    std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    syntax::Diagnostics sorted;
    for (syntax::Diagnostic& d : list) sorted.warning(d.span, std::move(d.message), std::move(d.hint));
    return sorted;
}

}  // namespace sgm::derive
