#include "grammar/derive/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace sgm::derive {

namespace {

template <class List>
uint64_t bytes(const List& list) {
    return list.capacity() * sizeof(typename List::value_type);
}

}  // namespace

uint64_t Derivation::memory() const {
    const Bonds* const bonds = tree.bondsOnDemand.made();
    return tree.shapes.memory() + bytes(tree.mates) + bytes(tree.solids) + bytes(tree.extras) + bytes(steps) +
           bytes(materials) + (bonds ? bonds->memory() : 0);
}

TreeBuilder::TreeBuilder(Derivation& derivation, const Budget& budget, Progress* progress)
    : derivation_(derivation),
      monitor_(derivation, joints_, budget, progress),
      recorder_(derivation, monitor_),
      bonds_(derivation.tree, joints_, monitor_, recorder_),
      counts_(derivation.grammar->symbols.size()) {}

void TreeBuilder::warn(syntax::SourceSpan span, std::string message, std::string hint) {
    constexpr size_t most = 300;
    auto& warnings = derivation_.warnings;
    if (isReplaying() || warnings.size() >= most) return;
    const auto isHere = [&](const Warning& r) {
        return r.span.source == span.source && r.span.begin == span.begin && r.span.end == span.end;
    };
    if (std::none_of(warnings.begin(), warnings.end(), isHere))
        warnings.push_back({span, std::move(message), std::move(hint)});
}

/// Joins a new shape to its parent's children: as the last one, or before another. The parent knows it under `id`
/// already.
void TreeBuilder::linkChild(ShapeId parentId, ShapeId id, ShapeId before) {
    ShapeTree& t = tree();
    ShapeRecord& parent = t.shapes.record(parentId);
    if (before == none) {
        if (parent.firstChild == none)
            parent.firstChild = id;
        else
            t.shapes.record(parent.lastChild).nextSibling = id;
        parent.lastChild = id;
        return;
    }
    ShapeId& last = lastBefore_.try_emplace(before, none).first->second;
    if (last == none || t.shapes[last].dead || t.shapes[last].nextSibling != before) {
        last = parent.firstChild == before ? none : parent.firstChild;
        while (last != none && t.shapes[last].nextSibling != before) last = t.shapes[last].nextSibling;
    }
    (last == none ? parent.firstChild : t.shapes.record(last).nextSibling) = id;
    last = id;
}

ShapeId TreeBuilder::add(Shape shape, ShapeId before) {
    if (isReplaying()) return replayShape(shape);
    ShapeTree& t = tree();
    const auto id = static_cast<ShapeId>(t.shapes.size());
    if (!monitor_.work()) return none;
    if (id >= monitor_.budget().shapes) {
        monitor_.failOfGrowth(fmt::format("the budget of {} shapes is spent", monitor_.budget().shapes), shape.span);
        return none;
    }
    shape.madeBy = monitor_.step();
    if (shape.parent != none) {
        const ShapeRecord& parent = t.shapes.record(shape.parent);
        shape.depth = parent.depth + 1;
        if (shape.depth > std::min(monitor_.budget().depth, Shapes::mostDepth)) {
            monitor_.fail(Error::Kind::Budget,
                          fmt::format("the budget of {} levels of depth is spent", monitor_.budget().depth), shape.span,
                          "a rule that makes itself again needs an end: 'repeat 5', or a 'when' that fails at last, "
                          "such as 'when scope.x > .1m'");
            return none;
        }
        if (shape.extras != none && !t.extras[shape.extras].values.empty())
            shape.valuesAt = id;
        else if (before == none)
            shape.valuesAt = parent.valuesAt;
        // The root's box is only where the start begins: nothing stands there to be met.
        if (shape.parent != 0 && shape.op == rules::Operator::None && shape.scope == t.shapes.scopeOf(shape.parent))
            shape.sharesPlace = true;
        linkChild(shape.parent, id, before);
        shape.nextSibling = before;
    }
    if (shape.symbol != rules::none) ++counts_[shape.symbol];
    if (shape.live) live_.push_back(id);
    t.shapes.push_back(shape);
    if (Progress* progress = monitor_.progress()) progress->tick();
    return id;
}

Extras& TreeBuilder::extras(ShapeId id) {
    if (isReplaying()) monitor_.diverge();
    if (recording()) recording()->made().annotated(id);
    ShapeRecord& s = tree().shapes.record(id);
    if (s.extras == none) {
        s.extras = static_cast<uint32_t>(tree().extras.size());
        tree().extras.emplace_back();
    }
    return tree().extras[s.extras];
}

uint32_t TreeBuilder::beginStep(Step step) {
    auto& steps = derivation_.steps;
    step.firstMade = nextShape();
    if (!isReplaying()) {
        steps.push_back(step);
        return static_cast<uint32_t>(steps.size() - 1);
    }
    const uint32_t index = recording()->nextStep();
    const auto told = [](const Step& s) {
        return std::tie(s.rule, s.shape, s.generation, s.chainIndex, s.closing, s.firstMade);
    };
    if (index != none && told(steps[index]) == told(step)) return index;
    monitor_.diverge();
    return 0;
}

void TreeBuilder::endStep(uint32_t index, bool morphic) {
    Step& step = derivation_.steps[index];
    const uint32_t made = nextShape() - step.firstMade;
    if (isReplaying()) {
        if (made != step.madeCount || morphic != step.morphic) monitor_.diverge();
        return;
    }
    step.madeCount = made;
    step.morphic = morphic;
    ++(morphic ? derivation_.morphic : derivation_.classic);
}

