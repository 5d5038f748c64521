#include "cli/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/animation.h"
#include "cli/messages.h"
#include "cli/watch.h"
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/incremental.h"

namespace sgm::cli {
namespace {

/// The request of one frame: its files by name.
Result<BuildRequest> requestOf(const BuildRequest& request, int frame) {
    BuildRequest one = request;
    std::vector<std::string*> names{&one.out.proxy, &one.report, &one.floor};
    for (std::string& file : one.out.files) names.push_back(&file);
    for (std::string* name : names) {
        if (name->empty()) continue;
        const auto framed = frameName(*name, frame);
        if (!framed.ok()) return framed.error();
        *name = *framed;
    }
    return one;
}

/// The box around all frames.
Result<Box3f> boundsOfFrames(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options,
                             const Animation& animation, Progress* progress) {
    Box3f bounds;
    pipeline::IncrementalPipeline incremental;
    for (int frame = 0; frame < animation.frames; ++frame) {
        derive::Options at = options;
        at.params = animation.values(options.params, frame);
        if (const Status done = incremental.derive(grammar, at, progress); !done.ok()) return done.error();
        if (const Status done = incremental.lower(progress); !done.ok()) return done.error();
        bounds = hull(bounds, incremental.model().field.bounds);
    }
    return bounds;
}

/// A grammar and how it is animated.
struct Scene {
    std::shared_ptr<const rules::Grammar> grammar;
    derive::Options options;
    Animation animation;
};

Result<Scene> loadScene(const BuildRequest& request, Context& context) {
    std::vector<std::filesystem::path> inputs;
    const auto grammar = loadGrammar(request.model, context, &inputs);
    if (!grammar.ok()) return grammar.error();
    auto options = optionsFor(**grammar, request.model);
    if (!options.ok()) return options.error();
    auto animation = readAnimation(**grammar, request.animations);
    if (!animation.ok()) return animation.error();
    for (const Animation::Track& track : animation->tracks)
        for (const std::string& set : request.model.settings)
            if (const std::string& name = (*grammar)->params[track.param].name; set.starts_with(name + "="))
                return Error{Error::Kind::Usage,
                             fmt::format("--set {}: --animate sets '{}' in every frame: leave one out", set, name)};
    const std::vector<Target> targets = targetsOf(request, animation->frames);
    if (const Status s = checkTargets(targets); !s.ok()) return s.error();
    if (const Status s = checkAgainstInputs(targets, inputs); !s.ok()) return s.error();
    return Scene{*grammar, std::move(*options), std::move(*animation)};
}

/// What doesn't move from frame to frame keeps its vertices.
mesh::PolygonizeOptions frameMeshingOf(const BuildRequest& request) {
    mesh::PolygonizeOptions options = meshingOf(request.grid, needsPositionsOnly(request));
    options.halvesAll = false;
    return options;
}

/// Meshes the model that `incremental` stands at and writes what the frame's request wants.
Status writeFrame(const BuildRequest& framed, pipeline::IncrementalPipeline& incremental, const mesh::Grid& grid,
                  Context& context) {
    const Model model = incremental.viewModel();
    if (const Status s = writeMeshless(framed, model, context); !s.ok()) return s;
    if (needsNoMesh(framed)) return printFiles(framed), Done{};
    auto division = pipeline::divide(model, framed.out.objects);
    if (!division.ok()) return division.error();
    auto meshed = wantsLevelSet(framed) ? makeMesh(model, grid, frameMeshingOf(framed), context)
                                        : incremental.meshed(grid, context);
    if (!meshed.ok()) return meshed.error();
    return deliver(framed, model, std::move(*division), std::move(*meshed), {}, context);
}

}  // namespace

std::vector<Target> targetsOf(const BuildRequest& request, int frames) {
    std::vector<Target> targets;
    for (int frame = 0; frame < std::max(frames, 1); ++frame) {
        const BuildRequest one = frames == 0 ? request : *requestOf(request, frame);
        for (const std::string& file : one.out.files) targets.push_back({"-o", file});
        for (const auto& [option, file] : {std::pair("--proxy", one.out.proxy),
                                           {"--floor", one.floor},
                                           {"--report", reportsToStdout(one) ? "" : one.report}})
            if (!file.empty()) targets.push_back({option, file});
    }
    return targets;
}

Status buildFrames(const BuildRequest& request) {
    if (allFiles(request.out).empty())
        return Error{Error::Kind::Usage, "--animate needs files to write: -o roof_%04d.glb"};
    for (int frame : {0, 1})
        if (const auto one = requestOf(request, frame); !one.ok()) return one.error();
    Watch watch(displayOf(request));
    Context loading{watch.progress(), request.grid.threads};
    const auto scene = loadScene(request, loading);
    if (!scene.ok()) return scene.error();
    const auto bounds = boundsOfFrames(scene->grammar, scene->options, scene->animation, watch.progress());
    if (!bounds.ok()) return bounds.error();
    mesh::Grid grid = gridOver(*bounds, request.grid);
    pipeline::IncrementalPipeline incremental(frameMeshingOf(request));
    mesh::SimplifiedPieces pieces;
    for (int frame = 0; frame < scene->animation.frames; ++frame) {
        Context context{watch.progress(), request.grid.threads};
        derive::Options options = scene->options;
        options.params = scene->animation.values(options.params, frame);
        if (const Status done = incremental.to(scene->grammar, options, context); !done.ok()) return done;
        if (frame == 0 && request.grid.surface == mesh::Surface::Crisp)
            grid = pipeline::moveOffPlanes(grid, incremental.derivation());
        if (frame == 0 && !request.quiet) printDiagnostics(derive::warnings(incremental.derivation()));
        if (!request.quiet)
            fmt::print("frame {} of {}, {}: ", frame + 1, scene->animation.frames,
                       scene->animation.text(*scene->grammar, frame));
        BuildRequest framed = *requestOf(request, frame);
        framed.edits.pieces = &pieces;
        // What parameters make too thin in between is too thin at one of the ends.
        framed.seeksThinParts = frame == 0 || frame + 1 == scene->animation.frames;
        const Status written = writeFrame(framed, incremental, grid, context);
        if (!written.ok()) return written;
        std::fflush(stdout);
    }
    return Done{};
}

}  // namespace sgm::cli
