// Keeps a recording in step with a derivation: where its pieces begin and end, and running one of them again.
// Enters: pieces of work. Leaves: their places in the lists. Assumes one thread.
#pragma once

#include "grammar/derive/monitor.h"
#include "grammar/derive/recording.h"

namespace sgm::derive {

class Recorder {
public:
    Recorder(const Derivation& derivation, Monitor& monitor) : derivation_(derivation), monitor_(monitor) {}

    /// From now on notes all that another run with other numbers has to know; null for nobody.
    void record(Recording* recording) { recording_ = recording; }
    Recording* recording() const { return recording_; }
    bool isReplaying() const { return recording_ && recording_->isReplaying(); }
    /// Begins a piece of the recording, if there is one; the last one ends.
    void beginPiece(Piece piece);
    void endPiece();
    /// Where the lists end.
    Piece::Place end() const;
    /// Runs a piece again with numbers that changed: what it makes goes where it is already. False when it takes
    /// another course; then the derivation is of no use any more.
    template <class Run>
    bool replay(size_t piece, Run&& run) {
        Piece& p = recording_->enter(piece);
        monitor_.takeBack(p.work);
        const uint64_t before = monitor_.turns();
        const bool same = run(p) && !monitor_.failed() && recording_->complete();
        p.work = monitor_.turns() - before;
        return same && !monitor_.failed();
    }

private:
    const Derivation& derivation_;
    Monitor& monitor_;
    Recording* recording_ = nullptr;
    uint64_t pieceBegan_ = 0;  ///< turns of work when the piece began
};

}  // namespace sgm::derive