ShapeId TreeBuilder::nextShape() const {
    return isReplaying() ? recording()->shapesMade() : static_cast<ShapeId>(derivation_.tree.shapes.size());
}

const Surroundings& TreeBuilder::surroundings() {
    if (!surroundings_) surroundings_.emplace(tree());
    return *surroundings_;
}

void TreeBuilder::clearContent(ShapeId id) {
    if (isReplaying()) return;
    ShapeTree& t = tree();
    ShapeRecord& cleared = t.shapes.record(id);
    if (recording() && cleared.solid != none) recording()->made().cleared(id);
    cleared.solid = none;
    if (cleared.firstChild == none) return;
    bonds_.asked();
    for (ShapeId s = t.next(id, id); s != none; s = t.next(s, id)) kill(s);
    cleared.firstChild = cleared.lastChild = none;
    killBound();
}

void TreeBuilder::kill(ShapeId id) {
    ShapeRecord& dead = tree().shapes.record(id);
    dead.dead = true;
    dead.live = false;
    ++deadCount_;
    if (const rules::SymbolId symbol = tree().shapes[id].symbol; symbol != rules::none) --counts_[symbol];
    bonds_.release(id);
}

/// Takes away what stands elsewhere and comes from shapes that are gone.
void TreeBuilder::killBound() {
    ShapeTree& t = tree();
    for (const auto& [cutter, origin] : bound_) {
        if (t.shapes[cutter].dead || !t.shapes[origin].dead) continue;
        ShapeRecord& parent = t.shapes.record(t.shapes[cutter].parent);
        ShapeId previous = none;
        for (ShapeId c = parent.firstChild; c != cutter && c != none; c = t.shapes[c].nextSibling) previous = c;
        const ShapeId next = t.shapes[cutter].nextSibling;
        (previous == none ? parent.firstChild : t.shapes.record(previous).nextSibling) = next;
        if (parent.lastChild == cutter) parent.lastChild = previous;
        for (ShapeId s = cutter; s != none; s = t.next(s, cutter)) kill(s);
    }
}

namespace {

/// Removes dead shapes; gives the new ids by old ones.
std::vector<uint32_t> sweepShapes(Derivation& derivation) {
    ShapeTree& t = derivation.tree;
    std::vector<uint32_t> newId(t.shapes.size(), none);
    uint32_t kept = 0;
    for (ShapeId s = 0; s < t.shapes.size(); ++s)
        if (!t.shapes[s].dead) newId[s] = kept++;
    const auto renamed = [&](ShapeId s) { return s == none ? none : newId[s]; };
    for (Step& step : derivation.steps) {
        // The shapes of a step stay together; those that are left begin at the first one kept.
        uint32_t left = 0, first = none;
        for (uint32_t i = 0; i < step.madeCount; ++i)
            if (const uint32_t to = newId[step.firstMade + i]; to != none) first = std::min(first, to), ++left;
        step.firstMade = left ? first : 0;
        step.madeCount = left;
        step.shape = renamed(step.shape);
    }
    for (ShapeId s = 0; s < t.shapes.size(); ++s) {
        if (newId[s] == none) continue;
        ShapeRecord shape = t.shapes.record(s);
        for (ShapeId* link : {&shape.parent, &shape.firstChild, &shape.lastChild, &shape.nextSibling, &shape.valuesAt})
            *link = renamed(*link);
        t.shapes.record(newId[s]) = shape;
    }
    t.shapes.truncate(kept);
    for (Closed& closed : derivation.closed) closed.host = renamed(closed.host);
    for (LettersRead& read : derivation.letters) read.valuesAt = renamed(read.valuesAt);
    return newId;
}

void numberOccurrences(ShapeTree& t) {
    std::vector<uint32_t> seen(t.labels.size(), 0), touched;
    for (ShapeId parent = 0; parent < t.shapes.size(); ++parent) {
        for (ShapeId c = t.shapes[parent].firstChild; c != none; c = t.shapes[c].nextSibling) {
            uint32_t& count = seen[t.shapes[c].label];
            if (count++ == 0) touched.push_back(t.shapes[c].label);
            t.shapes.record(c).occurrence = count;
        }
        for (const uint32_t label : touched) seen[label] = 0;
        touched.clear();
    }
    t.shapes.record(0).occurrence = 1;
}

}  // namespace

void TreeBuilder::noteLetters(const LettersRead& read) {
    std::vector<LettersRead>& all = derivation_.letters;
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const LettersRead& r) { return r.lsystem == read.lsystem; });
    if (known == all.end())
        all.push_back(read);
    else if (known->key == read.key)
        *known = read;
}

void TreeBuilder::finish() {
    bonds_.settle();
    if (deadCount_ > 0) {
        const Bonds& bonds = bonds_.asked();
        std::vector<uint32_t> ownerOf;
        for (ShapeId s = 0; s < tree().shapes.size(); ++s) ownerOf.push_back(bonds.bodies[bonds.bodyOf[s]].owner);
        bonds_.sweep(sweepShapes(derivation_), ownerOf);
        if (recording()) recording()->unfit();
    }
    numberOccurrences(tree());
    finishReliefs(derivation_);
    tree().shapes.shrink();
    tree().mates.shrink();
    derivation_.steps.shrink();
}

}  // namespace sgm::derive
