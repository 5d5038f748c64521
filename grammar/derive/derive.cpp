#include "grammar/derive/derive.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/interpreter.h"
#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

using rules::Grammar;
using rules::Rule;

/// Rewrites live shapes, by itself or along a `derive` way.
class Rewriter {
public:
    Rewriter(TreeBuilder& builder, std::span<const rules::Value> params)
        : builder_(builder), grammar_(*builder.derivation().grammar), interpreter_(builder, params) {}

    void automatic(const rules::Start& start, uint64_t seed);
    void alongWay(const rules::Start& start, uint64_t seed, const rules::Derive& way);

private:
    struct Decision {
        uint64_t key;
        ShapeId shape;
        uint32_t rule;
    };

    uint32_t choose(ShapeId shape);
    uint32_t draw(ShapeId shape, const std::vector<uint32_t>& rules);
    bool mayMatchLater(ShapeId shape) const;
    std::vector<Decision> decide(std::vector<ShapeId>& waiting);
    ShapeId placeOfStep(const rules::Derive::Step& step);
    void failStep(const rules::Derive::Step& step, const std::string& what) {
        builder_.at(step.rule, none, none);
        builder_.fail(Error::Kind::Input, what, step.span);
    }

    TreeBuilder& builder_;
    const Grammar& grammar_;
    Interpreter interpreter_;
};

/// Rules whose guard holds win, in file order; of several without a guard one is drawn by weight.
uint32_t Rewriter::choose(ShapeId shape) {
    const auto& candidates = grammar_.symbols[builder_.tree().shapes[shape].symbol].rules;
    std::vector<uint32_t> plain;
    for (const uint32_t r : candidates) {
        const Rule& rule = grammar_.rules[r];
        builder_.at(r, shape, none);
        if (!rule.when) {
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
    const Place place = interpreter_.placeOf(shape);
    std::vector<double> weights;
    for (const uint32_t r : rules) {
        const auto& weight = grammar_.rules[r].weight;
        weights.push_back(weight ? number(*weight, place) : 1.0);
    }
    const uint32_t at = drawByWeight(weights, combine(place.key, hashText("rule")));
    if (at != none) return rules[at];
    builder_.at(rules[0], shape, none);
    builder_.fail(Error::Kind::Input, fmt::format("every rule for '{}' that matches has weight 0", grammar_.symbols[builder_.tree().shapes[shape].symbol].name),
                  grammar_.rules[rules[0]].weight->span);
    return none;
}

bool Rewriter::mayMatchLater(ShapeId shape) const {
    const auto& candidates = grammar_.symbols[builder_.tree().shapes[shape].symbol].rules;
    return std::any_of(candidates.begin(), candidates.end(), [&](uint32_t r) { return interpreter_.readsWorld(r); });
}

/// Chooses rules by the state at the generation's start; `waiting` keeps the shapes that may match later.
std::vector<Rewriter::Decision> Rewriter::decide(std::vector<ShapeId>& waiting) {
    std::vector<Decision> decisions;
    std::vector<ShapeId> later;
    for (const ShapeId s : waiting) {
        const Shape& shape = builder_.tree().shapes[s];
        if (!shape.live) continue;
        if (!builder_.work()) return {};
        if (const uint32_t rule = choose(s); rule != none) decisions.push_back({shape.key, s, rule});
        else if (mayMatchLater(s)) later.push_back(s);
    }
    std::sort(decisions.begin(), decisions.end(), [](const Decision& a, const Decision& b) { return a.key != b.key ? a.key < b.key : a.shape < b.shape; });
    waiting = std::move(later);
    return decisions;
}

void Rewriter::automatic(const rules::Start& start, uint64_t seed) {
    interpreter_.start(start, seed);
    std::vector<ShapeId> waiting = builder_.takeLive();
    for (uint32_t generation = 1; !builder_.failed(); ++generation) {
        const auto decisions = decide(waiting);
        if (decisions.empty()) return;
        for (const Decision& d : decisions) {
            if (!builder_.tree().shapes[d.shape].live) continue;
            // A lower key may have taken the joint: the shape then waits for the next generation.
            if (interpreter_.matches(d.rule, d.shape)) interpreter_.apply(d.rule, d.shape, generation);
            else waiting.push_back(d.shape);
            if (builder_.failed()) return;
        }
        const auto made = builder_.takeLive();
        waiting.insert(waiting.end(), made.begin(), made.end());
    }
}

ShapeId Rewriter::placeOfStep(const rules::Derive::Step& step) {
    const Rule& rule = grammar_.rules[step.rule];
    const ShapeTree& tree = builder_.tree();
    const auto usable = [&](ShapeId s) {
        return tree.shapes[s].live && interpreter_.matches(step.rule, s) && (!rule.when || holds(*rule.when, interpreter_.placeOf(s)));
    };
    if (!step.place.empty()) {
        const ShapeId s = tree.find(step.place);
        if (s == none) failStep(step, fmt::format("there is no shape '{}' here", step.place));
        else if (!usable(s)) failStep(step, fmt::format("rule '{}' doesn't match '{}' here", rule.name, step.place));
        else return s;
        return none;
    }
    std::vector<ShapeId> found;
    for (ShapeId s = 0; s != none; s = tree.next(s))
        if (usable(s)) found.push_back(s);
    if (found.size() == 1) return found[0];
    if (found.empty()) failStep(step, fmt::format("rule '{}' matches nothing here: no live shape is a '{}' that it could rewrite", rule.name, grammar_.symbols[rule.symbol].name));
    else failStep(step, fmt::format("rule '{}' matches {} shapes here: write 'at {}' or another of them", rule.name, found.size(), tree.path(found[0])));
    return none;
}

void Rewriter::alongWay(const rules::Start& start, uint64_t seed, const rules::Derive& way) {
    interpreter_.start(start, seed);
    uint32_t number = 0;
    for (const rules::Derive::Step& step : way.steps) {
        if (builder_.failed()) return;
        if (const ShapeId s = placeOfStep(step); s != none) interpreter_.apply(step.rule, s, ++number);
    }
}

}  // namespace

Result<Derivation> derive(std::shared_ptr<const Grammar> grammar, const Options& options, Progress* progress) {
    if (options.start >= grammar->starts.size()) return Error{Error::Kind::Usage, "the grammar has no start to derive from"};
    const rules::Derive* way = nullptr;
    if (!options.derive.empty()) {
        const auto found = std::find_if(grammar->derives.begin(), grammar->derives.end(), [&](const rules::Derive& d) { return d.name == options.derive; });
        if (found == grammar->derives.end()) return Error{Error::Kind::Usage, fmt::format("the grammar has no derive way '{}'", options.derive)};
        way = &*found;
    }
    Derivation d;
    d.grammar = grammar;
    d.materials = grammar->materials;
    if (d.materials.empty()) d.materials.emplace_back();
    d.start = options.start;
    d.seed = options.seed;
    d.params = options.params;
    for (size_t i = d.params.size(); i < grammar->params.size(); ++i) d.params.push_back(grammar->params[i].value);
    if (progress) progress->begin("derive", 0);

    TreeBuilder builder(d, options.budget, progress);
    Rewriter rewriter(builder, d.params);
    const rules::Start& start = grammar->starts[options.start];
    if (way) rewriter.alongWay(start, options.seed, *way);
    else rewriter.automatic(start, options.seed);
    if (builder.failed()) return builder.takeFailure();
    builder.finish();
    return d;
}

}  // namespace sgm::derive
