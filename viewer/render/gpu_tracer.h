// Rays walked by shaders: one fixed program interprets the shortened tapes of cells, so that a new field costs an
// upload and no compile. Enters: prepared fields. Leaves: tracers. Assumes a current GL 4.3 context.
#pragma once

#include <memory>

#include "modeler/eval/glsl.h"
#include "viewer/render/gpu.h"
#include "viewer/render/tracer.h"

namespace sgm::render {

/// The two shaders, for tapes of these ops with at most so many registers.
struct RayPrograms {
    Program trace, surface;
    uint32_t registers = 0;
    eval::OpSet ops;

    /// True when the field can be drawn without a compile.
    bool cover(const PreparedField& field) const;
};

/// Programs for this field and those that `before` covers (null: none): `before` itself where it covers the field.
Result<std::shared_ptr<const RayPrograms>> rayProgramsFor(const PreparedField& field,
                                                          std::shared_ptr<const RayPrograms> before);

/// `programs` must cover the field.
std::unique_ptr<Tracer> gpuTracer(std::shared_ptr<const PreparedField> field,
                                  std::shared_ptr<const RayPrograms> programs);

/// Runs `program` over jobs [0, count), which it reads as firstJob and jobCount, in dispatches of `piece` jobs: some 15
/// ms each, by the time the last ones took.
Status runInPieces(const Program& program, size_t count, size_t& piece, Progress* progress);

/// The most jobs of one dispatch.
inline constexpr size_t mostJobs = size_t(1) << 18;

}  // namespace sgm::render
