// One evaluated solid to convex polyhedra.
// Enters: a SolidValue and the scope it fills. Leaves: polyhedra in the object's frame. Assumes checked values.
#pragma once

#include <span>
#include <vector>

#include "grammar/derive/shape_tree.h"
#include "modeler/mesh/convex_polyhedron.h"

namespace sgm::lower {

/// With more than these a content grows no further, and nobody wants its pieces.
inline constexpr size_t mostConvexPieces = 20'000;

/// What a shape tree's node holds so far, as a union.
struct ConvexContent {
    std::vector<mesh::ConvexPolyhedron> pieces;
    std::vector<derive::ShapeId> shapes;  ///< by piece: whose solid it is a part of
    bool unknown = false;                 ///< something that has no convex parts is missing

    bool empty() const { return pieces.empty() && !unknown; }
    void add(mesh::ConvexPolyhedron piece, derive::ShapeId shape);
    void unite(ConvexContent&& other);
    /// Takes away what `other` holds, splitting pieces around it.
    void subtract(const ConvexContent& other);
    void intersect(const ConvexContent& other);
};

/// The solid as a union of convex polyhedra, cut to `world`; coarse for one that is cut away.
ConvexContent convexSolid(const derive::SolidValue& solid, const derive::Scope& scope, derive::ShapeId shape,
                          const Box3d& world, const derive::Footprints& footprints,
                          std::span<const field::SampledGridPtr> meshes, field::convex::Roundness roundness);

}  // namespace sgm::lower
