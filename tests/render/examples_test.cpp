// Every example's field, from every start, by the CPU and by the GLSL interpreter.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "grammar/pipeline/files.h"
#include "grammar/pipeline/model.h"
#include "grammar/rules/check.h"
#include "modeler/core/packages.h"
#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "tests/render/gpu_fixture.h"
#include "viewer/document/document.h"
#include "viewer/render/evaluate_gpu.h"

namespace sgm::render::test {
namespace {

namespace fs = std::filesystem;

struct Example {
    std::string name;
    pipeline::Model model;
};

/// All starts of all examples.
std::vector<Example> everyExample() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator("examples"))
        if (entry.path().extension() == ".sgm") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<Example> examples;
    for (const fs::path& file : files) {
        const Result<document::Document> document = document::Document::open(file);
        EXPECT_TRUE(document.ok()) << file;
        syntax::Diagnostics diagnostics = document->syntaxProblems();
        const auto grammar = rules::check(*document->ast(), pipeline::fileLoader(), diagnostics);
        if (!grammar && !isBuiltWith(Package::Cgal)) continue;  // lots of a skeleton
        EXPECT_TRUE(grammar) << file;
        for (const rules::Start& start : grammar->starts) {
            const std::string& symbol = grammar->symbols[start.symbol].name;
            pipeline::ModelChoice choice;
            choice.start = symbol;
            const auto options = pipeline::optionsFor(*grammar, choice);
            pipeline::Context context;
            auto model = options.ok() ? pipeline::makeModel(grammar, *options, context, pipeline::Objects::Sketched)
                                      : Result<pipeline::Model>(options.error());
            EXPECT_TRUE(model.ok()) << file << " " << symbol;
            if (model.ok()) examples.push_back({fmt::format("{} {}", file.string(), symbol), std::move(*model)});
        }
    }
    return examples;
}

/// Points all over the bounds, the same at every run.
std::vector<Vec3f> pointsIn(const Box3f& box, int count) {
    std::vector<Vec3f> points;
    for (int i = 0; i < count; ++i) {
        const auto draw = [&](uint64_t axis) {
            return static_cast<float>(uniform(combine(mix(axis), static_cast<uint64_t>(i)), 0, 1));
        };
        points.push_back(box.lo + Vec3f{draw(1) * box.size().x, draw(2) * box.size().y, draw(3) * box.size().z});
    }
    return points;
}

class Examples : public OnGpu {};

TEST_F(Examples, AreTheSameFieldOnTheGpu) {
    const std::vector<Example> examples = everyExample();
    EXPECT_GT(examples.size(), 40u);
    std::vector<GpuQuery> queries;
    for (const Example& example : examples)
        queries.push_back({&example.model.tape, pointsIn(example.model.lowered->field.bounds, 128)});
    const auto gpu = evaluateOnGpu(queries);
    ASSERT_TRUE(gpu.ok()) << gpu.error().message;
    // Software GL seems to end the loops of a shader early: pictures walk short tapes of cells, but whole ones of more
    // than 10,000 instructions come out wrong there, while 9,900 are right.
    constexpr size_t mostInstructions = 9000;
    size_t compared = 0;
    for (size_t e = 0; e < examples.size(); ++e) {
        const eval::Tape& tape = examples[e].model.tape;
        if (tape.size() > mostInstructions) continue;
        ++compared;
        const float size = length(examples[e].model.lowered->field.bounds.size());
        eval::Workspace workspace;
        float worst = 0;
        for (size_t i = 0; i < queries[e].points.size(); ++i) {
            const Vec3f& p = queries[e].points[i];
            float cpu = 0;
            eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &cpu, workspace);
            worst = std::max(worst, std::abs(cpu - (*gpu)[e][i]));
        }
        EXPECT_LT(worst, 2e-5f * size) << examples[e].name << ", " << size << " m large";
    }
    EXPECT_GT(compared, 40u);
}

}  // namespace
}  // namespace sgm::render::test
