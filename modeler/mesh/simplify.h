// As few triangles as the shape needs, to a tolerance in metres.
// Enters: a mesh whose triangles name part and smooth piece. Leaves: a mesh of one chunk with the same parts, pieces
// and normals. Assumes a closed, oriented 2-manifold that doesn't cross itself.
#pragma once

#include <memory>
#include <unordered_map>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/tape.h"
#include "modeler/mesh/mesh.h"

namespace sgm::mesh {

/// What simplification made of a mesh's components, for the next mesh that has some of the same: a frame of an
/// animation. Not for two calls at once.
class SimplifiedPieces {
public:
    /// What was made of such a piece in the call before, or null.
    std::shared_ptr<const Mesh> find(const Mesh& piece) const;
    /// Begins a call that simplifies to `tolerance_m`, with planes to `rounding_m`: what was made otherwise goes.
    void begin(double tolerance_m, double rounding_m);
    /// All pieces of a call, and what was made of them.
    void keep(std::vector<Mesh> from, std::vector<std::shared_ptr<const Mesh>> to);

private:
    struct Piece {
        Mesh from;
        std::shared_ptr<const Mesh> to;
    };
    std::unordered_multimap<uint64_t, Piece> pieces_;
    double tolerance_m_ = 0, rounding_m_ = 0;
};

struct SimplifyOptions {
    /// How far the surface, its creases and the borders of its parts may move, in metres; ≥ 0. With 0 nothing goes but
    /// what is planar or straight within rounding: 2⁻²⁰ of the largest coordinate.
    double tolerance_m = 0;
    int threads = 1;                     ///< 0: all the machine has; the result is the same for any number
    SimplifiedPieces* pieces = nullptr;  ///< of the call before; the result is the same with it and without
    const eval::Tape* field = nullptr;   ///< the mesh's own; where it is given, curved edges are split (curved_edges.h)
};

/// What a crisp mesh of such cells is simplified to unless the user says otherwise, metres: a hundredth of a cell.
inline double usualTolerance(float cell_m) { return 0.01 * static_cast<double>(cell_m); }

/// Moves confined vertices to their creases first, then merges what is planar and decimates what is curved. A region is
/// a connected set of triangles of one origin and label; one that is planar but for a few bumps is divided. Points on a
/// border of regions that aren't needed within the tolerance go, once for both sides; planar regions are triangulated
/// anew from their borders. Components that are apart from one another (apart.h) are simplified each by itself. The
/// result is closed, oriented, a 2-manifold and crosses itself nowhere. Where that takes vertices of more than an
/// eighth of the triangles within a tolerance as large as they are, quarters of it are tried for the fewest triangles.
/// O(n) in the triangles of planar regions.
/// Error::Usage for a negative tolerance, Error::Input for a mesh that isn't closed, Error::Budget for 2³¹ triangles,
/// Error::Cancelled.
Result<Mesh> simplify(const Mesh& mesh, const SimplifyOptions& options, Progress* progress);

/// As `simplify`, with about the least tolerance (within an eighth) that leaves at most `share` of the triangles, in
/// (0, 1]; with the fewest triangles found where none does. Takes about ten times as long. Error::Usage for another
/// share.
Result<Mesh> simplifyToShare(const Mesh& mesh, double share, int threads, Progress* progress);

}  // namespace sgm::mesh
