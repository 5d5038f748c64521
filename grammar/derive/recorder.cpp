#include "grammar/derive/recorder.h"

namespace sgm::derive {

void Recorder::beginPiece(Piece piece) {
    if (!recording_) return;
    endPiece();
    piece.from = end();
    recording_->begin(piece);
}

void Recorder::endPiece() {
    if (!recording_->pieces().empty()) recording_->now().work = monitor_.turns() - pieceBegan_;
    pieceBegan_ = monitor_.turns();
}

Piece::Place Recorder::end() const {
    const ShapeTree& t = derivation_.tree;
    return {t.shapes.size(), t.solids.size(), t.extras.size(), t.mates.size(), derivation_.steps.size(), 0};
}

}  // namespace sgm::derive
