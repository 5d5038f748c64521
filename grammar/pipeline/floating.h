// Which solids of a mesh float, and which shape each of them began with.
// Enters: a model and its mesh. Leaves: the floating pieces, named, and sentences about them. Assumes the mesh carries
// its origins.
#pragma once

#include <string>
#include <vector>

#include "grammar/pipeline/meshing.h"
#include "modeler/mesh/connected_components.h"

namespace sgm::pipeline {

/// Why a piece hangs alone, as findCauses tells (gaps.h).
struct FloatCause {
    enum class Kind {
        Unknown,
        Gap,       ///< nothing reaches it
        Touch,     ///< the field joins both, by less than the mesh shows
        Thin,      ///< a part that the mesh lacks holds it
        Fragment,  ///< it is a piece of a thin wall, of a shell or beside a cut
    };
    Kind kind = Kind::Unknown;
    double width_m = 0;   ///< of the gap in the mesh; of the thin part or wall
    double cell_m = 0;    ///< Thin, Fragment: cells no larger than this show it
    Vec3d at;             ///< Gap, Touch: between the nearest points
    OriginId ours = 0;    ///< Gap, Touch: the part of the piece that is nearest
    OriginId theirs = 0;  ///< Gap, Touch: the nearest part of anything else. Else the thin part, or the cut
    double whole_m = 0;   ///< cell_m before these are halved
};

struct Floating {
    mesh::ConnectedComponent piece;
    derive::ShapeId shape = 0;  ///< where the piece begins in the shape tree
    FloatCause cause;
    bool besideMissing = false;  ///< what the mesh lacks reaches from it to elsewhere, and may hold it
};
struct Support {
    uint64_t pieces = 0;             ///< separate solids
    std::vector<Floating> floating;  ///< the largest first
};
Support supportOf(const Model& model, const mesh::Mesh& mesh, float cell_m);

/// A sentence about a model's mesh, at the line of the grammar that made what it is about.
struct MeshWarning {
    syntax::SourceSpan span;  ///< of the shape; without a source where none is known
    std::string place;        ///< "file:line: ", where the text doesn't say it
    std::string text;         ///< names the shape and figures
    bool ofCells = false;     ///< smaller cells show what is missing, or what holds the piece
};
/// A warning for the floating pieces of each line of the grammar in a mesh of such cells, with the largest and how many
/// more there are; those of most volume first, and the first few of many.
std::vector<MeshWarning> floatingWarnings(const Model& model, const Support& support, float cell_m);

}  // namespace sgm::pipeline
