#include "grammar/lower/convex_solids.h"

#include <algorithm>
#include <cmath>

#include "grammar/lower/convex_plans.h"
#include "grammar/lower/solids.h"
#include "modeler/core/conventions.h"
#include "modeler/eval/evaluate.h"

namespace sgm::lower {
namespace {

using derive::Scope;
using derive::SolidValue;
using field::ConvexPart;
using field::convex::Roundness;
using mesh::ConvexPolyhedron;
using rules::Operator;

/// From the scope's frame to the object's.
ConvexPart placed(ConvexPart part, const Scope& scope) {
    for (field::HalfSpace& plane : part) {
        plane.normal = scope.axes * plane.normal;
        plane.offset += dot(plane.normal, scope.centre);
    }
    return part;
}

ConvexPart planesOf(const ConvexPolyhedron& polyhedron) {
    ConvexPart part;
    for (const auto& face : polyhedron.faces()) part.push_back(face.plane);
    return part;
}

std::vector<double> argumentsOf(const SolidValue& solid) {
    std::vector<double> arguments;
    for (size_t i = 0; i < solid.args.size(); ++i) {
        const field::PrimitiveParameter& p = solid.primitive->parameters[i];
        arguments.push_back(std::clamp(solid.args[i].n[0], p.lo, p.hi));
    }
    return arguments;
}

/// Points on the surface along rays from the scope's centre, with normals.
class SurfaceProbe {
public:
    SurfaceProbe(const eval::Tape& tape, const Scope& scope) : tape_(tape), scope_(scope) {
        constexpr int count = 160;
        const double golden = pi * (3 - std::sqrt(5.0));
        for (int i = 0; i < count; ++i) {
            const double y = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - y * y);
            rays_.push_back(scope.axes * (Vec3d{r * std::cos(golden * i), y, r * std::sin(golden * i)} * scope.half()));
        }
        lo_.assign(rays_.size(), 0), hi_.assign(rays_.size(), std::sqrt(3.0));
        for (auto* row : {&x_, &y_, &z_, &value_, &dx_, &dy_, &dz_}) row->resize(rays_.size());
    }

    /// Half-spaces that touch the solid; none where the centre is outside.
    ConvexPart tangents() {
        put(lo_);
        eval::evaluate(tape_, {x_.data(), y_.data(), z_.data(), 1}, value_.data(), workspace_);
        if (!(value_[0] < 0)) return {};
        for (int step = 0; step < 24; ++step) {
            std::vector<double> middle;
            for (size_t i = 0; i < rays_.size(); ++i) middle.push_back((lo_[i] + hi_[i]) / 2);
            put(middle);
            eval::evaluate(tape_, {x_.data(), y_.data(), z_.data(), rays_.size()}, value_.data(), workspace_);
            for (size_t i = 0; i < rays_.size(); ++i) (value_[i] < 0 ? lo_ : hi_)[i] = middle[i];
        }
        put(lo_);
        eval::evaluateGradient(tape_, {x_.data(), y_.data(), z_.data(), rays_.size()}, value_.data(), dx_.data(),
                               dy_.data(), dz_.data(), workspace_);
        ConvexPart part;
        for (size_t i = 0; i < rays_.size(); ++i) {
            const Vec3d normal = normalized(Vec3d{dx_[i], dy_[i], dz_[i]});
            if (length(normal) > 0.5) addOnce(part, {normal, dot(normal, at(i, lo_))});
        }
        return part;
    }

private:
    Vec3d at(size_t ray, const std::vector<double>& share) const { return scope_.centre + rays_[ray] * share[ray]; }
    void put(const std::vector<double>& share) {
        for (size_t i = 0; i < rays_.size(); ++i) {
            const Vec3f p = at(i, share).as<float>();
            x_[i] = p.x, y_[i] = p.y, z_[i] = p.z;
        }
    }
    static void addOnce(ConvexPart& part, const field::HalfSpace& plane) {
        for (const field::HalfSpace& known : part)
            if (dot(known.normal, plane.normal) > 1 - 1e-5) return;
        part.push_back(plane);
    }

    const eval::Tape& tape_;
    const Scope& scope_;
    eval::Workspace workspace_;
    std::vector<Vec3d> rays_;
    std::vector<double> lo_, hi_;  ///< by ray: in shares of it, inside and outside
    std::vector<float> x_, y_, z_, value_, dx_, dy_, dz_;
};

/// A solid whose field is a convex function, by planes that touch it.
ConvexPart touching(const SolidValue& solid, const Scope& scope, std::span<const field::SampledGridPtr> meshes) {
    field::Graph graph;
    const derive::Footprints none;
    SharedPlans plans(none);
    const field::Field f = lowerSolid(graph, solid, scope, 1, 1, plans, meshes);
    const eval::Tape tape = eval::compile(graph, f, graph.constants());
    ConvexPart part = SurfaceProbe(tape, scope).tangents();
    if (part.empty()) return {};
    for (const field::HalfSpace& side : placed(field::convex::cube(scope.half(), {}, Roundness::Fine)[0], scope))
        part.push_back(side);
    return part;
}

/// Whether its field is a convex function: a mix of such functions is one, too.
bool isConvex(const SolidValue& solid) {
    if (solid.kind == rules::Solid::Kind::Primitive)
        return solid.primitive->morphs ||
               (solid.primitive->bounded && solid.primitive->convexParts &&
                solid.primitive->convexParts({1, 1, 1}, argumentsOf(solid), Roundness::Coarse).size() == 1);
    return solid.kind == rules::Solid::Kind::Morph && isConvex(solid.parts[0]) && isConvex(solid.parts[1]);
}

}  // namespace

