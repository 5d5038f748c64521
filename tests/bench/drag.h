// Dragging a parameter: one number of a grammar changes, and the model is built again.
// Enters: a grammar, a parameter, a grid. Leaves: the time of a build from the start and of one that keeps what the
// change doesn't reach, both from the grammar on. Assumes the meshes are equal, and fails where they aren't.
#pragma once

#include "tests/bench/scenes.h"
#include "tests/bench/stopwatch.h"

namespace sgm::bench {

/// Stages of one build.
struct BuildSeconds {
    double derive = 0, lower = 0, compile = 0, mesh = 0;
    double descend = 0;  ///< of `mesh`
    double total() const { return derive + lower + compile + mesh; }
};

struct DragResult {
    std::string scene, parameter;
    int resolution = 0;
    BuildSeconds full, drag;                ///< the best of the steps
    size_t blocksMade = 0, blocksKept = 0;  ///< of the last step
    double share() const { return full.total() > 0 ? drag.total() / full.total() : 0; }
};

/// Moves the parameter through its range in `steps`. Error::Input where there is no such parameter with a range.
Result<DragResult> measureDrag(const GrammarScene& scene, const std::string& parameter, int resolution, int steps,
                               Running running);

}  // namespace sgm::bench
