#include "grammar/rules/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "grammar/rules/evaluate.h"

namespace sgm::rules {
namespace {

using Id = Operation::Id;

template <class Visit>
void eachElement(const Body& body, Visit visit);

template <class Visit>
void eachPart(const std::vector<Split::Part>& parts, Visit visit) {
    for (const Split::Part& part : parts) {
        if (part.body) eachElement(*part.body, visit);
        eachPart(part.repeated, visit);
    }
}

/// Calls `visit` with every element of a body, groups and alternatives included.
template <class Visit>
void eachElement(const Body& body, Visit visit) {
    for (const auto& chain : body.siblings)
        for (const Element& e : chain) {
            visit(e);
            if (e.content.group) eachElement(*e.content.group, visit);
            if (e.body) eachElement(*e.body, visit);
            if (e.content.split) eachPart(e.content.split->parts, visit);
            for (const Choice& c : e.choices) eachElement(*c.body, visit);
        }
}

std::set<SymbolId> reachable(const Grammar& grammar) {
    std::set<SymbolId> found;
    std::vector<SymbolId> open;
    const auto add = [&](SymbolId id) {
        if (id != none && found.insert(id).second) open.push_back(id);
    };
    const auto addAll = [&](const Body& body) {
        eachElement(body, [&](const Element& e) {
            add(e.content.symbol);
            add(e.live);
        });
    };
    for (const Start& start : grammar.starts) addAll(start.body);
    while (!open.empty()) {
        const SymbolId id = open.back();
        open.pop_back();
        for (const uint32_t rule : grammar.symbols[id].rules) {
            addAll(grammar.rules[rule].body);
            if (grammar.rules[rule].finally_) addAll(*grammar.rules[rule].finally_);
        }
    }
    return found;
}

/// The value of a condition or number where no parameter, shape or chance can change it.
std::optional<double> certain(const std::optional<Expr>& e) {
    if (!e) return std::nullopt;
    const auto value = fold(*e, {});
    return value ? std::optional(value->num()) : std::nullopt;
}
bool alwaysHolds(const std::optional<Expr>& e) { return !e || certain(e).value_or(0) != 0; }

/// Finds symbols that may end, by least fixpoint: a symbol may end when one of its rules may, a rule when its body can
/// be had without a symbol that may not.
class Endings {
public:
    explicit Endings(const Grammar& grammar) : grammar_(grammar), ends_(grammar.symbols.size(), false) {
        for (bool changed = true; changed;) {
            changed = false;
            for (SymbolId id = 0; id < ends_.size(); ++id)
                if (!ends_[id] && mayEnd(grammar.symbols[id])) changed = ends_[id] = true;
        }
    }

    bool ends(SymbolId id) const { return ends_[id]; }

    /// A rule of an endless symbol, and an endless symbol it makes.
    std::pair<uint32_t, SymbolId> next(SymbolId id) const {
        for (const uint32_t index : grammar_.symbols[id].rules) {
            const Rule& rule = grammar_.rules[index];
            if (neverDrawn(rule)) continue;
            SymbolId made = none;
            eachElement(rule.body, [&](const Element& e) {
                const SymbolId live = rule.repeat ? none : e.live;
                for (const SymbolId s : {live, e.content.symbol})
                    if (made == none && s != none && !ends_[s]) made = s;
            });
            if (made != none) return {index, made};
        }
        return {none, none};
    }

private:
    static bool neverDrawn(const Rule& rule) { return rule.weight && certain(rule.weight).value_or(1) == 0; }

    bool mayEnd(const Symbol& symbol) const {
        bool drawn = false;
        for (const uint32_t index : symbol.rules) {
            const Rule& rule = grammar_.rules[index];
            if (neverDrawn(rule)) continue;
            drawn = true;
            if (mayFail(rule) || bodyMayEnd(rule.body, rule.repeat.has_value())) return true;
        }
        return !drawn;
    }

    /// May the rule find nothing to match? A guard may fail, a neighbour be missing, a joint be taken. Growth straight
    /// on along one axis always finds the next joint free, and only that is held for certain.
    static bool mayFail(const Rule& rule) {
        if (rule.beside != none || !alwaysHolds(rule.when)) return true;
        if (rule.repeat && certain(rule.repeat).value_or(0) < 1) return true;
        bool fails = false;
        std::set<double> used;
        eachElement(rule.body, [&](const Element& e) {
            for (const Attribute& a : e.attributes) {
                const Expr* joint = a.joints.empty() ? nullptr : &a.joints[0];
                const bool axis =
                    joint && joint->kind == Expr::Kind::Constant && joint->value.kind == Value::Kind::Axis;
                if (a.id == Id::At)
                    fails =
                        fails || a.free || !axis || joint->value.num() > 5 || !used.insert(joint->value.num()).second;
                if (a.id == Id::To) fails = fails || !axis || joint->value.num() < 6;
                if (a.id == Id::Turn) fails = true;
            }
        });
        return fails || used.size() > 1;
    }

