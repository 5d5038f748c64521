// Kaleidoscopic fractals: how fast a tape folds beside a loop by hand, and how often a facade's shells spare the
// folding. Enters: nothing; the scenes are S2, S9 and tests/bench/scenes/facades.sgm. Leaves: tables as text. Assumes a
// calm machine.
#pragma once

#include "tests/bench/scenes.h"

namespace sgm::bench {

/// The fractal, cut by its box, at a multiple of 32 points; false, and nothing done, where the
/// machine has no AVX-512.
bool foldByHand(const Fractal& fractal, eval::Points points, float* out);

/// One thread, batches of 4,096 points within the bounds. Errors as of loadGrammar, makeScene and subdivide.
Result<std::string> kifsTables(Clock clock);

}  // namespace sgm::bench
