// What the machine can do at best, measured on the spot.
// Enters: a number of threads and a clock. Leaves: rates. Assumes nothing else runs; the best of a few tries counts.
#pragma once

#include <string_view>

#include "tests/bench/stopwatch.h"

namespace sgm::bench {

struct Limits {
    double fusedGflops = 0;  ///< 10⁹ flop/s of independent fused multiply-adds in the widest vectors (2 flop a lane)
    double writeGBs = 0;     ///< 10⁹ byte/s stored to memory that is in use already, too large for any cache
    double freshWriteGBs = 0;  ///< the same to pages never touched before, which the system must clear and map
    double copyGBs = 0;        ///< 10⁹ byte/s read plus as many written
};

Limits measureLimits(Running running);
/// The widest instruction set used, "AVX-512", "AVX2" or "portable".
std::string_view instructionSet();

}  // namespace sgm::bench
