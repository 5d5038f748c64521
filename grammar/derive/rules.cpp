// Matching and applying rules: single applications, chains of `repeat`, and their `finally`.
#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/interpreter.h"
#include "grammar/derive/joint_choice.h"
#include "modeler/core/random.h"

namespace sgm::derive {

using rules::Element;
using rules::Rule;

namespace {

/// Whether other shapes decide about the value.
bool asksForOthers(const rules::Expr& e) {
    using rules::Fn;
    const auto fn = static_cast<Fn>(e.index);
    const bool others =
        fn == Fn::Count || fn == Fn::Overlaps || fn == Fn::Touches || fn == Fn::Inside || fn == Fn::Covered;
    if (e.kind == rules::Expr::Kind::Call && others) return true;
    for (const rules::Expr& arg : e.args)
        if (asksForOthers(arg)) return true;
    return false;
}

/// A primitive that is a morph by itself, and at neither end of it.
bool morphs(const SolidValue& solid) {
    if (solid.kind == rules::Solid::Kind::Primitive && solid.primitive->morphs && solid.args[0].num() > 0 &&
        solid.args[0].num() < 1)
        return true;
    return std::any_of(solid.parts.begin(), solid.parts.end(), morphs);
}

/// Whether a shape of that symbol is bonded to `shape`.
bool isBeside(TreeBuilder& builder, ShapeId shape, rules::SymbolId symbol) {
    if (builder.recording()) builder.recording()->readsWorld();
    const ShapeTree& tree = builder.tree();
    const Bonds& bonds = builder.bonds().asked();
    const uint32_t body = bonds.bodyOf[shape];
    for (uint32_t i = bonds.bodies[body].firstBond; i != none;) {
        const Bond& bond = bonds.all[i];
        const int mine = bonds.bodyOf[bond.shape[0]] == body ? 0 : 1;
        // The neighbour, what it wraps and what wraps it stand at one place.
        const uint32_t theirs = bonds.bodyOf[bond.shape[1 - mine]];
        const ShapeId owner = bonds.bodies[theirs].owner;
        for (ShapeId s = owner; s != none && !tree.shapes[owner].dead;) {
            if (tree.shapes[s].symbol == symbol && !tree.shapes[s].dead) return true;
            const ShapeId child = tree.shapes[s].firstChild;
            s = child != none && bonds.bodyOf[child] == theirs ? child : none;
        }
        i = bond.next[mine];
    }
    return false;
}

/// A chain that goes on from its first shape, whose joint its own first step has used, hardly ends as it is meant to.
void warnOfStop(TreeBuilder& builder, const Rule& rule, double done, double steps) {
    const std::string& name = builder.derivation().grammar->symbols[rule.symbol].name;
    builder.warn(rule.repeat->span,
                 fmt::format("the chain ends after {:g} of {:g} steps: none of its newcomers is a '{}' from which the "
                             "next step could go on, and the joint of the first one is used",
                             done, steps, name),
                 fmt::format("write ': {}' behind the newcomer that the next step grows on", name));
}

/// A chain whose steps each put something in the place of what the one before made: the last one alone is left.
void warnOfReplacing(TreeBuilder& builder, const Rule& rule, double steps) {
    const std::string& name = builder.derivation().grammar->symbols[rule.symbol].name;
    builder.warn(
        rule.repeat->span,
        fmt::format("each of the {:g} steps replaces what the one before made, so the last alone is left: none "
                    "of its newcomers is a '{}' from which the next step could go on",
                    steps, name),
        fmt::format("begin the body with '+' to grow on what stands, or write ': {}' behind what the next "
                    "step goes on from",
                    name));
}

}  // namespace

Interpreter::Interpreter(TreeBuilder& builder, std::span<const rules::Value> params)
    : builder_(builder), grammar_(*builder.derivation().grammar), params_(params), maker_(builder) {
    builder_.tree().namedJoints.emplace_back();
    for (const Rule& rule : grammar_.rules) {
        RuleInfo facts;
        facts.hash = hashText(rule.name);
        facts.readsWorld =
            rule.beside != rules::none || rule.after != rules::none || (rule.when && asksForOthers(*rule.when));
        facts_.push_back(facts);
    }
}

Place Interpreter::placeOf(ShapeId id) const {
    const Shape& s = builder_.tree().shapes[id];
    return {&builder_.tree(), params_,  builder_.counts(), locals_, s.scope, s.valuesAt, s.key, 0,
            &builder_,        &series_, nullptr,           id};
}

void Interpreter::start(const rules::Start& start, uint64_t seed, const Lot* lot) {
    Shape root;
    root.symbol = start.symbol;
    root.key = combine(mix(seed), hashText(grammar_.symbols[start.symbol].name));
    root.label = maker_.labelIndex(grammar_.symbols[start.symbol].name);
    root.span = start.span;
    root.meetsNobody = true;
    builder_.monitor().at(none, none, none);
    if (lot) root.scope.size = lot->size_m;
    if (lot && !lot->footprint.empty()) {
        const auto footprint = builder_.tree().footprints.put(lot->footprint, root.scope.half());
        if (!footprint.ok()) return builder_.monitor().fail(Error::Kind::Input, footprint.error().message, start.span);
        root.scope.footprint = *footprint;
    }
    const ShapeId id = builder_.add(root);
    if (id == none) return;
    locals_.assign(start.locals, {});
    RunState state;
    state.root = state.last = state.newest = id;
    Frame frame{id, id, combine(root.key, hashText("start")), placeOf(id), &state, false};
    runBody(start.body, frame, 0);
}

/// Counts a turn of a repetition, whose draws come from `stream`.
void Interpreter::count(uint32_t local, double turn, uint64_t stream) {
    if (series_.size() <= local) series_.resize(local + 1);
    series_[local] = combine(stream, local);
    locals_[local] = rules::Value::number(turn);
    locals_[local].integer = true;
}

/// False when every joint is closed on which the body's own elements (not those in loops) would grow.
/// Those elements, and the joints that they asked for, go to `blocked`.
bool Interpreter::canGrow(const rules::Body& body, ShapeId host, const Place& place, std::vector<Blocked>& blocked) {
    if (!body.grows) return true;
    for (const Elements& sibling : body.siblings)
        for (const Element& e : sibling) {
            if (e.kind == Element::Kind::Let) return true;  // a joint may hang on its value
            if (e.kind != Element::Kind::Shape || e.op == rules::Operator::None) continue;
            if (!e.at || e.on || e.at->each) return true;
            blocked.push_back({&e, host, {}});
            if (!openJoints(builder_, *e.at, host, place, blocked.back().joints).empty()) return true;
        }
    return blocked.empty();
}

bool Interpreter::matches(uint32_t index, ShapeId id) {
    const Rule& rule = grammar_.rules[index];
    const Shape& s = builder_.tree().shapes[id];
    if (s.symbol != rule.symbol || (rule.repeat && s.chainRule == index)) return false;
    if (rule.beside != rules::none && !isBeside(builder_, id, rule.beside)) return false;
    if (locals_.size() < rule.locals) locals_.resize(rule.locals);
    std::vector<Blocked> blocked;
    if (canGrow(rule.body, id, placeOf(id), blocked)) return true;
    if (!builder_.isReplaying()) blocked_.insert(blocked_.end(), blocked.begin(), blocked.end());
    return false;
}

bool Interpreter::runLogged(const rules::Body& body, const Frame& frame, Step step) {
    step.shape = frame.matched;
    const uint32_t index = builder_.beginStep(step);
    builder_.monitor().at(step.rule, step.shape, index);
    const bool good = builder_.monitor().work() && runBody(body, frame, 0);
    bool morphic = step.morphic;
    for (ShapeId id = builder_.derivation().steps[index].firstMade; id < builder_.nextShape() && !morphic; ++id)
        if (const SolidValue* solid = builder_.tree().solidOf(id)) morphic = morphs(*solid);
    builder_.endStep(index, morphic);
    return good && !builder_.monitor().failed();
}

void Interpreter::apply(uint32_t index, ShapeId id, uint32_t generation) {
    const Rule& rule = grammar_.rules[index];
    builder_.tree().shapes.record(id).live = false;
    locals_.assign(rule.locals, {});
    if (rule.repeat) return runChain(index, id, generation);
    chainRule_ = none;
    if (!rule.body.grows) builder_.clearContent(id);
    RunState state;
    state.root = state.last = state.newest = id;
    const uint64_t key = combine(combine(builder_.tree().shapes[id].key, facts_[index].hash), 0);
    runLogged(rule.body, {id, id, key, placeOf(id), &state, false},
              {index, id, generation, 0, rule.morphic, false, 0, 0});
}

void Interpreter::runChain(uint32_t index, ShapeId root, uint32_t generation) {
    const Rule& rule = grammar_.rules[index];
    chainRule_ = index;
    builder_.monitor().at(index, root, none);
    const double steps = wholeNumber(*rule.repeat, placeOf(root));
    if (steps < 0)
        builder_.warn(rule.repeat->span, fmt::format("'repeat' is {:g} here, so the rule adds nothing", steps),
                      "write 'max(0, …)' where that is meant");
    const uint64_t key = combine(builder_.tree().shapes[root].key, facts_[index].hash);
    RunState state;
    state.root = state.last = state.newest = root;
    for (double i = 1; i <= steps; ++i) {
        const ShapeId host = state.newest;
        Frame frame{host, rule.body.grows ? root : host, combine(key, static_cast<uint64_t>(i)), placeOf(host), &state,
                    false};
        frame.place.ramp = steps > 1 ? (i - 1) / (steps - 1) : 0;
        if (rule.stepLocal != none) count(rule.stepLocal, i, key);
        if (std::vector<Blocked> blocked; !canGrow(rule.body, host, frame.place, blocked)) {
            if (i > 1 && host == root) warnOfStop(builder_, rule, i - 1, steps);
            break;
        }
        if (!rule.body.grows && i == 2 && host == root) warnOfReplacing(builder_, rule, steps);
        if (!rule.body.grows) builder_.clearContent(host), builder_.tree().shapes.record(host).live = false;
        state.ownSymbol = false;
        if (!runLogged(rule.body, frame,
                       {index, host, generation, static_cast<uint32_t>(i), rule.morphic, false, 0, 0}))
            return;
        for (size_t d = 0; d < faceCount; ++d)
            if (!state.placed[d].empty()) state.toward[d] = std::exchange(state.placed[d], {});
    }
    if (rule.finally_) runFinally(index, root, state, generation);
}

void Interpreter::runFinally(uint32_t index, ShapeId root, RunState& state, uint32_t generation) {
    const Rule& rule = grammar_.rules[index];
    if (!rule.finally_->grows && rule.finally_->siblings.size() && !rule.finally_->siblings[0].empty() &&
        !rule.finally_->siblings[0][0].content.empty())
        builder_.clearContent(root);
    const uint64_t key = combine(combine(builder_.tree().shapes[root].key, facts_[index].hash), hashText("finally"));
    Frame frame{root, root, key, placeOf(root), &state, true};
    frame.place.ramp = 1;
    runLogged(*rule.finally_, frame, {index, root, generation, 0, rule.finallyMorphic, true, 0, 0});
}

}  // namespace sgm::derive
