// Values of a field as shaders compute them.
#pragma once

#include <vector>

#include "modeler/core/result.h"
#include "modeler/core/vec.h"
#include "modeler/eval/tape.h"

namespace sgm::render {

/// Values of the GLSL interpreter at points, read back; for tests that compare with the CPU.
Result<std::vector<float>> evaluateOnGpu(const eval::Tape& tape, const std::vector<Vec3f>& points);
/// The same for several tapes by one shader: a list of values for each.
struct GpuQuery {
    const eval::Tape* tape;
    std::vector<Vec3f> points;
};
Result<std::vector<std::vector<float>>> evaluateOnGpu(const std::vector<GpuQuery>& queries);

}  // namespace sgm::render
