// Walls between two cuts, and gaps between two parts, that are thinner than a mesh's cells though no part is.
// Enters: a derivation and its model. Leaves: where they are. Assumes nothing of a mesh.
#pragma once

#include <array>
#include <vector>

#include "grammar/lower/thin_parts.h"
#include "modeler/core/progress.h"
#include "modeler/eval/tape.h"

namespace sgm::lower {

/// A face of a cut beside which the solid is thin, or of another part beside which the air is.
struct ThinSection {
    /// A point of the surface, and whose it is.
    struct Crossing {
        Vec3f at;
        OriginId owner = 0;
    };
    /// Across the wall or gap, from the face's own surface to the next one.
    struct Line {
        std::array<Crossing, 2> ends;
        double thickness_m = 0;
    };
    bool isGap = false;
    OriginId part = 0;
    int face = 0;          ///< of its scope: 2 · axis + (high side)
    derive::Scope scope;   ///< of the part
    double spacing_m = 0;  ///< of the lines, at most
    std::vector<Line> lines;
};

/// Looks beyond the faces of parts that have flat ones, on lines a cell of `cell_m` metres apart (at most 576 a face,
/// and more where it shows in places only; all are followed where one of 96 finds any), for surface that is less than
/// one and a half cells away. Of all these parts, or of the faces `among` thin parts where that isn't null. In order of
/// part and face. 20 to 12,000 evaluations of a shortened tape a face, O(n log n); `threads` 0: all. Error::Cancelled.
Result<std::vector<ThinSection>> findThinSections(const derive::Derivation& derivation, const Model& model,
                                                  const eval::Tape& tape, float cell_m, int threads, Progress* progress,
                                                  const std::vector<ThinPart>* among = nullptr);

}  // namespace sgm::lower
