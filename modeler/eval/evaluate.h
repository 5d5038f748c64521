// Running a tape: over points, over boxes, for gradients and for origins.
// Enters: a tape and positions in metres. Leaves: values in the caller's buffers. Assumes one Workspace per thread.
// Promise: for one tape the bits of a value don't depend on batch position, SIMD width or thread.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "modeler/eval/tally.h"
#include "modeler/eval/tape.h"

namespace sgm::eval {

/// The SIMD levels the machine may have; every one gives the same bits.
enum class Isa { Portable, Avx2, Avx512 };
/// The widest level this processor runs, and the shipped build holds.
Isa bestIsa();

/// [lo, hi] with lo ≤ hi; encloses every value the kernels can return inside the region.
struct FloatInterval {
    float lo = 0, hi = 0;
};

/// Scratch memory, reused across calls; one per thread.
class Workspace {
public:
    explicit Workspace(Isa isa = bestIsa());
    ~Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    /// From now on counts operations in `tally`; null, as at first, for none. It must outlive the workspace.
    void tallyInto(Tally* tally);
    struct Impl;
    Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// Floats of the longest vector.
inline constexpr size_t pointPadding = 16;

/// Positions and where the values go: n of each, any n, no alignment needed.
struct Points {
    const float* x;
    const float* y;
    const float* z;
    size_t n;
    bool padded = false;  ///< rows are 64-byte aligned, and numbers up to a multiple of pointPadding: nothing is copied
};

/// out[i] = f(x[i], y[i], z[i]). Where the points are padded, `out` has to be 64-byte aligned, with room up to the same
/// multiple; what is written beyond n means nothing.
void evaluate(const Tape& tape, Points points, float* out, Workspace& workspace);

/// Values and their exact derivatives by x, y, z (at a kink, those of the chosen operand). Rows of padded points as for
/// `evaluate`; those at equal distances, value first, are written at once.
/// With `exact` the derivatives of a shortened tape have the bits of the whole one's (see evaluatePieces).
void evaluateGradient(const Tape& tape, Points points, float* value, float* dx, float* dy, float* dz,
                      Workspace& workspace, bool exact = false);

/// Whose surface each point lies on: walks min, max, blend and morph down the operand they take; ties go to the first.
void evaluateOrigin(const Tape& tape, Points points, OriginId* out, Workspace& workspace);

/// Names the smooth piece of surface that each point lies on: the operand that every minimum and maximum takes, down
/// to the face of a box and the sign of a mirrored coordinate. Values within Tape::tieMargin of each other tie, and a
/// tie goes to the first operand. What a blend joins is one piece with it, also where a field lies alone; a number to
/// which a value is clamped has label 0, and a square forgets what its operand chose. `labels` and `origins` get n
/// entries; origins are those of the operands taken. A shortened tape gives the same names inside its region wherever
/// `relevant` tells its value apart. Costs about two evaluations.
void evaluateLabels(const Tape& tape, Points points, uint32_t* labels, OriginId* origins, Workspace& workspace);

/// Value, derivatives and labels of each point. The derivatives are those of the operands that give the value; where
/// two tie whose derivatives are within 26 degrees of each other, those of the one that the point is named after.
/// Unlike those of evaluateGradient the derivatives of a shortened tape have the same bits as the whole one's, wherever
/// `relevant` tells its value apart.
struct PieceSamples {
    float *value, *dx, *dy, *dz;
    uint32_t* labels;
    OriginId* origins;
};
/// Writes n entries of each row of `out`.
void evaluatePieces(const Tape& tape, Points points, const PieceSamples& out, Workspace& workspace);

/// Up to 64 regions.
struct BoxBatch {
    const Box3f* boxes;
    size_t n;  ///< 1 … 64
};

/// What evaluateRanges found out of a tape: which of its branches can't matter in which region. A value, which
/// `shorten` takes; its memory comes from the workspace that made it and goes back there, so that nothing is allocated
/// in steady state. One thread's, as that is.
class RangeTrace {
public:
    struct Impl;
    struct Pool;
    explicit RangeTrace(std::shared_ptr<Pool> pool);
    ~RangeTrace();
    RangeTrace(RangeTrace&&) noexcept;
    RangeTrace& operator=(RangeTrace&&) noexcept;
    Impl& impl() const { return *impl_; }

private:
    std::shared_ptr<Pool> pool_;
    std::unique_ptr<Impl> impl_;
};

/// out[i] encloses f over boxes[i]; gives the choices for `shorten`. The instructions `free`, by number, ascending,
/// count as any number whatever they read.
RangeTrace evaluateRanges(const Tape& tape, BoxBatch regions, FloatInterval* out, Workspace& workspace,
                          std::span<const uint32_t> free = {});

/// The tape with everything dropped that can't matter in region `index` of a trace, which must be of this very tape.
/// Inside the region it returns the same bits as `tape` wherever those lie in what `relevant` tells apart, with the
/// same owners and derivatives up to rounding; elsewhere some number on the same side.
Tape shorten(const Tape& tape, const RangeTrace& trace, size_t index, Workspace& workspace,
             RelevantRange relevant = {});
/// The same in the memory of another tape than `tape`: nothing is allocated in steady state.
void shorten(const Tape& tape, const RangeTrace& trace, size_t index, Workspace& workspace, Tape& into,
             RelevantRange relevant = {});

}  // namespace sgm::eval
