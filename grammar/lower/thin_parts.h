// Parts thinner than a cell, and how much of them a mesh lacks.
// Enters: a derivation, its model and a mesh of it. Leaves: the thin parts that miss surface. Assumes a mesh with
// origins whose triangles are no larger than a cell: before it is simplified, and before separate solids are dropped.
#pragma once

#include "grammar/lower/lower.h"
#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::lower {

/// A part that is too thin for the cells, or whose walls or shell are; a thin wall beside a cut, a narrow gap at a face
/// of a part, a roof's eaves, or what stands out of others of a thick part, its rim: the mesh shows none of it in
/// places.
struct ThinPart {
    enum class Kind : uint8_t { Part, Wall, Gap, Eaves, Rim };
    Kind kind = Kind::Part;
    OriginId part = 0;  ///< or the cut
    int face = -1;      ///< of its scope, where the wall or gap is: 2 · axis + (high side); −1: anywhere
    /// The least extent of the part's scope, or of its walls or shell; of the wall or gap; of a rim about the width of
    /// the narrowest strip that the mesh shows.
    double thickness_m = 0;
    double cell_m = 0;  ///< cells no larger than this hold it
    /// Share of the part's surface without a triangle within half a cell, or of a plate's area; of lines across the
    /// wall or gap with neither of its surfaces. 0 where that is too little to be told, but worth halved cells.
    double missing = 0;
    std::vector<derive::Scope> places;  ///< where it is, of walls from both of their sides
    bool isShell = false;               ///< of a part: its walls are what is thin
    int halvings = 0;                   ///< cells around it may be halved so often
    size_t mostTriangles = 0;           ///< that the mesh may come to have by that, or four times those that it has
    bool isBounded = false;             ///< cells there would be halved more often if that took fewer triangles

    /// Whether its places were found along lines across it.
    bool isWall() const { return isShell || kind == Kind::Wall; }
};

/// Looks at the parts whose scope is somewhere thinner than a cell: on lines through the scope along its thin axes,
/// where does the field's surface belong to the part, and has the mesh a triangle of the part there? Of a plate
/// that stands free, and of a thin box's faces that are mostly free, does the mesh cover them? Likewise
/// at thin walls and narrow gaps at the faces of boxes
/// (`findThinSections`): those that lack more than a twenty-fifth, or of sections a tenth; and at the walls of shells
/// and beside other cuts
/// (`findMissingWalls`); a part that lacks of both is there once, with its walls. Ascending by part. What else is thin
/// within a thicker scope, as a needle's point or a fractal's ornament, isn't looked for. Empty for a mesh without
/// origins. Only those `among` others are looked at, where that isn't null. About 4,000 evaluations of a shortened tape
/// a thin part, 300 to 30,000 another, O(n log n); `threads` 0: all. Error::Cancelled.
Result<std::vector<ThinPart>> findMissingParts(const derive::Derivation& derivation, const Model& model,
                                               const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m,
                                               int threads, Progress* progress,
                                               const std::vector<ThinPart>* among = nullptr);

/// Of round parts, neither boxes nor over a plan, whose scope is somewhere thinner than two cells, and of bars and
/// turned plates, as walls with openings, thinner than one: those whose surface the mesh has, but over a twelfth of
/// their thickness away in more than a twenty-fifth of the places where findMissingParts looks, or a fiftieth of those
/// `among` others that are bounded; and those that it lacks. Else as that.
Result<std::vector<ThinPart>> findTornParts(const derive::Derivation& derivation, const Model& model,
                                            const eval::Tape& tape, const mesh::Mesh& mesh, float cell_m, int threads,
                                            Progress* progress, const std::vector<ThinPart>* among = nullptr);

}  // namespace sgm::lower
