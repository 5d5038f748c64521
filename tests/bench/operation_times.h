// What an operation costs at least: from register to register, in the widest vectors, measured on the spot.
// Enters: operations that tapes ran, with their points. Leaves: the time that those take alone, without an interpreter,
// loads and stores. Assumes nothing else runs; the best of a few tries counts.
#pragma once

#include "modeler/eval/tally.h"

namespace sgm::bench {

/// Seconds of one thread for all operations of a tally.
double leastSeconds(const eval::Tally& tally);

/// Seconds of a steady clock.
double secondsNow();

/// The measuring loops, compiled once for each instruction set (CMakeLists.txt): seconds a point of one operation.
namespace portable {
double secondsPerPoint(const eval::Operation& operation);
}
namespace avx2 {
double secondsPerPoint(const eval::Operation& operation);
}
namespace avx512 {
double secondsPerPoint(const eval::Operation& operation);
}

}  // namespace sgm::bench