void ConvexContent::add(ConvexPolyhedron piece, derive::ShapeId shape) {
    pieces.push_back(std::move(piece));
    shapes.push_back(shape);
}

/// Moves the pieces of the shorter list, for a chain passes its whole rest up link by link.
void ConvexContent::unite(ConvexContent&& other) {
    unknown |= other.unknown;
    const bool shorter = pieces.size() < other.pieces.size();
    if (shorter) pieces.swap(other.pieces), shapes.swap(other.shapes);
    const auto at = shorter ? pieces.begin() : pieces.end();
    const auto shapeAt = shorter ? shapes.begin() : shapes.end();
    pieces.insert(at, std::make_move_iterator(other.pieces.begin()), std::make_move_iterator(other.pieces.end()));
    shapes.insert(shapeAt, other.shapes.begin(), other.shapes.end());
}

void ConvexContent::subtract(const ConvexContent& other) {
    for (const ConvexPolyhedron& cut : other.pieces) {
        if (pieces.size() > mostConvexPieces) return;
        const ConvexPart part = planesOf(cut);
        ConvexContent left;
        left.unknown = unknown;
        for (size_t i = 0; i < pieces.size(); ++i) {
            if (intersection(pieces[i].bounds(), cut.bounds()).empty()) {
                left.add(std::move(pieces[i]), shapes[i]);
                continue;
            }
            for (ConvexPolyhedron& piece : mesh::subtracted(pieces[i], part)) left.add(std::move(piece), shapes[i]);
        }
        *this = std::move(left);
    }
}

void ConvexContent::intersect(const ConvexContent& other) {
    ConvexContent shared;
    shared.unknown = unknown;
    for (const ConvexPolyhedron& with : other.pieces)
        for (size_t i = 0; i < pieces.size(); ++i) {
            std::optional<ConvexPolyhedron> both = pieces[i];
            for (const auto& face : with.faces())
                if (both) both = both->clipped(face.plane);
            if (both) shared.add(std::move(*both), shapes[i]);
        }
    *this = std::move(shared);
}

/// Recursion follows the solid's text, which nests a few levels at most.
ConvexContent convexSolid(const SolidValue& solid, const Scope& scope, derive::ShapeId shape, const Box3d& world,
                          const derive::Footprints& footprints, std::span<const field::SampledGridPtr> meshes,
                          Roundness roundness) {
    ConvexContent content;
    const auto addPart = [&](const ConvexPart& part) {
        if (auto piece = ConvexPolyhedron::of(part, world)) content.add(std::move(*piece), shape);
    };
    if (solid.kind == rules::Solid::Kind::Nil) return content;
    if (solid.kind == rules::Solid::Kind::Combination) {
        content = convexSolid(solid.parts[0], scope, shape, world, footprints, meshes, roundness);
        for (size_t i = 1; i < solid.parts.size(); ++i) {
            const bool cuts = solid.op == Operator::Difference;
            ConvexContent part = convexSolid(solid.parts[i], scope, shape, world, footprints, meshes,
                                             cuts ? Roundness::Coarse : roundness);
            content.unknown |= part.unknown;
            if (cuts)
                content.subtract(part);
            else if (solid.op != Operator::Intersection)
                content.unite(std::move(part));
            else if (!part.unknown)
                content.intersect(part);
        }
        return content;
    }
    if (solid.kind == rules::Solid::Kind::Morph && (solid.amount <= 0 || solid.amount >= 1))
        return convexSolid(solid.parts[solid.amount >= 1 ? 1 : 0], scope, shape, world, footprints, meshes, roundness);
    // Rows that have parts of their own, a block's, need no plan where the scope has none: it is its rectangle.
    const bool overPlan = solid.primitive && solid.primitive->plan != field::PlanUse::None &&
                          (scope.footprint != derive::none || !solid.primitive->convexParts);
    if (overPlan) {
        if (auto standing = convexOverPlan(solid, scope, shape, world, footprints)) return *std::move(standing);
        content.unknown = true;
        return content;
    }
    if (solid.kind == rules::Solid::Kind::Primitive && solid.primitive->convexParts) {
        for (const ConvexPart& part : solid.primitive->convexParts(scope.half(), argumentsOf(solid), roundness))
            addPart(placed(part, scope));
        return content;
    }
    const ConvexPart part = isConvex(solid) ? touching(solid, scope, meshes) : ConvexPart{};
    content.unknown = part.empty();
    if (!part.empty()) addPart(part);
    return content;
}

}  // namespace sgm::lower
