// What a shape is made of and looks like: solids, materials, declared joints, attributes, and what fills it.
#include <fmt/format.h>

#include <cmath>

#include "grammar/derive/interpreter.h"
#include "modeler/core/random.h"

namespace sgm::derive {

using rules::Attribute;
using rules::Content;
using rules::Element;
using rules::Solid;
using Id = rules::Operation::Id;

namespace {

/// The solid that an element puts without further rules; null for groups and non-terminals.
const Solid* ownSolid(const Element& e, const rules::Grammar& grammar) {
    if (e.content.kind == Content::Kind::Solid) return &e.content.solid;
    if (e.content.kind != Content::Kind::Symbol || !grammar.symbols[e.content.symbol].terminal) return nullptr;
    static const Solid cube = [] {
        Solid s;
        s.kind = Solid::Kind::Primitive;
        s.primitive = field::findPrimitive("cube");
        return s;
    }();
    const auto& solid = grammar.symbols[e.content.symbol].solid;
    return solid ? &*solid : &cube;
}

/// True when parameters alone decide the solid: one value serves all its shapes.
bool isConstant(const Solid& solid) {
    const auto plain = [](const rules::Expr& x) { return x.kind == rules::Expr::Kind::Constant || x.kind == rules::Expr::Kind::Param; };
    if (!plain(solid.amount)) return false;
    for (const auto& arg : solid.args)
        if (!plain(arg)) return false;
    for (const Solid& part : solid.parts)
        if (!isConstant(part)) return false;
    return true;
}

/// The parameters of a constant solid, as Piece::params.
uint64_t paramsOf(const Solid& solid) {
    uint64_t set = 0;
    const auto add = [&](const rules::Expr& x) {
        if (x.kind == rules::Expr::Kind::Param) set |= uint64_t{1} << x.index % 64;
    };
    add(solid.amount);
    for (const auto& arg : solid.args) add(arg);
    for (const Solid& part : solid.parts) set |= paramsOf(part);
    return set;
}

/// Metres of a component that may be a share of `whole`.
double metres(const Vector& v, int i, double whole) { return v.unit[i] == rules::Unit::Share ? v.n[i] * whole : v.n[i]; }

}  // namespace

Interpreter::ElementFacts& Interpreter::factsOf(const Element& e) {
    const auto [at, fresh] = elements_.try_emplace(&e);
    ElementFacts& facts = at->second;
    if (!fresh) return facts;
    facts.hash = combine(hashText(e.label), e.ordinal);
    facts.label = labelOf(e);
    facts.jointSet = jointSetOf(e);
    if (const Solid* solid = ownSolid(e, grammar_)) facts.constantSolid = isConstant(*solid);
    for (const Attribute& a : e.attributes) {
        if (a.id == Id::At) facts.at = &a;
        if (a.id == Id::To) facts.to = &a;
        if (a.id == Id::On) facts.on = &a;
        if (a.id == Id::Size) facts.size = &a;
        if (a.id == Id::Turn) facts.turn = &a;
    }
    return facts;
}

uint32_t Interpreter::labelOf(const Element& e) {
    std::string text = e.label;
    if (e.live != rules::none) text = grammar_.symbols[e.live].name;
    const auto [at, fresh] = labels_.try_emplace(std::move(text), static_cast<uint32_t>(labels_.size()));
    if (fresh) builder_.tree().labels.push_back(at->first);
    return at->second;
}

/// The joints that the symbol, its solid's row and the live name declare.
uint32_t Interpreter::jointSetOf(const Element& e) {
    std::vector<rules::Joint> set;
    for (const rules::SymbolId symbol : {e.content.symbol, e.live})
        if (symbol != rules::none) set.insert(set.end(), grammar_.symbols[symbol].joints.begin(), grammar_.symbols[symbol].joints.end());
    if (const Solid* solid = ownSolid(e, grammar_); solid && solid->primitive)
        for (const field::PrimitiveJoint& j : solid->primitive->joints) set.push_back({std::string(j.name), j.at, j.facing});
    if (set.empty()) return 0;
    auto& sets = builder_.tree().namedJoints;
    sets.push_back(std::move(set));
    return static_cast<uint32_t>(sets.size() - 1);
}

SolidValue Interpreter::valueOf(const Solid& solid, const Place& place) const {
    SolidValue v;
    v.kind = solid.kind;
    v.primitive = solid.primitive;
    v.op = solid.op;
    for (const rules::Expr& arg : solid.args) v.args.push_back(evaluate(arg, place));
    for (const Solid& part : solid.parts) v.parts.push_back(valueOf(part, place));
    if (solid.kind == Solid::Kind::Morph) v.amount = std::clamp(number(solid.amount, place), 0.0, 1.0);
    return v;
}

uint32_t Interpreter::solidOf(const Element& e, ElementFacts& facts, const Place& place) {
    const Solid* solid = ownSolid(e, grammar_);
    if (!solid || solid->kind == Solid::Kind::Nil) return none;
    Recording* const recording = builder_.recording();
    if (facts.solid != none) {
        if (!recording) return facts.solid;
        if (facts.solidTurn != recording->turn()) builder_.replace(facts.solid, valueOf(*solid, place));
        facts.solidTurn = recording->turn();
        recording->readsParams(facts.solidParams);
        return facts.solid;
    }
    const uint32_t index = builder_.put(valueOf(*solid, place), facts.constantSolid);
    if (facts.constantSolid) {
        facts.solid = index;
        if (recording) facts.solidParams = paramsOf(*solid);
    }
    return index;
}

bool Interpreter::readLooks(const Element& e, const ElementFacts& facts, const Place& place, Looks& out) {
    out.scope = place.scope;
    if (facts.size) {
        const Vector size = vector(facts.size->args[0], place, false);
        for (int i = 0; i < 3; ++i) out.scope.size[i] = metres(size, i, place.scope.size[i]);
    }
    if (facts.turn) out.scope.axes = place.scope.axes * rotation(evaluate(facts.turn->args[0], place));
    if (e.content.kind == Content::Kind::Symbol) {
        for (const Attribute& a : grammar_.symbols[e.content.symbol].look) readAttribute(a, place, out);
        out.colorBy = nullptr;  // the terminal itself names such a look
    }
    for (const Attribute& a : e.attributes) readAttribute(a, place, out);
    return inBounds(e, facts, out);
}

/// Refuses numbers that no model can be made of, where they are written.
bool Interpreter::inBounds(const Element& e, const ElementFacts& facts, const Looks& looks) {
    for (int i = 0; i < 3; ++i) {
        const double s = looks.scope.size[i];
        if (s > 0 && s < 1e9 && std::abs(looks.moved_m[i]) < 1e9) continue;
        builder_.fail(Error::Kind::Input, s > 0 ? "the shape would be larger or farther away than 1e9 metres" : "the size of the shape isn't positive",
                      facts.size ? facts.size->span : e.span);
        return false;
    }
    if (const Mat3& m = looks.scope.axes; !std::isfinite(length(m.x) + length(m.y) + length(m.z))) {
        builder_.fail(Error::Kind::Input, "the angle of the turn is no finite number", facts.turn ? facts.turn->span : e.span);
        return false;
    }
    return !builder_.failed();
}

/// Refuses noise that is finer or higher than single precision tells places apart.
void Interpreter::checkNoise(const Displacement& noise, syntax::SourceSpan span) {
    constexpr double finest_per_m = 1e5, highest_m = 1e6;
    if (std::abs(noise.amplitude_m) <= highest_m && std::abs(noise.frequency) <= finest_per_m) return;
    builder_.fail(Error::Kind::Input, fmt::format("noise is at most {:g} m high and has at most {:g} waves a metre", highest_m, finest_per_m), span);
}

void Interpreter::readAttribute(const Attribute& a, const Place& place, Looks& out) {
    switch (a.id) {
        case Id::Shift: {
            // S_J, the paper's shift of the joint: bare numbers and shares are of the newcomer's half-size.
            const Vector v = vector(a.args[0], place, true);
            Vec3d m;
            for (int i = 0; i < 3; ++i) m[i] = v.unit[i] == rules::Unit::Metre ? v.n[i] : v.n[i] * out.scope.half()[i];
            out.moved_m += place.scope.axes * m;
            break;
        }
        case Id::Move: {
            const Vector v = vector(a.args[0], place, true);
            out.moved_m += place.scope.axes * Vec3d{metres(v, 0, place.scope.size.x), metres(v, 1, place.scope.size.y), metres(v, 2, place.scope.size.z)};
            break;
        }
        case Id::Overlap: out.overlap = number(a.args[0], place); break;
        case Id::By: out.amount = std::clamp(number(a.args[0], place), 0.0, 1.0); break;
        case Id::Blend: out.blend_m = std::max(0.0, number(a.args[0], place)); break;
        case Id::Displace: {
            Displacement d;
            d.fbm = a.fbm;
            d.amplitude_m = number(a.args[0], place);
            d.frequency = number(a.args[1], place);
            if (a.args.size() > 2) d.octaves = static_cast<int>(std::clamp(number(a.args[2], place), 1.0, 8.0));
            checkNoise(d, a.span);
            out.extras.displace.push_back(d);
            break;
        }
        case Id::Color: {
            const rules::Value c = evaluate(a.args[0], place);
            out.color = Vec3d{c.n[0], c.n[1], c.n[2]}.as<float>();
            out.colorBy = &a.args[0];
            break;
        }
        case Id::Rough: out.rough = static_cast<float>(std::clamp(number(a.args[0], place), 0.0, 1.0)); break;
        case Id::Metal: out.metal = static_cast<float>(std::clamp(number(a.args[0], place), 0.0, 1.0)); break;
        case Id::Tag: out.extras.tags.push_back(a.args[0].value.text); break;
        case Id::With: out.extras.values.emplace_back(a.args[0].value.text, evaluate(a.args[1], place)); break;
        case Id::Clad: {
            const bool named = a.symbol != rules::none;
            out.extras.clad = {{valueOf(*a.pattern, place), named ? grammar_.symbols[a.symbol].name : "", named ? grammar_.symbols[a.symbol].material : none}};
            break;
        }
        // Read before, with the joints or the scope.
        case Id::Size: case Id::Turn: case Id::At: case Id::To: case Id::On:
        // Put into the pattern of `clad` by the checker.
        case Id::Thickness: case Id::Tile: case Id::Mirror:
        // Refused by the checker.
        case Id::Split: case Id::Inset: case Id::Footprint: case Id::Extrude: case Id::Faces: case Id::Roof: case Id::Balcony: break;
    }
}

/// The parameter or inherited value that gives an expression its colour: one that has it, else the first one that is a
/// colour at all; "" where none is.
std::string Interpreter::nameOfColor(const rules::Expr& e, Vec3f color, const Place& place) const {
    std::string first;
    std::vector<const rules::Expr*> open{&e};
    while (!open.empty()) {
        const rules::Expr& at = *open.back();
        open.pop_back();
        for (auto arg = at.args.rbegin(); arg != at.args.rend(); ++arg) open.push_back(&*arg);
        if (at.kind != rules::Expr::Kind::Param && at.kind != rules::Expr::Kind::Inherited) continue;
        const rules::Value value = evaluate(at, place);
        if (value.kind != rules::Value::Kind::Color) continue;
        const std::string& name = at.kind == rules::Expr::Kind::Param ? grammar_.params[at.index].name : at.value.text;
        if (Vec3d{value.n[0], value.n[1], value.n[2]}.as<float>() == color) return name;
        if (first.empty()) first = name;
    }
    return first;
}

/// What names a look: what gives it its colour, the terminal it changes, or the colour itself.
std::string Interpreter::nameOfLook(const Looks& looks, uint32_t base, const Place& place) const {
    const auto& materials = builder_.derivation().materials;
    std::string name;
    if (looks.colorBy) name = nameOfColor(*looks.colorBy, *looks.color, place);
    if (!name.empty()) return name;
    if (base != rules::none) return materials[base].name;
    if (!looks.colorBy) return materials[0].name;
    return "color_" + rules::toText(evaluate(*looks.colorBy, place)).substr(1);
}

/// The material of the terminal, or of the first in a solid, changed by colour, roughness and metalness where given.
uint32_t Interpreter::materialOf(const Looks& looks, const Element& e, const Place& place) {
    const bool terminal = e.content.kind == Content::Kind::Symbol && grammar_.symbols[e.content.symbol].terminal;
    const uint32_t base = terminal ? grammar_.symbols[e.content.symbol].material : e.content.solid.material;
    if (!looks.color && !looks.rough && !looks.metal) return base;
    auto& materials = builder_.derivation().materials;
    Material m = base == rules::none ? materials[0] : materials[base];
    if (looks.color) m.color = *looks.color;
    if (looks.rough) m.roughness = *looks.rough;
    if (looks.metal) m.metallic = *looks.metal;
    const std::array<float, 5> key{m.color.x, m.color.y, m.color.z, m.roughness, m.metallic};
    const auto [at, fresh] = mixedMaterials_.try_emplace(key, static_cast<uint32_t>(materials.size()));
    if (fresh) {
        m.name = nameOfLook(looks, base, place);
        materials.push_back(std::move(m));
        if (builder_.recording()) builder_.recording()->freshMaterial();
    }
    return at->second;
}

/// The node of an element, unplaced: everything but parent, centre and children.
Shape Interpreter::shapeOf(const Element& e, Looks& looks, const Place& place, uint64_t key) {
    ElementFacts& facts = factsOf(e);
    Shape s;
    s.key = key;
    s.symbol = e.live != rules::none ? e.live : e.content.symbol;
    s.live = e.live != rules::none || (s.symbol != rules::none && !grammar_.symbols[s.symbol].terminal);
    s.label = facts.label;
    s.jointSet = facts.jointSet;
    s.solid = solidOf(e, facts, place);
    s.material = materialOf(looks, e, place);
    s.op = e.op;
    s.amount = looks.amount;
    s.blend_m = looks.blend_m;
    s.span = e.span;
    if (!looks.extras.empty()) {
        s.extras = builder_.put(std::move(looks.extras));
    }
    if (e.live != rules::none) s.chainRule = chainRule_;
    return s;
}

/// What stands inside a shape: the non-terminal that `: Name` wraps, the shapes of a group, or the parts of a split.
bool Interpreter::fill(const Element& e, ShapeId id, const Frame& frame) {
    const Shape& s = builder_.tree().shapes[id];
    if (e.content.kind == Content::Kind::Group || e.content.kind == Content::Kind::Split) {
        Links links;
        links.root = links.last = id;
        Frame inner = frame;
        inner.matched = inner.node = id;
        inner.key = s.key;
        inner.links = &links;
        inner.wholeContent = false;
        inner.place.scope = s.scope;
        inner.place.valuesAt = s.valuesAt;
        if (e.content.kind == Content::Kind::Split) return runSplit(*e.content.split, inner);
        return runBody(*e.content.group, inner, 0);
    }
    if (e.live == rules::none || e.content.kind != Content::Kind::Symbol || grammar_.symbols[e.content.symbol].terminal) return true;
    Shape inner;
    inner.key = combine(s.key, hashText("content"));
    inner.parent = id;
    inner.symbol = e.content.symbol;
    inner.live = true;
    inner.scope = s.scope;
    inner.span = e.span;
    const auto [at, fresh] = labels_.try_emplace(grammar_.symbols[inner.symbol].name, static_cast<uint32_t>(labels_.size()));
    if (fresh) builder_.tree().labels.push_back(at->first);
    inner.label = at->second;
    return builder_.add(inner) != none;
}

}  // namespace sgm::derive
