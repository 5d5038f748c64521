#include "grammar/derive/shape_maker.h"

#include <fmt/format.h>

#include <cmath>

#include "modeler/core/random.h"
#include "modeler/field/plan_solids.h"

namespace sgm::derive {

using rules::Attribute;
using rules::Element;
using rules::Solid;
using Phase = rules::Operation::Phase;

namespace {

/// The solid that an element puts without further rules; null for groups and non-terminals.
const Solid* ownSolid(const Element& e, const rules::Grammar& grammar) {
    if (const Solid* solid = e.content.solid()) return solid;
    const rules::SymbolId symbol = e.content.symbol();
    if (symbol == rules::none || !grammar.symbols[symbol].terminal) return nullptr;
    static const Solid cube = [] {
        Solid s;
        s.kind = Solid::Kind::Primitive;
        s.primitive = field::findPrimitive("cube");
        return s;
    }();
    const auto& solid = grammar.symbols[symbol].solid;
    return solid ? &*solid : &cube;
}

/// A terminal without a solid: it fills its footprint.
bool fillsFootprint(const Element& e, const rules::Grammar& grammar) {
    const rules::SymbolId symbol = e.content.symbol();
    return symbol != rules::none && grammar.symbols[symbol].terminal && !grammar.symbols[symbol].solid;
}

/// True when parameters alone decide the solid: one value serves all its shapes.
bool isConstant(const Solid& solid) {
    const auto plain = [](const rules::Expr& x) {
        return x.kind == rules::Expr::Kind::Constant || x.kind == rules::Expr::Kind::Param;
    };
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

/// Lets the newcomer's y run from one point to the other, turned as little as possible.
void spanBetween(AttributeContext& context) {
    EvaluatedAttributes& out = context.out;
    const Vec3d along_m = out.span->to_m - out.span->from_m;
    const double length_m = length(along_m);
    if (!(length_m > 1e-9)) return context.fail("both ends of 'from … to …' are at one point", out.span->at);
    Mating upright;
    upright.ours.direction = context.place.scope.axes * along_m * (-1 / length_m);
    upright.theirs.facing = {0, 1, 0};
    out.scope.axes = mate(upright, out.scope.axes, out.scope.size).axes;
    out.scope.size.y = length_m;
    out.moved_m += context.place.scope.axes * ((out.span->from_m + out.span->to_m) * 0.5);
}

}  // namespace

void ShapeMaker::noteClosed(const Element& e, ShapeId host, const std::vector<uint32_t>& joints) {
    ElementCache& facts = factsOf(e);
    auto& closed = builder_.derivation().closed;
    if (facts.closed == none) {
        facts.closed = static_cast<uint32_t>(closed.size());
        closed.push_back({e.span, 0, host, joints});
    }
    ++closed[facts.closed].count;
}

ElementCache& ShapeMaker::factsOf(const Element& e) {
    const auto [at, fresh] = elements_.try_emplace(&e);
    ElementCache& facts = at->second;
    if (!fresh) return facts;
    facts.hash = combine(hashText(e.label), e.ordinal);
    facts.label = labelIndex(e.live != rules::none ? grammar_.symbols[e.live].name : e.label);
    facts.jointSet = jointSetOf(e);
    if (const Solid* solid = ownSolid(e, grammar_)) facts.constantSolid = isConstant(*solid);
    return facts;
}

uint32_t ShapeMaker::labelIndex(std::string_view text) {
    if (const auto known = labels_.find(text); known != labels_.end()) return known->second;
    const auto index = static_cast<uint32_t>(labels_.size());
    labels_.emplace(text, index);
    builder_.tree().labels.emplace_back(text);
    return index;
}

/// The joints that the symbol, its solid's row and the live name declare.
uint32_t ShapeMaker::jointSetOf(const Element& e) {
    std::vector<rules::Joint> set;
    for (const rules::SymbolId symbol : {e.content.symbol(), e.live})
        if (symbol != rules::none)
            set.insert(set.end(), grammar_.symbols[symbol].joints.begin(), grammar_.symbols[symbol].joints.end());
    if (const Solid* solid = ownSolid(e, grammar_); solid && solid->primitive)
        for (const field::PrimitiveJoint& j : solid->primitive->joints)
            set.push_back({std::string(j.name), j.at, j.facing});
    if (set.empty()) return 0;
    auto& sets = builder_.tree().namedJoints;
    sets.push_back(std::move(set));
    return static_cast<uint32_t>(sets.size() - 1);
}

/// The solid of terminals over a footprint: one for all.
uint32_t ShapeMaker::blockSolid() {
    if (block_ == none) {
        SolidValue block;
        block.kind = Solid::Kind::Primitive;
        block.primitive = field::findPrimitive("block");
        block_ = builder_.put(std::move(block), true);
    }
    return block_;
}

uint32_t ShapeMaker::solidOf(const Element& e, ElementCache& facts, const Place& place, const Scope& scope) {
    if (scope.footprint != none && fillsFootprint(e, grammar_)) return blockSolid();
    const Solid* solid = ownSolid(e, grammar_);
    if (!solid || solid->kind == Solid::Kind::Nil) return none;
    Recording* const recording = builder_.recording();
    if (facts.solid != none) {
        if (!recording) return facts.solid;
        if (facts.solidTurn != recording->turn()) builder_.replace(facts.solid, evaluateSolid(*solid, place));
        facts.solidTurn = recording->turn();
        recording->readsParams(facts.solidParams);
        return facts.solid;
    }
    const uint32_t index = builder_.put(evaluateSolid(*solid, place), facts.constantSolid);
    if (facts.constantSolid) {
        facts.solid = index;
        if (recording) facts.solidParams = paramsOf(*solid);
    }
    return index;
}

bool ShapeMaker::evaluateAttributes(const Element& e, const Place& place, EvaluatedAttributes& out) {
    out.scope = place.scope;
    AttributeContext context{place, out};
    const auto apply = [&](const std::vector<Attribute>& list, bool scope) {
        for (const Attribute& a : list)
            if (a.operation->apply && (a.operation->phase == Phase::Scope) == scope) a.operation->apply(context, a);
    };
    apply(e.attributes, true);
    if (!e.at && !e.to) out.moved_m += out.grown_m;
    if (out.span) spanBetween(context);
    if (out.vanishes) return true;
    standAsHigh(e, place, out);
    if (const rules::SymbolId symbol = e.content.symbol(); symbol != rules::none) {
        apply(grammar_.symbols[symbol].look, false);
        out.colorBy = nullptr;  // the terminal itself names such a look
    }
    apply(e.attributes, false);
    return inBounds(e, out);
}

/// A roof is as high as its pitch makes it; where no joint places it, its foot stays that of the scope.
void ShapeMaker::standAsHigh(const Element& e, const Place& place, EvaluatedAttributes& out) {
    const Solid* solid = ownSolid(e, grammar_);
    if (!solid || !solid->primitive || solid->primitive->plan != field::PlanUse::OwnHeight ||
        builder_.monitor().failed())
        return;
    const SolidValue value = evaluateSolid(*solid, place);
    const std::vector<field::Argument> arguments = argumentNumbers(value);
    if (const std::string fault = field::profileFault(*value.primitive, arguments); !fault.empty()) {
        builder_.monitor().fail(Error::Kind::Input, fault, solid->span);
        return;
    }
    const AttributeContext context{place, out};
    const plan::Footprint footprint = context.footprint();
    Footprints& footprints = builder_.tree().footprints;
    const uint32_t index = out.scope.footprint;
    plan::Formula rectangle;
    if (index == none) {
        auto formula = plan::monotoneFormula(footprint);
        if (!formula.ok()) return context.fail(formula.error().message, e.span);
        rectangle = std::move(*formula);
    }
    const auto numbers =
        std::make_shared<const field::PlanNumbers>(footprint, index == none ? rectangle : footprints[index].formula);
    const double height_m = std::max(1e-3, field::heightOver(*value.primitive, numbers, arguments));
    // Lowering needs the same depth.
    if (numbers->knownDepth() && index != none) footprints.noteDepth(index, out.scope.half(), *numbers->knownDepth());
    if (e.op == rules::Operator::None) out.moved_m += out.scope.axes.y * ((height_m - out.scope.size.y) / 2);
    out.scope.size.y = height_m;
}

/// Refuses numbers that no model can be made of, where they are written.
bool ShapeMaker::inBounds(const Element& e, const EvaluatedAttributes& attributes) {
    for (int i = 0; i < 3; ++i) {
        const double s = attributes.scope.size[i];
        if (s > 0 && s < 1e9 && std::abs(attributes.moved_m[i]) < 1e9) continue;
        const Vec3d size = attributes.scope.size;
        builder_.monitor().fail(Error::Kind::Input,
                                s > 0 ? "the shape would be larger or farther away than 1e9 metres"
                                      : fmt::format("the size of the shape isn't positive along {}: "
                                                    "({:.6g}m, {:.6g}m, {:.6g}m)",
                                                    "xyz"[i], size.x, size.y, size.z),
                                attributes.sizeSpan.value_or(e.span));
        return false;
    }
    return !builder_.monitor().failed();
}

/// The parameter or inherited value that gives an expression its colour: one that has it, else the first one that is a
/// colour at all; "" where none is.
std::string ShapeMaker::nameOfColor(const rules::Expr& e, Vec3f color, const Place& place) const {
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
std::string ShapeMaker::nameOfLook(const EvaluatedAttributes& attributes, uint32_t base, const Place& place) const {
    const auto& materials = builder_.derivation().materials;
    std::string name;
    if (attributes.colorBy) name = nameOfColor(*attributes.colorBy, *attributes.color, place);
    if (!name.empty()) return name;
    if (base != rules::none) return materials[base].name;
    if (!attributes.colorBy) return materials[0].name;
    return "color_" + rules::toText(evaluate(*attributes.colorBy, place)).substr(1);
}

/// One object for all that are alike, so that materials of one look are one.
std::shared_ptr<const image::Texture> ShapeMaker::textureOf(const PlacedTexture& asked) {
    auto& texture = textures_[asked];
    if (texture) return texture;
    const auto file = [&](uint32_t place) { return place > 0 ? grammar_.images[place - 1] : nullptr; };
    texture = std::make_shared<image::Texture>(image::Texture{
        file(asked.color), file(asked.normals), file(asked.roughness), asked.width_m, asked.height_m, asked.fits});
    return texture;
}

/// The material of the terminal, or of the first in a solid, changed by colour, roughness and metalness where given.
uint32_t ShapeMaker::materialOf(const EvaluatedAttributes& attributes, const Element& e, const Place& place) {
    const rules::SymbolId symbol = e.content.symbol();
    const bool terminal = symbol != rules::none && grammar_.symbols[symbol].terminal;
    const uint32_t base = attributes.material ? *attributes.material
                          : terminal          ? grammar_.symbols[symbol].material
                          : e.content.solid() ? e.content.solid()->material
                                              : rules::none;
    if (!attributes.color && !attributes.rough && !attributes.metal && !attributes.texture) return base;
    auto& materials = builder_.derivation().materials;
    Material m = base == rules::none ? materials[0] : materials[base];
    if (attributes.color) m.color = *attributes.color;
    if (attributes.rough) m.roughness = *attributes.rough;
    if (attributes.metal) m.metallic = *attributes.metal;
    if (attributes.texture) m.texture = textureOf(*attributes.texture);
    const Look key{{m.color.x, m.color.y, m.color.z, m.roughness, m.metallic}, m.texture};
    const auto [at, fresh] = mixedMaterials_.try_emplace(key, static_cast<uint32_t>(materials.size()));
    if (fresh) {
        m.name = nameOfLook(attributes, base, place);
        materials.push_back(std::move(m));
        if (builder_.recording()) builder_.recording()->freshMaterial();
    }
    return at->second;
}

Shape ShapeMaker::shapeOf(const Element& e, EvaluatedAttributes& attributes, const Place& place, uint64_t key,
                          uint32_t chainRule) {
    ElementCache& facts = factsOf(e);
    Shape s;
    s.key = key;
    s.symbol = e.live != rules::none ? e.live : e.content.symbol();
    s.live = e.live != rules::none || (s.symbol != rules::none && !grammar_.symbols[s.symbol].terminal);
    s.label = facts.label;
    s.jointSet = facts.jointSet;
    s.solid = solidOf(e, facts, place, attributes.scope);
    s.material = materialOf(attributes, e, place);
    s.op = e.op;
    s.amount = attributes.amount;
    s.blend_m = attributes.blend_m;
    s.span = e.span;
    if (!attributes.extras.empty()) {
        if (!attributes.extras.displace.empty()) builder_.monitor().noteChance();  // noise hangs on the shape's key
        s.extras = builder_.put(std::move(attributes.extras));
    }
    if (e.live != rules::none) s.chainRule = chainRule;
    return s;
}

}  // namespace sgm::derive
