// Space cut into cells, each with the field's tape shortened for it: what lets a ray, a shadow or an occlusion probe
// pay only for the parts nearby. Cells belong to space and not to the screen, so shadows use the same ones as the
// picture. Enters: a tape and bounds. Leaves: a tree of 4 × 4 × 4 cells a node and the leaves' tapes. Assumes finite
// bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/tape.h"

namespace sgm::render {

/// What is known of a cell. The two top bits of a node's word hold it; the rest is a leaf's or node's index.
enum class CellState : uint32_t {
    Outside = 0,  ///< f > margin throughout
    Near = 1,     ///< has a tape
    Inside = 2,   ///< f < −margin throughout
    Node = 3,     ///< is cut further
};

/// Where a field may be small, or 0, with no surface near: inside a union of cutters, which are parts of the space
/// around the solid, where faces of two solids of an intersection touch, where a cutter is flush with its host; and
/// from inside a solid, where its parts meet. Bits.
enum SmallValues : uint8_t {
    DoubtfulOutside = 1,  ///< for rays around the solid
    DoubtfulInside = 2,   ///< for rays within it
};
/// What a tape's operators allow: a choice between parts, that is, between operands that belong to somebody. Linear in
/// the tape.
uint8_t doubtsOf(const eval::Tape& tape);

/// The tree; node n's 64 words start at nodes[64·n], in the order x + 4y + 16z.
struct CellTree {
    static constexpr int depth = 3;         ///< usually at most 64 cells along an edge of the root,
    static constexpr int surfaceDepth = 4;  ///< 256 where there may be surface among many parts
    Vec3f low;                              ///< the root cube's corner, metres
    float edge = 1;                         ///< of the root cube, metres
    float margin = 0;                       ///< metres
    std::vector<uint32_t> nodes;
    std::vector<eval::Tape> tapes;  ///< of near leaves; each is exact a 32nd of its cell's edge beyond the cell
    std::vector<eval::FloatInterval> ranges;  ///< of the field in the same leaves
    std::vector<uint8_t> doubts;              ///< of the same leaves, see SmallValues

    static constexpr CellState stateOf(uint32_t word) { return CellState(word >> 30); }
    static constexpr uint32_t indexOf(uint32_t word) { return word & 0x3fffffffu; }
    /// The word of the leaf that holds p; positions outside the root cube count as its nearest leaf.
    uint32_t find(Vec3f p) const;
};

/// Cuts `bounds` into cells, at most `levels` deep: fewer are cut sooner and cost rays more. Error::Cancelled when
/// `progress` says so.
Result<CellTree> cutIntoCells(const eval::Tape& tape, const Box3f& bounds, float margin, int threads,
                              Progress* progress, int levels = CellTree::surfaceDepth);

}  // namespace sgm::render
