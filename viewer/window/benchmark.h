// How fast the window answers, measured in the window itself: stages to the first picture, a slider that is dragged,
// shapes that come and go, and the gaps between polls of the user's input. Enters: the workbench, once a turn of the
// loop. Leaves: a table on stdout. Assumes a grammar that can be shown.
#pragma once

#include <string>
#include <vector>

#include "modeler/core/stopwatch.h"
#include "viewer/window/workbench.h"

namespace sgm::window {

class Benchmark {
public:
    /// To be called at the end of every turn, with what it took without waiting for events. False when all is measured.
    bool go(Workbench& bench, const FrameTimeline& turn);
    void print(const Workbench& bench, const std::string& driver) const;

private:
    enum class Phase { Load, Drag, Structure };
    struct Change {
        double coarse = 0;  ///< seconds from the edit to its coarse picture
        int compiles = 0;
        pipeline::Stages stages;  ///< of the model that it made
    };
    bool begin(Workbench& bench);
    void printDragStages() const;

    Phase phase_ = Phase::Load;
    std::vector<Change> drags_, structures_;
    pipeline::Stages first_;                    ///< of the first model and picture
    ElapsedTimes gap_;                          ///< the longest on each clock
    std::vector<FrameTimeline::Part> longest_;  ///< of the turn that took longest by the wall's
    Stopwatch since_;
    int compiles_ = 0;
    bool waiting_ = false;
};

}  // namespace sgm::window
