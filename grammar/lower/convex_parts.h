// Shape tree to convex polyhedra: colliders made from the terminals.
// Enters: a Derivation and its Model. Leaves: polyhedra that together fill what the solids of the tree do. Assumes that
// the model was lowered from that derivation.
#pragma once

#include <string>
#include <vector>

#include "grammar/lower/lower.h"
#include "modeler/mesh/convex_polyhedron.h"

namespace sgm::lower {

/// A convex polyhedron and the shape whose solid it is a part of.
struct ConvexPiece {
    mesh::ConvexPolyhedron polyhedron;
    derive::ShapeId shape;
};

struct ConvexParts {
    std::vector<ConvexPiece> pieces;  ///< in tree order; those of one shape touch, those of several may overlap
    /// Where the pieces aren't what the field is: one located line a kind of difference, with how often it occurs.
    std::vector<std::string> notes;
};

/// The union of the tree's solids, with its booleans carried out on polyhedra: a cut splits what it reaches into pieces
/// around it, so holes stay open. Boxes, pyramids, prisms, wedges, half-spaces, blocks over footprints and their hip
/// and gable roofs are exact, round solids have 12 sides or 54 faces and the same volume to 1 %, round cuts 8 or 22;
/// roofs between their ends and morphs of solids are bounded by planes that touch them. Blends count as sharp, noise
/// and cladding don't count; fractals and meshes from files are left out, as parts and as cuts. `notes` says so. Pieces
/// that another one holds are left out, and so is what is thinner than a millimetre. Error::Budget beyond 20,000
/// pieces, Error::Input where no piece is left or some follow hills, Error::Cancelled.
Result<ConvexParts> convexParts(const derive::Derivation& derivation, const Model& model, Progress* progress);

/// The pieces as boxes along the axes of their shapes. What isn't a box becomes up to eight side by side, each of the
/// volume that it stands for and flush with it where that covers most of it. O(pieces).
std::vector<mesh::ConvexPolyhedron> boxesOf(const derive::Derivation& derivation, const ConvexParts& parts);

}  // namespace sgm::lower
