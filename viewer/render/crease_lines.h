// Segments drawn as lines of a width in pixels.
// Enters: segments in metres. Leaves: draws into what is bound. Assumes a current GL 4.3 context.
#pragma once

#include <span>

#include "modeler/core/progress.h"
#include "viewer/render/gpu.h"
#include "viewer/render/mesh_marks.h"

namespace sgm::render {

/// Segments in GPU memory; the shader `crease` makes a quad of each. May be made in one context and drawn in another
/// that shares with it.
class CreaseLines {
public:
    CreaseLines() = default;
    explicit CreaseLines(std::span<const Segment> segments);
    /// Draws all by a program of that shader, whose uniforms are set but for `firstSegment`.
    Status draw(const Program& program, Progress* progress) const;

private:
    Buffer ends_;
    size_t count_ = 0;
    mutable VertexArray array_;  ///< made in the context that first draws, for contexts don't share them
};

}  // namespace sgm::render
