#include "grammar/rules/static_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "grammar/rules/evaluate.h"
#include "grammar/rules/params.h"
#include "grammar/rules/traverse.h"
#include "grammar/rules/value.h"

namespace sgm::rules {
namespace {

std::set<SymbolId> reachable(const Grammar& grammar) {
    std::set<SymbolId> found;
    std::vector<SymbolId> open;
    const auto add = [&](SymbolId id) {
        if (id != none && found.insert(id).second) open.push_back(id);
    };
    const auto addAll = [&](const Body& body) {
        forEachElement(body, [&](const Element& e) {
            add(e.content.symbol());
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

/// By part of a split along an axis, the share of the scope that it has whatever the scope; empty where lengths,
/// repetitions, chance, edges or areas decide.
std::vector<double> sharesOf(const Parts& split) {
    if (!split.edges.empty() || split.byArea || split.snap) return {};
    double fixed = 0, floating = 0;
    std::vector<double> shares;
    for (const Parts::Part& part : split.parts) {
        const auto size = part.repeated.empty() ? fold(part.size, {}) : std::nullopt;
        if (!size || (!part.floating && size->units[0] != Unit::Share)) return {};
        (part.floating ? floating : fixed) += size->num();
        shares.push_back(size->num());
    }
    constexpr double rounding = 1e-9;
    double from = 0;
    for (size_t i = 0; i < shares.size(); ++i) {
        if (split.parts[i].floating) shares[i] *= floating > 0 ? std::max(0.0, 1 - fixed) / floating : 0;
        const double left = std::max(0.0, 1 - from);
        from += shares[i];
        shares[i] = std::min(shares[i], left);
        if (shares[i] < rounding) shares[i] = 0;
    }
    return shares;
}

/// Finds symbols that may end, by least fixpoint: a symbol may end when one of its rules may, a rule when its body can
/// be had without a symbol that may not.
class Endings {
public:
    explicit Endings(const Grammar& grammar) : grammar_(grammar), ends_(grammar.symbols.size(), false) {
        const std::vector<std::vector<SymbolId>> makes = madeBySymbols();
        std::vector<std::vector<SymbolId>> makers(makes.size());
        for (SymbolId id = 0; id < makes.size(); ++id)
            for (const SymbolId made : makes[id]) makers[made].push_back(id);
        // A symbol is looked at after those that it makes, and again when one of them turns out to end.
        std::vector<SymbolId> open = madeFirst(makes);
        std::vector<bool> waits(open.size(), true);
        for (size_t next = 0; next < open.size(); ++next) {
            const SymbolId id = open[next];
            waits[id] = false;
            if (ends_[id] || !mayEnd(grammar.symbols[id])) continue;
            ends_[id] = true;
            for (const SymbolId maker : makers[id])
                if (!ends_[maker] && !waits[maker]) open.push_back(maker), waits[maker] = true;
        }
    }

    bool ends(SymbolId id) const { return ends_[id]; }

    /// A rule of an endless symbol, and an endless symbol it makes.
    std::pair<uint32_t, SymbolId> next(SymbolId id) const {
        for (const uint32_t index : grammar_.symbols[id].rules) {
            const Rule& rule = grammar_.rules[index];
            if (neverDrawn(rule)) continue;
            SymbolId made = none;
            forEachElement(rule.body, [&](const Element& e) {
                const SymbolId live = rule.repeat ? none : e.live;
                for (const SymbolId s : {live, e.content.symbol()})
                    if (made == none && s != none && !ends_[s]) made = s;
            });
            if (made != none) return {index, made};
        }
        return {none, none};
    }

private:
    /// By symbol: the symbols that its rules make, each once.
    std::vector<std::vector<SymbolId>> madeBySymbols() const {
        std::vector<std::vector<SymbolId>> makes(ends_.size());
        for (SymbolId id = 0; id < makes.size(); ++id) {
            for (const uint32_t rule : grammar_.symbols[id].rules)
                forEachElement(grammar_.rules[rule].body, [&](const Element& e) {
                    for (const SymbolId s : {e.content.symbol(), e.live})
                        if (s != none) makes[id].push_back(s);
                });
            std::sort(makes[id].begin(), makes[id].end());
            makes[id].erase(std::unique(makes[id].begin(), makes[id].end()), makes[id].end());
        }
        return makes;
    }

    /// All symbols, each behind those that it makes wherever there is no circle.
    static std::vector<SymbolId> madeFirst(const std::vector<std::vector<SymbolId>>& makes) {
        std::vector<SymbolId> order;
        std::vector<bool> seen(makes.size(), false);
        std::vector<std::pair<SymbolId, size_t>> walk;  // a symbol, and which of those it makes is next
        for (SymbolId root = 0; root < makes.size(); ++root) {
            if (!seen[root]) walk.emplace_back(root, 0), seen[root] = true;
            while (!walk.empty()) {
                auto& [id, next] = walk.back();
                if (next == makes[id].size()) {
                    order.push_back(id);
                    walk.pop_back();
                } else if (const SymbolId made = makes[id][next++]; !seen[made]) {
                    seen[made] = true;
                    walk.emplace_back(made, 0);
                }
            }
        }
        return order;
    }

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
        forEachElement(rule.body, [&](const Element& e) {
            const auto axisOf = [](const JointChoice& choice) -> std::optional<double> {
                const Expr* joint = choice.joints.empty() ? nullptr : &choice.joints[0];
                const bool axis =
                    joint && joint->kind == Expr::Kind::Constant && joint->value.kind == Value::Kind::Axis;
                return axis ? std::optional(joint->value.num()) : std::nullopt;
            };
            if (e.at) {
                const auto axis = axisOf(*e.at);
                fails = fails || e.at->free || !axis || *axis > 5 || !used.insert(*axis).second;
            }
            if (e.to) fails = fails || axisOf(*e.to).value_or(0) < 6;
            for (const Attribute& a : e.attributes) fails = fails || a.operation->traits.turnsShape;
        });
        return fails || used.size() > 1;
    }

    bool bodyMayEnd(const Body& body, bool chain) const {
        for (const auto& siblings : body.siblings)
            for (const Element& e : siblings)
                if (!elementMayEnd(e, chain)) return false;
        return true;
    }

    /// Parts vanish where lengths leave nothing for them. One that is a share of the scope whatever its length goes on.
    bool partsMayEnd(const Parts& parts, bool chain) const {
        const std::vector<double> shares = sharesOf(parts);
        for (size_t i = 0; i < shares.size(); ++i)
            if (shares[i] > 0 && !bodyMayEnd(*parts.parts[i].body, chain)) return false;
        return true;
    }

    bool elementMayEnd(const Element& e, bool chain) const {
        switch (e.kind) {
            case Element::Kind::Shape:
                if (const Parts* parts = e.content.parts()) return partsMayEnd(*parts, chain);
                if (e.content.symbol() != none && !ends_[e.content.symbol()]) return false;
                if (!chain && e.live != none && !ends_[e.live]) return false;  // in a chain it starts none of its own
                return !e.content.group() || bodyMayEnd(*e.content.group(), chain);
            case Element::Kind::For:
                return !alwaysHolds(e.guard) || !runsOnce(*e.over) || bodyMayEnd(*e.body, chain);
            case Element::Kind::While:
            case Element::Kind::Let:
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
        forEachElement(grammar.rules[rule].body, [&](const Element& e) {
            if (e.at && !e.at->joints.empty()) axes.insert(e.at->joints[0].value.num());
        });
    return axes.size() <= 1;
}

void report(const Grammar& grammar, const std::vector<uint32_t>& cycle, syntax::Diagnostics& diagnostics) {
    const Rule& first = grammar.rules[cycle[0]];
    const std::string& symbol = grammar.symbols[first.symbol].name;
    constexpr size_t most = 20;  // steps that are told
    std::string message =
        fmt::format("rule '{}' never ends: every '{}' makes another '{}'", first.name, symbol, symbol);
    if (cycle.size() > 1) {
        std::string way;
        for (size_t i = 0; i < std::min(cycle.size(), most); ++i)
            way += fmt::format("'{}' ({}) -> ", grammar.symbols[grammar.rules[cycle[i]].symbol].name,
                               grammar.rules[cycle[i]].name);
        if (cycle.size() > most) way += fmt::format("{} more -> ", cycle.size() - most);
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

void findShadowed(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const auto lineOf = [](const Rule& rule) { return rule.symbolSpan.source->place(rule.symbolSpan.begin).line; };
    const auto isPlain = [](const Rule& rule) { return !rule.when && rule.beside == none; };
    for (const Symbol& symbol : grammar.symbols) {
        const Rule* always = nullptr;
        const Rule* plain = nullptr;
        for (const uint32_t index : symbol.rules) {
            const Rule& rule = grammar.rules[index];
            if (!always && rule.when && alwaysHolds(rule.when) && rule.beside == none && !rule.repeat) always = &rule;
            if (!plain && isPlain(rule)) plain = &rule;
        }
        bool behind = false;
        for (const uint32_t index : symbol.rules) {
            const Rule& rule = grammar.rules[index];
            if (&rule == always) {
                behind = true;
            } else if (rule.symbolSpan.source != grammar.sources[0].get()) {
                continue;
            } else if (always && (behind || !rule.when)) {
                diagnostics.warning(
                    rule.symbolSpan,
                    always->body.grows
                        ? fmt::format("this rule runs only where the one of line {} has no joint left: its condition "
                                      "always holds",
                                      lineOf(*always))
                        : fmt::format("this rule never runs: the condition of the one of line {} always holds",
                                      lineOf(*always)),
                    "leave that 'when' out to draw by weight, or give it a condition that may fail");
            } else if (plain && rule.beside != none && !rule.when && !rule.besideWins) {
                diagnostics.warning(
                    rule.symbolSpan,
                    fmt::format("this rule is drawn by weight against the one of line {}, also beside a '{}'",
                                lineOf(*plain), grammar.symbols[rule.beside].name),
                    "write 'when true' after it: a condition that holds wins; in 'grammar 2' a 'beside' that holds "
                    "does");
            }
        }
    }
}

void findWaitingCycles(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const auto awaited = [&](SymbolId symbol) {
        std::vector<std::pair<SymbolId, const Rule*>> found;
        for (const uint32_t rule : grammar.symbols[symbol].rules)
            if (const SymbolId after = grammar.rules[rule].after; after != none)
                found.emplace_back(after, &grammar.rules[rule]);
        return found;
    };
    std::vector<bool> done(grammar.symbols.size(), false);
    for (SymbolId first = 0; first < grammar.symbols.size(); ++first) {
        // Depth first, without recursion: the symbols of the way, each with what it waits for.
        std::vector<std::pair<SymbolId, std::vector<std::pair<SymbolId, const Rule*>>>> way;
        if (!done[first]) way.emplace_back(first, awaited(first));
        while (!way.empty()) {
            auto& [symbol, next] = way.back();
            if (next.empty()) {
                done[symbol] = true;
                way.pop_back();
                continue;
            }
            const auto [after, rule] = next.back();
            next.pop_back();
            const SymbolId name = after;
            const auto again =
                std::find_if(way.begin(), way.end(), [&](const auto& step) { return step.first == name; });
            if (again == way.end()) {
                if (!done[after]) way.emplace_back(after, awaited(after));
                continue;
            }
            std::string chain;
            for (auto step = again; step != way.end(); ++step)
                chain += fmt::format("{}'{}' waits for ",
                                     step == again ? "" : fmt::format("'{}', and ", grammar.symbols[step->first].name),
                                     grammar.symbols[step->first].name);
            diagnostics.warning(
                rule->span,
                fmt::format("{}'{}': nothing decides which comes first", chain, grammar.symbols[after].name),
                "take one 'after' out");
        }
    }
}

void findEndless(const Grammar& grammar, syntax::Diagnostics& diagnostics) {
    const Endings endings(grammar);
    // By symbol: the walk that came by, counted from 1, and after how many steps.
    std::vector<std::pair<size_t, size_t>> seen(grammar.symbols.size());
    size_t walks = 0;
    for (const SymbolId id : reachable(grammar)) {
        // Follow what is always made until it comes round, or leads where an earlier walk did.
        ++walks;
        std::vector<uint32_t> rules;
        for (SymbolId at = id; at != none && !endings.ends(at);) {
            if (seen[at].first == walks) {
                std::vector<uint32_t> cycle(rules.begin() + static_cast<ptrdiff_t>(seen[at].second), rules.end());
                std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
                if (oneAxis(grammar, cycle)) report(grammar, cycle, diagnostics);
            }
            if (seen[at].first != 0) break;
            seen[at] = {walks, rules.size()};
            const auto [rule, made] = endings.next(at);
            rules.push_back(rule);
            at = made;
        }
    }
}

}  // namespace sgm::rules