    bool bodyMayEnd(const Body& body, bool chain) const {
        for (const auto& siblings : body.siblings)
            for (const Element& e : siblings)
                if (!elementMayEnd(e, chain)) return false;
        return true;
    }

    bool elementMayEnd(const Element& e, bool chain) const {
        switch (e.kind) {
            case Element::Kind::Shape:
                if (e.content.split) return true;  // parts shrink, and those without extent vanish
                if (e.content.symbol != none && !ends_[e.content.symbol]) return false;
                if (!chain && e.live != none && !ends_[e.live]) return false;  // in a chain it starts none of its own
                return !e.content.group || bodyMayEnd(*e.content.group, chain);
            case Element::Kind::For:
                return !alwaysHolds(e.guard) || !runsOnce(*e.over) || bodyMayEnd(*e.body, chain);
            case Element::Kind::While:
                return true;
            case Element::Kind::When:
                return !alwaysHolds(e.guard) || bodyMayEnd(*e.body, chain);
            case Element::Kind::Choose:
                return std::any_of(e.choices.begin(), e.choices.end(), [&](const Choice& c) {
                    return certain(c.weight).value_or(1) != 0 && bodyMayEnd(*c.body, chain);
                });
        }
        return true;
    }

    static bool runsOnce(const Expr& over) {
        if (over.kind == Expr::Kind::Tuple) return !over.args.empty();
        if (over.kind != Expr::Kind::Range || over.args.size() != 2) return false;
        const auto lo = fold(over.args[0], {}), hi = fold(over.args[1], {});
        return lo && hi && lo->num() <= hi->num();
    }

    const Grammar& grammar_;
    std::vector<bool> ends_;
};

/// Growth along different axes may meet itself again and find its joints taken: then nothing is proven.
bool oneAxis(const Grammar& grammar, const std::vector<uint32_t>& cycle) {
    std::set<double> axes;
    for (const uint32_t rule : cycle)
        eachElement(grammar.rules[rule].body, [&](const Element& e) {
            for (const Attribute& a : e.attributes)
                if (a.id == Id::At && !a.joints.empty()) axes.insert(a.joints[0].value.num());
        });
    return axes.size() <= 1;
}

void report(const Grammar& grammar, const std::vector<uint32_t>& cycle, syntax::Diagnostics& diagnostics) {
    const Rule& first = grammar.rules[cycle[0]];
    const std::string& symbol = grammar.symbols[first.symbol].name;
    std::string message =
        fmt::format("rule '{}' never ends: every '{}' makes another '{}'", first.name, symbol, symbol);
    if (cycle.size() > 1) {
        std::string way;
        for (const uint32_t rule : cycle)
            way += fmt::format("'{}' ({}) -> ", grammar.symbols[grammar.rules[rule].symbol].name,
                               grammar.rules[rule].name);
        message = fmt::format("rule '{}' never ends: {}'{}'", first.name, way, symbol);
    }
    diagnostics.error(first.symbolSpan, std::move(message),
                      "give a rule a 'when' or a 'repeat', or 'choose' with an alternative that stops");
}

}  // namespace

void findUnreachable(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const std::set<SymbolId> found = reachable(grammar);
    for (const Rule& rule : grammar.rules)
        if (!found.contains(rule.symbol) && rule.span.source == grammar.sources[0].get())
            diagnostics.warning(rule.symbolSpan, fmt::format("this rule never runs: no start leads to a '{}'",
                                                             grammar.symbols[rule.symbol].name));
}

void findEndless(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const Endings endings(grammar);
    std::set<SymbolId> said;
    for (const SymbolId id : reachable(grammar)) {
        // Follow what is always made until it comes round.
        std::vector<SymbolId> walk;
        std::vector<uint32_t> rules;
        for (SymbolId at = id; at != none && !endings.ends(at);) {
            const auto again = std::find(walk.begin(), walk.end(), at);
            if (again != walk.end()) {
                std::vector<uint32_t> cycle(rules.begin() + (again - walk.begin()), rules.end());
                std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
                if (said.insert(grammar.rules[cycle[0]].symbol).second && oneAxis(grammar, cycle))
                    report(grammar, cycle, diagnostics);
                break;
            }
            walk.push_back(at);
            const auto [rule, made] = endings.next(at);
            rules.push_back(rule);
            at = made;
        }
    }
}

}  // namespace sgm::rules
