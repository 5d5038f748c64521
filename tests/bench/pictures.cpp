#include "tests/bench/pictures.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewer/render/draw.h"

namespace sgm::bench {
namespace {

constexpr int fullEdge = 640, coarseEdge = 128;

struct Subject {
    SceneEntry entry;
    std::string parameter;  ///< to be set, "" for none
    double value;
};

/// Who walks the rays, and what a row says of it.
const std::pair<render::TracedBy, const char*> tracers[] = {{render::TracedBy::Best, ""},
                                                            {render::TracedBy::Gpu, ", shaders"}};

const Subject subjects[] = {{{"5,000 spheres", "tests/bench/cloud5000.sgm", ""}, "", 0},
                            {{"12 storeys", "examples/kifs/mcgraw.sgm", ""}, "floors", 12}};

Result<PictureResult> measured(const Subject& subject, const std::pair<render::TracedBy, const char*>& tracer,
                               int repeats, Running running) {
    auto grammar = loadGrammar(subject.entry);
    if (!grammar.ok()) return grammar.error();
    const auto& params = grammar->grammar->params;
    for (size_t i = 0; i < params.size(); ++i)
        if (params[i].name == subject.parameter) grammar->options.params[i].n[0] = subject.value;
    const auto scene = makeScene(*grammar, running);
    if (!scene.ok()) return scene.error();
    const Box3f bounds = render::tighten(scene->tape, scene->model->field.bounds);
    auto painter = render::FieldPainter::create(scene->tape, bounds, scene->model->provenance, running.threads, nullptr,
                                                tracer.first);
    if (!painter.ok()) return painter.error();
    render::PictureOptions coarse, full;
    full.width = full.height = fullEdge;
    coarse.width = coarse.height = coarseEdge;
    coarse.samples = 1;
    full.camera = coarse.camera = render::frame(scene->tape, bounds, 1);
    full.threads = coarse.threads = running.threads;
    PictureResult result;
    result.name = std::string(subject.entry.name) + tracer.second;
    result.asked = tracer.first == render::TracedBy::Best;
    const auto best = [](double& kept, double now) { kept = kept == 0 ? now : std::min(kept, now); };
    // The first picture finishes the driver's compile.
    if (const auto first = painter->draw(coarse, nullptr); !first.ok()) return first.error();
    result.cellsSeconds = painter->cost().prepareSeconds;
    for (int round = 0; round < repeats; ++round) {
        if (const auto image = painter->draw(coarse, nullptr); !image.ok()) return image.error();
        best(result.coarseSeconds, painter->cost().drawSeconds);
        if (const auto image = painter->draw(full, nullptr); !image.ok()) return image.error();
        best(result.fullSeconds, painter->cost().drawSeconds);
        best(result.fullProcessorSeconds, painter->cost().drawProcessorSeconds);
    }
    const render::DrawCost& cost = painter->cost();
    const double pixels = double(fullEdge) * fullEdge;
    result.samples = static_cast<double>(cost.samples) / pixels;
    result.hits = static_cast<double>(cost.hitEvaluations) / pixels;
    result.light = static_cast<double>(cost.lightEvaluations) / pixels;
    result.plain = render::plainEvaluations(scene->tape, bounds, full, cost.probes) * result.samples;
    return result;
}

}  // namespace

Result<std::vector<PictureResult>> measurePictures(int repeats, Running running) {
    std::vector<PictureResult> results;
    for (const Subject& subject : subjects)
        for (const auto& tracer : tracers) {
            auto result = measured(subject, tracer, repeats, running);
            if (!result.ok())
                return Error{result.error().kind, fmt::format("{}: {}", subject.entry.name, result.error().message)};
            results.push_back(std::move(*result));
        }
    return results;
}

std::string pictureTable(const std::vector<PictureResult>& results) {
    std::string table =
        fmt::format("{:<23} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6}\n", "640 x 640", "cells s",
                    "coarse s", "full s", "cpu s", "samples", "hits", "light", "plain", "ratio");
    for (const PictureResult& r : results)
        table += fmt::format("{:<23} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:6.2f}\n", r.name,
                             r.cellsSeconds, r.coarseSeconds, r.fullSeconds, r.fullProcessorSeconds, r.samples, r.hits,
                             r.light, r.plain, r.ratio());
    return table;
}

std::vector<Bar> judge(const std::vector<PictureResult>& results) {
    std::vector<Bar> bars;
    for (const PictureResult& r : results) {
        if (!r.asked) continue;
        bars.push_back({r.name + ": full picture, s", 1.5, false, r.fullSeconds, ""});
        bars.push_back({r.name + ": coarse picture, s", 0.12, false, r.coarseSeconds, ""});
        bars.push_back({r.name + ": evaluations of plain tracing / ours", 3, true, r.ratio(), ""});
    }
    return bars;
}

}  // namespace sgm::bench
