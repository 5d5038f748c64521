#include "modeler/eval/glsl.h"
#include "viewer/gpu.h"
#include "viewer/offscreen.h"
#include "viewer/shader_text.h"

namespace sgm::viewer {

Result<std::vector<float>> evaluateOnGpu(const eval::Tape& tape, const std::vector<Vec3f>& points) {
    if (points.empty()) return std::vector<float>{};
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    const Result<Program> program =
        Program::compute(shaderText("evaluate", eval::interpreterGlsl(tape.registerCount())));
    if (!program) return program.error();

    std::vector<uint32_t> words;
    const uint32_t start = eval::appendTape(tape, words);
    const TexelBuffer texels = TexelBuffer::of(words, 4);
    std::vector<std::array<float, 4>> positions;
    for (const Vec3f& p : points) positions.push_back({p.x, p.y, p.z, 0});
    const Buffer pointBuffer = Buffer::of<std::array<float, 4>>(positions);
    const Buffer valueBuffer = Buffer::ofBytes(nullptr, points.size() * sizeof(float));
    texels.bind(0);
    pointBuffer.bindStorage(1);
    valueBuffer.bindStorage(2);
    program->use();
    program->set("tapes", 0);
    program->set("tapeStart", start);
    program->set("firstJob", 0u);
    program->set("jobCount", static_cast<uint32_t>(points.size()));
    dispatch(points.size());
    return valueBuffer.read<float>(points.size());
}

}  // namespace sgm::viewer
