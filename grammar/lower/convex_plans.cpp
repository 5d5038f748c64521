#include "grammar/lower/convex_plans.h"

#include "grammar/lower/plan_planes.h"

namespace sgm::lower {
namespace {

using derive::Scope;
using derive::ShapeId;
using field::ConvexPart;
using field::HalfSpace;
using mesh::ConvexPolyhedron;

constexpr size_t mostPieces = 512;

/// The formula on polyhedra: minima unite, what is there already is taken off first, and maxima intersect.
std::optional<ConvexContent> carriedOut(const plan::Formula& formula, const PlanRise& rise, const Scope& scope,
                                        ShapeId shape, const Box3d& world) {
    using Kind = plan::FormulaNode::Kind;
    const ConvexPart slab{inObject({{0, 1, 0}, rise.top_m}, scope), inObject({{0, -1, 0}, -rise.bottom_m}, scope)};
    std::vector<ConvexContent> contents;
    for (const plan::FormulaNode& node : formula.nodes) {
        ConvexContent& content = contents.emplace_back();
        if (node.kind == Kind::Edge) {
            ConvexPart part = slab;
            for (const HalfSpace& plane : rise.sides[node.first]) part.push_back(inObject(plane, scope));
            if (auto piece = ConvexPolyhedron::of(part, world)) content.add(std::move(*piece), shape);
            continue;
        }
        content = contents[node.first];
        ConvexContent other = contents[node.second];
        if (node.kind == Kind::Max) {
            content.intersect(other);
        } else {
            other.subtract(content);
            content.unite(std::move(other));
        }
        if (content.pieces.size() > mostPieces) return std::nullopt;
    }
    ConvexContent whole = std::move(contents.back());
    mesh::joinConvex(whole.pieces);
    whole.shapes.assign(whole.pieces.size(), shape);
    return whole;
}

/// A pyramid, dome or bell roof; nothing for other rows, or where it takes too many pieces.
std::optional<ConvexContent> roundOverPlan(const derive::SolidValue& solid, const Scope& scope, ShapeId shape,
                                           const Box3d& world, const derive::Footprints& footprints) {
    std::optional<ConvexContent> whole;
    for (const PlanPlanes& planes : roundPlanesOver(solid, scope, footprints)) {
        auto piece = carriedOut(planes.formula, planes.outer, scope, shape, world);
        if (!piece || (whole && whole->pieces.size() + piece->pieces.size() > mostPieces)) return std::nullopt;
        if (whole)
            whole->unite(*std::move(piece));
        else
            whole = std::move(piece);
    }
    return whole;
}

}  // namespace

std::optional<ConvexContent> convexOverPlan(const derive::SolidValue& solid, const Scope& scope, ShapeId shape,
                                            const Box3d& world, const derive::Footprints& footprints) {
    const auto planes = planesOver(solid, scope, footprints);
    if (!planes) return roundOverPlan(solid, scope, shape, world, footprints);
    auto content = carriedOut(planes->formula, planes->outer, scope, shape, world);
    if (!content || !planes->hollow) return content;
    const auto hollow = carriedOut(planes->formula, *planes->hollow, scope, shape, world);
    if (!hollow) return std::nullopt;
    content->subtract(*hollow);
    return content;
}

}  // namespace sgm::lower
