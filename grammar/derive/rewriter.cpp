#include "grammar/derive/rewriter.h"
#include "grammar/rules/traverse.h"

#include <fmt/format.h>

#include <algorithm>

#include "modeler/core/random.h"

namespace sgm::derive {

using rules::Rule;

/// Rules whose guard holds win, in file order; of several without a guard one is drawn by weight.
uint32_t Rewriter::choose(ShapeId shape) {
    const auto& candidates = grammar_.symbols[builder_.tree().shapes[shape].symbol].rules;
    std::vector<uint32_t> plain;
    for (const uint32_t r : candidates) {
        const Rule& rule = grammar_.rules[r];
        builder_.monitor().at(r, shape, none);
        if (!rule.when && rule.besideWins) {
            if (interpreter_.matches(r, shape)) return r;
        } else if (!rule.when) {
            if (interpreter_.matches(r, shape)) plain.push_back(r);
        } else if (holds(*rule.when, interpreter_.placeOf(shape)) && interpreter_.matches(r, shape)) {
            return r;
        }
    }
    if (plain.empty()) return none;
    return plain.size() == 1 && !grammar_.rules[plain[0]].weight ? plain[0] : draw(shape, plain);
}

/// One of `rules` by weight; fails when all weigh 0.
uint32_t Rewriter::draw(ShapeId shape, const std::vector<uint32_t>& rules) {
    builder_.monitor().noteChance();
    const Place place = interpreter_.placeOf(shape);
    std::vector<double> weights;
    for (const uint32_t r : rules) {
        const auto& weight = grammar_.rules[r].weight;
        weights.push_back(weight ? number(*weight, place) : 1.0);
    }
    const uint32_t at = drawByWeight(weights, combine(place.key, hashText("rule")));
    if (at != none) return rules[at];
    builder_.monitor().at(rules[0], shape, none);
    builder_.monitor().fail(Error::Kind::Input,
                            fmt::format("every rule for '{}' that matches has weight 0",
                                        grammar_.symbols[builder_.tree().shapes[shape].symbol].name),
                            grammar_.rules[rules[0]].weight->span);
    return none;
}

bool Rewriter::mayMatchLater(ShapeId shape) const {
    const auto& candidates = grammar_.symbols[builder_.tree().shapes[shape].symbol].rules;
    return std::any_of(candidates.begin(), candidates.end(), [&](uint32_t r) { return interpreter_.readsWorld(r); });
}

/// Whether a rule for the shape comes after shapes that still live.
bool Rewriter::waits(ShapeId shape) const {
    const auto& rules = grammar_.symbols[builder_.tree().shapes[shape].symbol].rules;
    return std::any_of(rules.begin(), rules.end(), [&](uint32_t r) {
        const rules::SymbolId after = grammar_.rules[r].after;
        return after != rules::none && liveSymbols_[after];
    });
}

/// Chooses rules by the state at the generation's start; `waiting` keeps the shapes that may match later.
std::vector<Rewriter::Decision> Rewriter::decide(std::vector<ShapeId>& waiting) {
    std::vector<Decision> decisions;
    std::vector<ShapeId> later;
    builder_.forgetSurroundings();
    if (partsLookAround_) builder_.surroundings();  // as things stand now, before any rule is applied
    for (const ShapeId s : waiting) {
        const Shape& shape = builder_.tree().shapes[s];
        if (!shape.live) continue;
        if (hasOrder_ && waits(s)) {
            later.push_back(s);
            continue;
        }
        builder_.recorder().beginPiece({.kind = Piece::Kind::Choice, .shape = s});
        if (!builder_.monitor().work()) return {};
        interpreter_.takeBlocked();
        const uint32_t rule = choose(s);
        const bool returns = rule == none && mayMatchLater(s);
        if (rule == none && !returns)
            for (const auto& blocked : interpreter_.takeBlocked()) interpreter_.noteClosed(blocked);
        if (Recording* r = builder_.recording()) r->now().rule = rule;
        if (rule != none)
            decisions.push_back({shape.key, {rule, s}});
        else if (returns)
            later.push_back(s);
    }
    std::sort(decisions.begin(), decisions.end(), [](const Decision& a, const Decision& b) {
        return a.key != b.key ? a.key < b.key : a.application.shape < b.application.shape;
    });
    waiting = std::move(later);
    return decisions;
}

void Rewriter::noteLive(const std::vector<ShapeId>& waiting) {
    if (!hasOrder_) return;
    liveSymbols_.assign(grammar_.symbols.size(), false);
    for (const ShapeId s : waiting)
        if (builder_.tree().shapes[s].live) liveSymbols_[builder_.tree().shapes[s].symbol] = true;
}

namespace {

bool lookAround(const rules::Parts& parts) {
    return parts.snap || std::any_of(parts.parts.begin(), parts.parts.end(),
                                     [](const rules::Parts::Part& part) { return part.label == "shared"; });
}

bool partsLookAround(const rules::Grammar& grammar) {
    bool found = false;
    for (const Rule& rule : grammar.rules)
        rules::forEachElement(rule.body, [&](const rules::Element& e) {
            if (const rules::Parts* parts = e.content.parts()) found = found || lookAround(*parts);
        });
    return found;
}

}  // namespace

void Rewriter::automatic() {
    builder_.takeLive();
    partsLookAround_ = partsLookAround(grammar_);
    std::vector<ShapeId> waiting = live();
    hasOrder_ = std::any_of(grammar_.rules.begin(), grammar_.rules.end(),
                            [](const Rule& rule) { return rule.after != rules::none; });
    if (Recording* r = builder_.recording(); r && hasOrder_) r->unfit();  // who lives then isn't recorded
    for (uint32_t generation = 1; !builder_.monitor().failed(); ++generation) {
        noteLive(waiting);
        auto decisions = decide(waiting);
        if (decisions.empty() && hasOrder_ &&
            !builder_.monitor().failed()) {  // what lives has no rule that matches: none waits for it
            liveSymbols_.assign(grammar_.symbols.size(), false);
            decisions = decide(waiting);
        }
        if (decisions.empty()) return;
        for (const Decision& d : decisions) {
            const Application& a = d.application;
            if (!builder_.tree().shapes[a.shape].live) continue;
            // A lower key may have taken the joint: the shape then waits for the next generation.
            if (stillMatches(a))
                apply(a, generation);
            else
                waiting.push_back(a.shape);
            if (builder_.monitor().failed()) return;
        }
        const auto made = builder_.takeLive();
        waiting.insert(waiting.end(), made.begin(), made.end());
    }
}

void Rewriter::start(const rules::Start& start, const Options& options) {
    builder_.recorder().beginPiece({.kind = Piece::Kind::Start});
    interpreter_.start(start, options.seed, options.lot ? &*options.lot : nullptr);
}

bool Rewriter::stillMatches(Application a) {
    builder_.recorder().beginPiece({.kind = Piece::Kind::Match, .rule = a.rule, .shape = a.shape});
    const bool matched = interpreter_.matches(a.rule, a.shape);
    if (Recording* r = builder_.recording()) r->now().matched = matched;
    return matched;
}

bool Rewriter::repeat(const Piece& piece) {
    const Derivation& d = builder_.derivation();
    switch (piece.kind) {
        case Piece::Kind::Start:
            interpreter_.start(grammar_.starts[d.start], d.seed, nullptr);
            return true;
        case Piece::Kind::Choice:
            return builder_.monitor().work() && choose(piece.shape) == piece.rule;
        case Piece::Kind::Match:
            return interpreter_.matches(piece.rule, piece.shape) == piece.matched;
        case Piece::Kind::Application:
            interpreter_.apply(piece.rule, piece.shape, piece.generation);
            return true;
    }
    return false;
}

void Rewriter::apply(Application a, uint32_t generation) {
    builder_.recorder().beginPiece(
        {.kind = Piece::Kind::Application, .rule = a.rule, .shape = a.shape, .generation = generation});
    applied_.push_back(a);
    interpreter_.apply(a.rule, a.shape, generation);
}

void Rewriter::apply(Application a) { apply(a, static_cast<uint32_t>(applied_.size() + 1)); }

std::vector<ShapeId> Rewriter::live() const {
    std::vector<ShapeId> found;
    const ShapeTree& tree = builder_.tree();
    if (tree.shapes.empty()) return found;
    for (ShapeId s = 0; s != none; s = tree.next(s))
        if (tree.shapes[s].live) found.push_back(s);
    return found;
}

bool Rewriter::usable(Application a) {
    const Rule& rule = grammar_.rules[a.rule];
    builder_.monitor().at(a.rule, a.shape, none);
    return builder_.tree().shapes[a.shape].live && interpreter_.matches(a.rule, a.shape) &&
           (!rule.when || holds(*rule.when, interpreter_.placeOf(a.shape)));
}

std::vector<Closed> Rewriter::blockedAt(ShapeId shape) {
    interpreter_.takeBlocked();
    for (const uint32_t rule : grammar_.symbols[builder_.tree().shapes[shape].symbol].rules) usable({rule, shape});
    std::vector<Closed> found;
    for (auto& blocked : interpreter_.takeBlocked())
        found.push_back({blocked.element->span, 1, blocked.host, std::move(blocked.joints)});
    return found;
}

std::vector<ShapeId> Rewriter::usableBy(uint32_t rule, size_t most) {
    std::vector<ShapeId> found;
    const ShapeTree& tree = builder_.tree();
    for (ShapeId s = tree.shapes.empty() ? none : 0; s != none && found.size() < most; s = tree.next(s))
        if (usable({rule, s})) found.push_back(s);
    return found;
}

/// The shapes that a rule matches, for a message; the first few of many.
std::string Rewriter::shapesFor(uint32_t rule) {
    constexpr size_t most = 3;
    const std::vector<ShapeId> usable = usableBy(rule, most + 1);
    builder_.monitor().discardFailure();
    std::string text;
    for (size_t i = 0; i < std::min(usable.size(), most); ++i)
        text += fmt::format("{}'{}'", i == 0 ? ": it matches " : ", ", builder_.tree().path(usable[i]));
    return text + (usable.size() > most ? " and others" : "");
}

Result<ShapeId> Rewriter::meant(uint32_t index, const std::string& place) {
    const Rule& rule = grammar_.rules[index];
    const ShapeTree& tree = builder_.tree();
    const auto refuse = [](std::string what) { return Error{Error::Kind::Input, std::move(what)}; };
    if (!place.empty()) {
        const ShapeId s = tree.find(place);
        if (s == none) return refuse(fmt::format("there is no shape '{}' here{}", place, shapesFor(index)));
        if (!usable({index, s}))
            return refuse(fmt::format("rule '{}' doesn't match '{}' here{}", rule.name, place, shapesFor(index)));
        return s;
    }
    const std::vector<ShapeId> found = usableBy(index);
    if (found.size() == 1) return found[0];
    if (found.empty())
        return refuse(
            fmt::format("rule '{1}' matches nothing here: no live shape is a '{0}' that it could rewrite; let a "
                        "rule before it make a '{0}', or leave this step out",
                        grammar_.symbols[rule.symbol].name, rule.name));
    return refuse(fmt::format("rule '{}' matches {} shapes here: write 'at {}' or another of them", rule.name,
                              found.size(), tree.path(found[0])));
}

void Rewriter::along(const rules::Derive& way) {
    for (const rules::Derive::Step& step : way.steps) {
        if (builder_.monitor().failed()) return;
        const auto shape = meant(step.rule, step.place);
        if (shape.ok()) {
            apply({step.rule, *shape});
        } else {
            builder_.monitor().at(step.rule, none, none);
            builder_.monitor().fail(shape.error().kind, shape.error().message, step.span);
        }
    }
}

}  // namespace sgm::derive
