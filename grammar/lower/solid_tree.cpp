#include "grammar/lower/solid_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "grammar/lower/plan_planes.h"

namespace sgm::lower {
namespace {

/// The solids of docs/solid-tree.md.
constexpr std::string_view treeSolids[] = {"cube",  "sphere", "ellipsoid", "cylinder", "cone",     "pyramid",
                                           "prism", "wedge",  "torus",     "capsule",  "halfspace"};

using derive::none;
using derive::Shape;
using derive::ShapeId;
using derive::SolidValue;
using field::SolidNode;
using field::SolidTree;
using rules::Operator;
using Op = SolidNode::Op;

/// Operands that wait to become one node; none is the empty solid.
struct Pending {
    Op op = Op::Union;
    std::vector<uint32_t> operands;
    bool touched = false;     ///< something was put in, be it the empty solid
    uint32_t firstSolid = 0;  ///< solids made for this content count from here
};

/// Follows Lowering (lowering.h): the same walk, the same joins, with solids instead of fields. What isn't exactly a
/// solid is noted and counts only where it is part of the whole in the end.
class Collector {
public:
    Collector(const derive::Derivation& d, const Model& model)
        : derivation_(d), tree_(d.tree), origins_(d.tree.shapes.size(), 0) {
        for (OriginId o = static_cast<OriginId>(model.shapeOf.size()); o-- > 1;) origins_[model.shapeOf[o]] = o;
        all_.bounds = model.field.bounds.as<double>();
    }

    Result<SolidTree> run(Progress* progress);

private:
    void enter(ShapeId id);
    void leave(ShapeId id);
    void join(Pending& content, ShapeId id, Pending part);
    uint32_t close(Pending& content);
    void add(Pending& content, Op op, Pending part);
    uint32_t node(SolidNode made);
    Pending solid(const SolidValue& value, ShapeId id);
    Pending primitive(const SolidValue& value, ShapeId id);
    Pending combination(const SolidValue& value, ShapeId id);
    Pending overPlan(const SolidValue& value, ShapeId id);
    uint32_t halfSpace(const field::HalfSpace& plane, ShapeId id);
    uint32_t risen(const plan::Formula& formula, const PlanRise& rise, ShapeId id);
    uint32_t leaf(std::string_view primitive, std::vector<double> arguments, const derive::Scope& scope, ShapeId id);
    Pending inexact(Pending part, ShapeId id, std::string what);
    Result<SolidTree> compacted(uint32_t root) const;

