// Putting shapes: where a newcomer stands (SG-M III-F) and what it is bonded to.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/derive/interpreter.h"
#include "grammar/derive/joint_choice.h"
#include "grammar/rules/lookup.h"
#include "modeler/core/random.h"

namespace sgm::derive {

using rules::Attribute;
using rules::Element;
using rules::HostChoice;
using Phase = rules::Operation::Phase;

namespace {

/// Content that later elements join must not be rewritten or displaced together with them: it gets a node of its own.
bool needsGroup(const Element& e, const Shape& shape) {
    return shape.live || shape.extras != none || (e.content.group() && e.live != rules::none);
}

/// The matched scope as prefix attributes leave it; each sees what those before it made. Nothing where no footprint is
/// left. What they say of the shapes below goes to `all`, and whether the element set its footprint itself.
std::optional<Scope> changedScope(const std::vector<Attribute>& prefix, Place place, EvaluatedAttributes& all) {
    for (const Attribute& a : prefix) {
        if (a.operation->phase != Phase::Scope) continue;
        EvaluatedAttributes out;
        out.scope = place.scope;
        out.ownsFootprint = all.ownsFootprint;
        AttributeContext context{place, out};
        a.operation->apply(context, a);
        if (out.vanishes) return std::nullopt;
        all.extras.values.insert(all.extras.values.end(), out.extras.values.begin(), out.extras.values.end());
        // In grammar 1 an absolute size takes a plan away that stands before it.
        all.ownsFootprint = out.ownsFootprint && rules::versionOf(*place.builder->derivation().grammar, a.span) >= 2;
        place.scope = out.scope;
        place.scope.centre += out.moved_m + out.grown_m;
    }
    return place.scope;
}

/// The angle of the rotation that takes one frame to the other, 0 … pi.
double angleBetween(const Mat3& a, const Mat3& b) {
    const double trace = dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
    return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
}

void applyWhole(const std::vector<Attribute>& list, const Place& place, EvaluatedAttributes& out) {
    AttributeContext context{place, out};
    for (const Attribute& a : list)
        if (a.operation->phase == Phase::Whole) a.operation->apply(context, a);
}

/// Joints that face each other leave of a `turn` what goes about them: the rest is told.
void remarkLostTurn(TreeBuilder& builder, const Element& e, const Mating& mating, const Mat3& asked, const Place& place,
                    const Mat3& axes) {
    const auto turn = std::find_if(e.attributes.begin(), e.attributes.end(),
                                   [](const Attribute& a) { return a.operation->traits.turnsShape; });
    if (turn == e.attributes.end() || mating.ours.direction == Vec3d{} || mating.theirs.facing == Vec3d{}) return;
    constexpr double slack = 1e-3;
    bool lost = angleBetween(axes, asked) > slack;
    if (e.to)
        lost = angleBetween(axes, mate(mating, place.scope.axes, place.scope.size).axes) <
               angleBetween(asked, place.scope.axes) - slack;
    if (lost)
        builder.warn(turn->span, "the joints face each other all the same: only the turn about them is left",
                     "leave it out if the shape stands as it should; else turn what a group holds, as in '+ (cube turn "
                     "(30deg, 0deg, 0deg)) size (1, 3, 1) at +y', or place it by 'move'");
}

/// Where an element cuts: a shape, and the child of it before which the cutter joins (none: as the last one).
struct CutPlace {
    ShapeId shape = none, before = none;
};

/// The nearest shape above that `through` names, and those that its content begins with on the way down to the part
/// that cuts: wherever something stands before the part. What the part itself adds stays whole.
std::vector<CutPlace> cutPlaces(TreeBuilder& builder, const Element& e, ShapeId node) {
    const ShapeTree& tree = builder.tree();
    std::vector<CutPlace> way{{node, none}};
    while (way.back().shape != none && tree.shapes[way.back().shape].symbol != e.through)
        way.push_back({tree.shapes[way.back().shape].parent, way.back().shape});
    if (way.back().shape == none) {
        builder.monitor().fail(Error::Kind::Input,
                               "no '" + builder.derivation().grammar->symbols[e.through].name +
                                   "' stands above this shape, so it can't cut one",
                               e.span);
        return {};
    }
    const auto holds = [&](const CutPlace& place) {
        if (tree.shapes[place.shape].solid != none) return true;
        for (ShapeId c = tree.shapes[place.shape].firstChild; c != place.before; c = tree.shapes[c].nextSibling)
            if (tree.shapes[c].op != rules::Operator::Difference) return true;
        return false;
    };
    const CutPlace named = way.back();
    if (way.size() == 1) return {named};
    std::vector<CutPlace> found;
    for (; way.size() > 1; way.pop_back()) {
        if (holds(way.back())) found.push_back(way.back());
        if (tree.shapes[way.back().before].op != rules::Operator::None) break;
    }
    if (found.empty()) found.push_back(named);  // it cuts nothing, and `uncut` tells so
    return found;
}

}  // namespace

/// Attributes without a shape change the matched one.
void Interpreter::annotate(const Element& e, Frame& frame, uint64_t key) {
    Place place = frame.place;
    place.key = key;
    EvaluatedAttributes attributes;
    if (const auto scope = changedScope(e.prefix, place, attributes)) frame.place.scope = *scope;
    applyWhole(e.prefix, place, attributes);
    const Extras& x = attributes.extras;
    if (x.empty()) return;
    Extras& all = builder_.extras(frame.node);
    if (!x.clad.empty()) all.clad = x.clad;
    all.displace.insert(all.displace.end(), x.displace.begin(), x.displace.end());
    all.values.insert(all.values.end(), x.values.begin(), x.values.end());
    all.tags.insert(all.tags.end(), x.tags.begin(), x.tags.end());
    all.reports.insert(all.reports.end(), x.reports.begin(), x.reports.end());
    if (x.laid) {
        all.laid = true;
        if (frame.place.scope != builder_.tree().shapes[frame.node].scope) all.laidScope = frame.place.scope;
    }
    if (!x.values.empty()) frame.place.valuesAt = builder_.tree().shapes.record(frame.node).valuesAt = frame.node;
}

bool Interpreter::placeHead(const Element& e, Frame& frame, Target& target, uint64_t key, bool followed) {
    Place place = frame.place;
    place.key = key;
    EvaluatedAttributes attributes;
    if (!e.prefix.empty()) {
        const auto scope = changedScope(e.prefix, place, attributes);
        if (!scope || builder_.monitor().failed()) return !builder_.monitor().failed();
        place.scope = *scope;
    }
    applyWhole(e.prefix, place, attributes);
    if (!maker_.evaluateAttributes(e, place, attributes)) return false;
    if (attributes.vanishes) return true;
    Shape shape = maker_.shapeOf(e, attributes, place, key, chainRule_);
    shape.scope = attributes.scope;
    shape.scope.centre += attributes.moved_m;
    shape.parent = frame.node;
    if (followed && needsGroup(e, shape)) {
        Shape group;
        group.key = combine(key, hashText("group"));
        group.label = maker_.labelIndex("group");
        group.parent = frame.node;
        group.scope = shape.scope;
        group.span = e.span;
        shape.parent = builder_.add(group);
        if (shape.parent == none) return false;
    }
    const ShapeId id = builder_.add(shape);
    if (id == none) return false;
    if (shape.parent != frame.node) builder_.bonds().revalidate(shape.parent);
    builder_.bonds().revalidate(id);
    if (!fill(e, id, frame)) return false;
    target = {shape.parent == frame.node ? id : shape.parent, id};
    remember(e, frame, id, centreJoint);
    return true;
}

ShapeId Interpreter::hostOf(const Element& e, const Frame& frame, const Target& target, const Place& place) const {
    if (!e.on) return target.host;
    if (e.on->kind == HostChoice::Kind::Last) return frame.state->last;
    const auto direction = static_cast<size_t>(evaluate(e.on->of, place).num());
    if (direction >= faceCount || frame.state->toward[direction].empty()) return frame.state->root;
    const auto& candidates = frame.state->toward[direction];
    if (candidates.size() > 1) builder_.monitor().noteChance();
    return candidates[pick(combine(place.key, hashText("on")), candidates.size())];
}

bool Interpreter::placeGrown(const Element& e, Frame& frame, const Target& target, uint64_t key) {
    Place place = frame.place;
    place.key = key;
    if (!e.on || e.on->kind != HostChoice::Kind::Each)
        return placeOn(hostOf(e, frame, target, place), e, frame, target, key);
    const ShapeTree& tree = builder_.tree();
    if (builder_.recording()) builder_.recording()->readsWorld();
    const auto symbol = static_cast<rules::SymbolId>(e.on->of.value.num());
    std::vector<ShapeId> hosts;  // those that stand now: what grows on them may carry the name too
    for (ShapeId s = frame.state->root; s != none; s = tree.next(s, frame.state->root))
        if (tree.shapes[s].symbol == symbol) hosts.push_back(s);
    select(builder_, e.on->span, !hosts.empty(), [&] {
        const std::string& name = builder_.derivation().grammar->symbols[symbol].name;
        return Explanation{fmt::format("no '{}' stands there yet, so this grows nowhere", name),
                           fmt::format("let a rule of its own wait for all of them, as 'when count({}) > 1'", name),
                           symbol};
    });
    for (const ShapeId host : hosts)
        if (!placeOn(host, e, frame, target, combine(key, tree.shapes[host].key))) return false;
    return true;
}

/// Puts a cutter where `through` says; it is placed and bonded as any newcomer.
bool Interpreter::cutAbove(const Element& e, const Target& target, const Frame& frame, Shape shape, uint32_t ours,
                           uint32_t theirs, ShapeId host) {
    const std::vector<CutPlace> places = cutPlaces(builder_, e, target.node);
    const uint64_t key = shape.key;
    for (size_t i = 0; i < places.size(); ++i) {
        shape.parent = places[i].shape;
        shape.key = i == 0 ? key : combine(key, i);
        shape.meetsNobody = i > 0;
        const ShapeId id = builder_.add(shape, places[i].before);
        if (id == none) return false;
        if (places[i].before != none && !builder_.isReplaying()) builder_.bindTo(id, target.node);
        if (i == 0) {
            builder_.bonds().place({host, ours, id, theirs});
            builder_.bonds().revalidate(id);
            remember(e, frame, id, ours);
        }
        if (!fill(e, id, frame)) return false;
    }
    return !places.empty();
}

bool Interpreter::placeOn(ShapeId host, const Element& e, Frame& frame, const Target& target, uint64_t key) {
    if (e.at && e.at->each) return placeOnFaces(host, e, frame, target, key);
    Attachment attachment{host, centreJoint, {}, frame.place};
    Place& place = attachment.place;
    place.key = key;
    const bool whole = frame.wholeContent && !e.at && !e.on;
    if (whole && builder_.recording()) builder_.recording()->readsWorld();
    const bool stated = e.inMatchedFrame && !e.on && !whole;
    place.scope = whole    ? builder_.tree().contentBox(host)
                  : stated ? frame.place.scope
                           : builder_.tree().shapes[host].scope;
    place.valuesAt = builder_.tree().shapes[host].valuesAt;
    place.host = host;

    if (e.at) {
        std::vector<uint32_t> closed;
        const auto open = openJoints(builder_, *e.at, host, place, closed);
        if (builder_.monitor().failed()) return false;
        if (open.empty()) {  // nothing grows where a bond has closed the joint
            if (!builder_.isReplaying()) maker_.noteClosed(e, host, closed);
            return true;
        }
        if (open.size() > 1) builder_.monitor().noteChance();
        attachment.ours = open[open.size() == 1 ? 0 : pick(combine(key, hashText("at")), open.size())];
    }
    attachment.joint = builder_.tree().joint(host, attachment.ours);
    if (whole || (stated && !e.at)) attachment.joint.point = place.scope.centre;
    return join(e, frame, target, attachment);
}

/// Puts the newcomer where its joint meets ours, and bonds both.
bool Interpreter::join(const Element& e, Frame& frame, const Target& target, const Attachment& attachment) {
    ElementCache& facts = maker_.factsOf(e);
    const Place& place = attachment.place;
    EvaluatedAttributes attributes;
    if (!maker_.evaluateAttributes(e, place, attributes)) return false;
    if (attributes.vanishes) return true;
    Mating mating;
    mating.ours = attachment.joint;
    mating.moved_m = attributes.moved_m;
    mating.overlap = attributes.overlap;
    const uint32_t theirs = theirJoint(builder_, e, facts.jointSet, mating.ours, attributes.scope.axes, place);
    if (theirs == none) return false;
    mating.theirs = jointShares(builder_.tree(), theirs, facts.jointSet);

    Shape shape = maker_.shapeOf(e, attributes, place, place.key, chainRule_);
    shape.parent = target.node;
    shape.scope = mate(mating, attributes.scope.axes, attributes.scope.size);
    shape.scope.footprint = attributes.scope.footprint;
    remarkLostTurn(builder_, e, mating, attributes.scope.axes, place, shape.scope.axes);
    if (e.through != rules::none) {
        shape.valuesAt = place.valuesAt;
        return cutAbove(e, target, frame, shape, attachment.ours, theirs, attachment.host);
    }
    const ShapeId id = builder_.add(shape);
    if (id == none) return false;
    builder_.bonds().place({attachment.host, attachment.ours, id, theirs});
    builder_.bonds().revalidate(id);
    remember(e, frame, id, attachment.ours);
    return fill(e, id, frame);
}

/// Keeps the chain's books: what `last`, `any(d)` and the next step speak of.
void Interpreter::remember(const Element& e, const Frame& frame, ShapeId id, uint32_t ours) {
    RunState& state = *frame.state;
    state.last = id;
    if (ours < faceCount) state.placed[ours].push_back(id);
    if (e.live == rules::none) return;
    const bool own = e.live == builder_.tree().shapes[state.root].symbol;
    if (own || !state.ownSymbol) state.newest = id;
    state.ownSymbol = state.ownSymbol || own;
}

}  // namespace sgm::derive
