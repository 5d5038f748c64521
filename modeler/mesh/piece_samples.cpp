#include "modeler/mesh/piece_samples.h"

namespace sgm::mesh {

void PieceSamples::add(const BlockTapes& tapes, size_t brick, Vec3f p) {
    x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    const eval::Tape* tape = tapes.whole;
    if (brick < tapes.bricks.size() && tapes.bricks[brick].tape && tapes.bricks[brick].box.contains(p))
        tape = tapes.bricks[brick].tape;
    tapes_.push_back(tape);
}

void PieceSamples::evaluate(eval::Workspace& workspace) {
    const size_t n = size();
    rows_.resize(4 * n), labels_.resize(n), origins_.resize(n);
    float* const rows = rows_.data();
    for (size_t begin = 0, end; begin < n; begin = end) {
        for (end = begin + 1; end < n && tapes_[end] == tapes_[begin];) ++end;
        eval::evaluatePieces(*tapes_[begin], {&x_[begin], &y_[begin], &z_[begin], end - begin},
                             {rows + begin, rows + n + begin, rows + 2 * n + begin, rows + 3 * n + begin,
                              &labels_[begin], &origins_[begin]},
                             workspace);
    }
}

PiecePoint PieceSamples::point(size_t i, float& value) const {
    const size_t n = size();
    value = rows_[i];
    return {{x_[i], y_[i], z_[i]},
            {rows_[n + i], rows_[2 * n + i], rows_[3 * n + i]},
            labelOf(labels_[i], origins_[i]),
            origins_[i]};
}

}  // namespace sgm::mesh
