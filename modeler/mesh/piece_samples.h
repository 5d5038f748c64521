// Points of a block at which its field is looked at piece by piece.
// Enters: points, each in a brick of the block. Leaves: values, derivatives and labels. Assumes the tapes of bricks are
// shortened from the block's, so that which tape is taken changes no bit near the surface.
#pragma once

#include <span>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/subdivide.h"

namespace sgm::mesh {

/// The label of a part's piece, from that of evaluateLabels: pieces of two parts differ.
constexpr uint32_t labelOf(uint32_t piece, OriginId origin) {
    const uint32_t h = (piece ^ origin * 0x9e3779b1u) * 0x85ebca6bu;
    return h ^ (h >> 15);
}

/// A point of the surface, the piece that it lies on and the field's derivative there.
struct PiecePoint {
    Vec3f at;        ///< metres
    Vec3f gradient;  ///< of the piece's own field
    uint32_t label = 0;
    OriginId origin = 0;
};

/// The tape that is good for a brick.
struct BrickTape {
    const eval::Tape* tape = nullptr;  ///< null: the block's
    Box3f box;                         ///< metres
};

/// A block's tape and those of its bricks, by number; maybe none.
struct BlockTapes {
    const eval::Tape* whole = nullptr;
    std::span<const BrickTape> bricks;
};

/// Points and what the field is there.
class PieceSamples {
public:
    size_t size() const { return x_.size(); }
    void clear() { x_.clear(), y_.clear(), z_.clear(), tapes_.clear(); }
    /// Adds a point. The brick's tape is taken where the point lies in the brick, else the block's.
    void add(const BlockTapes& tapes, size_t brick, Vec3f p);
    /// Evaluates all points; consecutive ones of one tape at once.
    void evaluate(eval::Workspace& workspace);
    /// The i-th point and the field's value there.
    PiecePoint point(size_t i, float& value) const;

private:
    std::vector<float> x_, y_, z_, rows_;
    std::vector<const eval::Tape*> tapes_;
    std::vector<uint32_t> labels_;
    std::vector<OriginId> origins_;
};

}  // namespace sgm::mesh
