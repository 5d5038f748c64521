// Meshing again and again while parameters change: what the change doesn't reach is kept.
// Enters: the tape of the moment, and a grid. Leaves: the mesh that `subdivide` and `polygonize` would give, byte for
// byte. Assumes one caller at a time. A region of the descent is told by its tape, shortened to it: where that is the
// same as the last time, so is all that would be found below, and neither the descent nor the sampling goes there
// again. Where only numbers changed, not even the tape is asked: only the parts that read them, whether they come near.
// For a single mesh call `subdivide` and `polygonize`.
#pragma once

#include <unordered_map>

#include "modeler/eval/changed_parts.h"
#include "modeler/eval/fingerprint.h"
#include "modeler/mesh/polygonize.h"

namespace sgm::mesh {

class Rebuild {
public:
    explicit Rebuild(PolygonizeOptions options = {}) : options_(options) {}

    /// The mesh of `tape` on `grid`, valid until the next call. Nothing is kept when the grid is another one than in
    /// the last call (see `gridToKeep`), when the field's Lipschitz constant doubled, nor after an error. Errors as of
    /// subdivide and polygonize; the memory budget counts what is made anew.
    /// `changed` tells which numbers are new when the code is that of the last call's tape, and spares what asking the
    /// whole tape costs.
    Result<const Mesh*> update(const eval::Tape& tape, const Grid& grid, Progress* progress, Counts& counts,
                               const eval::NumbersChanged* changed = nullptr);

    /// Blocks of the last mesh that were meshed anew.
    size_t blocksMade() const { return blocksMade_; }
    /// Blocks of the last mesh that were kept from the one before, with those found to hold no surface.
    size_t blocksKept() const { return blocksKept_; }

private:
    /// A cube of 4^level blocks along an edge, by its number in the grid of such cubes.
    struct Region {
        int level;
        Vec3i index;
        friend bool operator==(const Region&, const Region&) = default;
    };
    struct RegionHash {
        size_t operator()(const Region& r) const;
    };
    using Regions = std::unordered_map<Region, eval::Fingerprint, RegionHash>;

    /// The tape as it is in a box, whatever numbers come to be at these places of its constants.
    struct Near {
        Box3f box;
        std::vector<uint32_t> places;  ///< ascending
        eval::Tape tape;
    };

    Result<const Mesh*> run(const eval::Tape& tape, const Grid& grid, Progress* progress, Counts& counts,
                            const eval::NumbersChanged* changed);
    const Mesh* keepAll();
    void forget();
    bool leaveUnreached(const eval::Tape& tape, const Grid& grid, Regions& same, Box3f& reached);
    const eval::Tape& tapeAround(const Box3f& reached, const eval::Tape& tape, const Grid& grid,
                                 const eval::NumbersChanged& changed);
    static void keepBelow(const Regions& before, const Regions& same, Regions& now);
    std::vector<Chunk> takeKept(const Regions& now, const std::vector<Block>& made);

    PolygonizeOptions options_;
    Grid grid_;
    eval::RelevantRange relevant_;
    float tieMargin_ = 0;
    eval::Fingerprint tape_;                             ///< of the last tape, where it was asked for
    std::shared_ptr<const std::vector<float>> numbers_;  ///< the last tape's constants
    Regions regions_;                                    ///< all that may hold surface, blocks (level 0) and above
    Mesh mesh_;
    eval::ChangedParts parts_;
    Near near_;  ///< of the last change of numbers
    std::vector<eval::Workspace> scratch_;
    size_t blocksMade_ = 0, blocksKept_ = 0;
};

/// A grid for `bounds` and those that come after: `previous` while the bounds lie in it with a cell of outside around
/// and its cells have that size, else a new one with `room` of the bounds' size to grow on every side. The mesh of a
/// sequence stays on one lattice so.
Grid gridToKeep(const Grid& previous, const Box3f& bounds, float cell_m, float room = 0.1f);

}  // namespace sgm::mesh