    const derive::Derivation& derivation_;
    const derive::ShapeTree& tree_;
    std::vector<OriginId> origins_;             ///< by shape
    SolidTree all_;                             ///< with nodes that nothing uses in the end
    std::map<uint32_t, std::string> problems_;  ///< by node: why it isn't exact, located
    std::vector<Pending> open_;
};

Pending single(uint32_t node) { return {Op::Union, {node}, true, 0}; }
Pending emptySolid() { return {Op::Union, {}, true, 0}; }

uint32_t Collector::node(SolidNode made) {
    all_.nodes.push_back(std::move(made));
    return static_cast<uint32_t>(all_.nodes.size() - 1);
}

uint32_t Collector::close(Pending& content) {
    return content.operands.size() == 1 ? content.operands[0] : node({content.op, 0, content.operands});
}

/// Joins a part, not empty, to a content that isn't either. Unions in a union and cuts in a row are one node.
void Collector::add(Pending& content, Op op, Pending part) {
    const bool same = content.op == op || content.operands.size() == 1;
    if (!same) content.operands = {close(content)};
    content.op = op;
    const bool splice = part.op == Op::Union && op != Op::Intersection;  // a − (b ∪ c) is a − b − c
    if (splice)
        content.operands.insert(content.operands.end(), part.operands.begin(), part.operands.end());
    else
        content.operands.push_back(close(part));
}

/// `part`, which can't be written exactly, with the reason.
Pending Collector::inexact(Pending part, ShapeId id, std::string what) {
    if (part.operands.empty()) part = single(node({Op::Union, 0, {}}));
    const uint32_t made = part.operands.size() == 1 ? part.operands[0] : close(part);
    const Shape& s = tree_.shapes[id];
    problems_.try_emplace(made, fmt::format("{}'{}' {}", syntax::placeText(s.span), tree_.path(id), what));
    return single(made);
}

uint32_t Collector::leaf(std::string_view primitive, std::vector<double> arguments, const derive::Scope& scope,
                         ShapeId id) {
    all_.solids.push_back(
        {field::findPrimitive(primitive), std::move(arguments), {scope.centre, scope.axes}, scope.size, origins_[id]});
    return node({Op::Solid, static_cast<uint32_t>(all_.solids.size() - 1), {}});
}

Pending Collector::primitive(const SolidValue& value, ShapeId id) {
    const derive::Scope& scope = tree_.shapes[id].scope;
    const std::string name(value.primitive->name);
    if (name == "kifs" || name == "ornament")
        return inexact(emptySolid(), id, fmt::format("is a fractal ({}): no solid is exactly that", name));
    if (name == "mesh")
        return inexact(emptySolid(), id, "is a mesh from a file, of which the model knows samples alone");
    if (value.primitive->plan == field::PlanUse::OwnHeight ||
        (value.primitive->plan != field::PlanUse::None && scope.footprint != none))
        return overPlan(value, id);
    if (name == "block") return single(leaf("cube", {}, scope, id));
    std::vector<double> arguments;
    for (size_t i = 0; i < value.args.size(); ++i) {
        const field::PrimitiveParameter& p = value.primitive->parameters[i];
        arguments.push_back(std::clamp(value.args[i].n[0], p.lo, p.hi));
    }
    if (name != "roof") {
        if (!std::any_of(std::begin(treeSolids), std::end(treeSolids), [&](auto solid) { return solid == name; }))
            return inexact(emptySolid(), id, fmt::format("is a {}, which is no solid of the tree", name));
        return single(leaf(value.primitive->name, std::move(arguments), scope, id));
    }
    if (arguments[0] <= 0) return single(leaf("pyramid", {}, scope, id));
    if (arguments[0] < 1)
        return inexact(
            emptySolid(), id,
            fmt::format("is a roof {:.3g} of the way from a pyramid to an ellipsoid: 0 and 1 alone are solids",
                        arguments[0]));
    // The upper half of an ellipsoid about the foot; the scope cuts it there.
    derive::Scope whole = scope;
    whole.size.y *= 2;
    whole.centre = scope.point({0, -1, 0});
    return {Op::Intersection, {leaf("ellipsoid", {}, whole, id), leaf("cube", {}, scope, id)}, true, 0};
}

/// A half-space given about the scope's centre.
uint32_t Collector::halfSpace(const field::HalfSpace& plane, ShapeId id) {
    const derive::Scope& scope = tree_.shapes[id].scope;
    const field::HalfSpace world = inObject(plane, scope);
    const Vec3d up = world.normal, side = std::abs(up.y) < .9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d x = normalized(cross(side, up));
    derive::Scope placed;
    placed.centre = scope.centre + up * (world.offset - dot(up, scope.centre));
    placed.axes = {x, up, cross(x, up)};
    return leaf("halfspace", {}, placed, id);
}

/// The formula of a footprint as booleans of half-spaces, between two heights.
uint32_t Collector::risen(const plan::Formula& formula, const PlanRise& rise, ShapeId id) {
    std::vector<uint32_t> made;
    for (const plan::FormulaNode& node : formula.nodes) {
        if (node.kind != plan::FormulaNode::Kind::Edge) {
            const Op op = node.kind == plan::FormulaNode::Kind::Max ? Op::Intersection : Op::Union;
            made.push_back(this->node({op, 0, {made[node.first], made[node.second]}}));
            continue;
        }
        std::vector<uint32_t> planes;
        for (const field::HalfSpace& plane : rise.sides[node.first]) planes.push_back(halfSpace(plane, id));
        made.push_back(planes.size() == 1 ? planes[0] : this->node({Op::Intersection, 0, std::move(planes)}));
    }
    const uint32_t top = halfSpace({{0, 1, 0}, rise.top_m}, id), bottom = halfSpace({{0, -1, 0}, -rise.bottom_m}, id);
    return node({Op::Intersection, 0, {top, bottom, made.back()}});
}

Pending Collector::overPlan(const SolidValue& value, ShapeId id) {
    const auto planes = planesOver(value, tree_.shapes[id].scope, tree_.footprints);
    if (!planes)
        return inexact(emptySolid(), id, fmt::format("is a {}, which isn't written as planes", value.primitive->name));
    const uint32_t outer = risen(planes->formula, planes->outer, id);
    return single(planes->hollow ? node({Op::Difference, 0, {outer, risen(planes->formula, *planes->hollow, id)}})
                                 : outer);
}

/// Not as a content of shapes: what is cut from nothing stays nothing, and what cuts may be nothing.
Pending Collector::combination(const SolidValue& value, ShapeId id) {
    Pending all = solid(value.parts[0], id);
    for (size_t i = 1; i < value.parts.size(); ++i) {
        Pending part = solid(value.parts[i], id);
        const bool sum = value.op != Operator::Difference && value.op != Operator::Intersection;
        if (all.operands.empty()) {
            if (sum) all = std::move(part);
        } else if (part.operands.empty()) {
            if (value.op == Operator::Intersection) all = emptySolid();
        } else {
            add(all,
                sum                                ? Op::Union
                : value.op == Operator::Difference ? Op::Difference
                                                   : Op::Intersection,
                std::move(part));
        }
    }
    return all;
}

/// Recursion follows the solid's text, which nests a few levels at most.
Pending Collector::solid(const SolidValue& value, ShapeId id) {
    switch (value.kind) {
        case rules::Solid::Kind::Primitive:
            return primitive(value, id);
        case rules::Solid::Kind::Combination:
            return combination(value, id);
        case rules::Solid::Kind::Morph: {
            if (value.amount <= 0) return solid(value.parts[0], id);
            if (value.amount >= 1) return solid(value.parts[1], id);
            return inexact(emptySolid(), id,
                           fmt::format("is a morph, {:.3g} of the way: 0 and 1 alone are solids", value.amount));
        }
        case rules::Solid::Kind::Nil:
            break;
    }
    return emptySolid();
}

/// As Lowering::join: `part` is not empty.
void Collector::join(Pending& content, ShapeId id, Pending part) {
    const Shape& s = tree_.shapes[id];
    const bool empty = content.operands.empty(), first = !content.touched;
    content.touched = true;
    if (s.op == Operator::Morph) {
        const bool stays = !first && s.amount <= 0;
        if (!first && s.amount > 0 && s.amount < 1) {
            content = inexact(std::move(content), id,
                              fmt::format("morphs what stands, {:.3g} of the way: 0 and 1 alone are solids", s.amount));
            return;
        }
        if (!first)  // whatever is left is the morph's
            for (uint32_t i = content.firstSolid; i < all_.solids.size(); ++i) all_.solids[i].origin = origins_[id];
        if (stays) return;
        content.op = part.op;
        content.operands = std::move(part.operands);
        return;
    }
    if (s.op == Operator::Sum || s.op == Operator::None) {
        if (empty)
            content.op = part.op, content.operands = std::move(part.operands);
        else
            add(content, Op::Union,
                s.blend_m > 0 ? inexact(std::move(part), id, fmt::format("is blended in over {:.3g} m", s.blend_m))
                              : std::move(part));
        return;
    }
    content.touched = !first;
    if (empty) return;  // nothing to cut from, nothing to share
    if (s.op == Operator::Intersection)
        add(content, Op::Intersection, std::move(part));
    else
        add(content, Op::Difference,
            s.blend_m > 0
                ? inexact(std::move(part), id, fmt::format("cuts with edges blended over {:.3g} m", s.blend_m))
                : std::move(part));
}

void Collector::enter(ShapeId id) {
    open_.push_back({});
    open_.back().firstSolid = static_cast<uint32_t>(all_.solids.size());
    if (tree_.shapes[id].solid == none) return;
    Pending own = solid(*tree_.solidOf(id), id);
    own.firstSolid = open_.back().firstSolid;
    open_.back() = std::move(own);
}

void Collector::leave(ShapeId id) {
    Pending part = std::move(open_.back());
    open_.pop_back();
    if (const auto* x = tree_.extrasOf(id); x && !part.operands.empty()) {
        const bool noise = std::any_of(x->displace.begin(), x->displace.end(),
                                       [](const derive::Displacement& n) { return n.amplitude_m != 0; });
        if (!x->clad.empty())
            part = inexact(std::move(part), id, "is clad with an ornament");
        else if (noise)
            part = inexact(std::move(part), id, "is displaced by noise");
        else if (x->relief != none)
            part = inexact(std::move(part), id, "follows hills");
    }
    if (open_.empty()) return void(open_.push_back(std::move(part)));
    if (!part.operands.empty())
        join(open_.back(), id, std::move(part));
    else if (tree_.shapes[id].op == Operator::Intersection)
        open_.back().operands.clear(), open_.back().touched = false;
}

Result<SolidTree> Collector::run(Progress* progress) {
    if (progress) progress->begin("solids", tree_.shapes.size());
    for (ShapeId s = 0;;) {
        enter(s);
        if (progress) progress->tick();
        if (s % 256 == 0 && cancelled(progress))
            return Error{Error::Kind::Cancelled, "cancelled while collecting solids"};
        if (tree_.shapes[s].firstChild != none) {
            s = tree_.shapes[s].firstChild;
            continue;
        }
        leave(s);
        while (s != 0 && tree_.shapes[s].nextSibling == none) leave(s = tree_.shapes[s].parent);
        if (s == 0) break;
        s = tree_.shapes[s].nextSibling;
    }
    Pending& whole = open_.back();
    if (!whole.operands.empty()) return compacted(close(whole));
    return derive::nothingSolid(derivation_);
}

/// The nodes that `root` is made of, and their solids, in their order; the first problem among them is the error.
Result<SolidTree> Collector::compacted(uint32_t root) const {
    std::vector<bool> used(all_.nodes.size(), false);
    used[root] = true;
    for (uint32_t n = root + 1; n-- > 0;)
        if (used[n])
            for (const uint32_t o : all_.nodes[n].operands) used[o] = true;
    for (const auto& [n, problem] : problems_)
        if (used[n])
            return Error{Error::Kind::Input,
                         problem +
                             "; trees of solids (.scad, .csg.json) hold sharp unions, cuts and intersections of "
                             "exact solids alone: leave it out, or write a mesh, such as .glb or .stl"};

    SolidTree tree;
    tree.bounds = all_.bounds;
    std::vector<uint32_t> placeOf(all_.nodes.size(), 0);
    for (uint32_t n = 0; n <= root; ++n) {
        if (!used[n]) continue;
        SolidNode copy = all_.nodes[n];
        for (uint32_t& o : copy.operands) o = placeOf[o];
        if (copy.op == Op::Solid) {
            tree.solids.push_back(all_.solids[copy.solid]);
            copy.solid = static_cast<uint32_t>(tree.solids.size() - 1);
        }
        placeOf[n] = static_cast<uint32_t>(tree.nodes.size());
        tree.nodes.push_back(std::move(copy));
    }
    return tree;
}

}  // namespace

Result<SolidTree> solidTree(const derive::Derivation& derivation, const Model& model, Progress* progress) {
    return Collector(derivation, model).run(progress);
}

}  // namespace sgm::lower
