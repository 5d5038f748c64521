// The frames of `sgm build --animate`, and what they write.
// Enters: a request. Leaves: a file a frame. Assumes a request that was checked.
#pragma once

#include "cli/delivery.h"

namespace sgm::cli {

/// Everything that the request writes, in all of so many frames; 0 where it isn't animated.
std::vector<Target> targetsOf(const BuildRequest& request, int frames);

/// Builds every frame, in one grid so that what doesn't move has the same vertices in each; from one frame to the next
/// every stage keeps what the animated parameters don't reach.
Status buildFrames(const BuildRequest& request);

}  // namespace sgm::cli
