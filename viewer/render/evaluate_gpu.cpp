#include <algorithm>

#include "modeler/eval/glsl.h"
#include "viewer/render/evaluate_gpu.h"
#include "viewer/render/gpu.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {
namespace {

std::vector<float> valuesOf(const Program& program, const GpuQuery& query) {
    std::vector<uint32_t> words;
    const uint32_t start = eval::appendTape(*query.tape, words);
    const TexelBuffer texels = TexelBuffer::of(words, 4), single = texels.as(1);
    std::vector<std::array<float, 4>> positions;
    for (const Vec3f& p : query.points) positions.push_back({p.x, p.y, p.z, 0});
    const Buffer pointBuffer = Buffer::of<std::array<float, 4>>(positions);
    const Buffer valueBuffer = Buffer::ofBytes(nullptr, positions.size() * sizeof(float));
    texels.bind(0);
    single.bind(1);
    pointBuffer.bindStorage(1);
    valueBuffer.bindStorage(2);
    program.use();
    program.set("tapes", 0);
    program.set("tapeWords", 1);
    program.set("tapeStart", start);
    program.set("firstJob", 0u);
    program.set("jobCount", static_cast<uint32_t>(positions.size()));
    dispatch(positions.size());
    return valueBuffer.read<float>(positions.size());
}

}  // namespace

Result<std::vector<std::vector<float>>> evaluateOnGpu(const std::vector<GpuQuery>& queries) {
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    uint32_t registers = 0;
    for (const GpuQuery& query : queries) registers = std::max(registers, query.tape->registerCount());
    const Result<Program> program = Program::compute(shaderText("evaluate", eval::interpreterGlsl(registers)));
    if (!program) return program.error();
    std::vector<std::vector<float>> values;
    for (const GpuQuery& query : queries)
        values.push_back(query.points.empty() ? std::vector<float>() : valuesOf(*program, query));
    return values;
}

Result<std::vector<float>> evaluateOnGpu(const eval::Tape& tape, const std::vector<Vec3f>& points) {
    Result<std::vector<std::vector<float>>> values = evaluateOnGpu({{&tape, points}});
    if (!values) return values.error();
    return std::move(values->front());
}

}  // namespace sgm::render
