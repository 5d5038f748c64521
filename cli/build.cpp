// sgm build: a grammar to meshes and volumes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/animation.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/floating.h"
#include "cli/pipeline.h"
#include "cli/report.h"
#include "cli/watch.h"
#include "modeler/export/exporter.h"
#include "modeler/mesh/edit.h"
#include "modeler/mesh/validate.h"
#include "modeler/volume/volume.h"

namespace sgm::cli {
namespace fs = std::filesystem;
namespace {

constexpr int bandVoxels = 3;  ///< half-width of the level set, OpenVDB's usual

struct BuildRequest {
    ModelRequest model;
    GridRequest grid;
    std::vector<std::string> outputs;
    std::vector<std::string> exportOptions;  ///< "NAME=VALUE"
    std::vector<std::string> animations;  ///< "NAME=FROM..TO:FRAMES"
    std::string report;
    int smooth = 0;
    double simplify = 1;
    bool judge = false, quiet = false;
};

Status checkOutputs(const BuildRequest& request) {
    std::vector<std::string> known;
    for (const exporter::Exporter& e : exporter::exporters()) known.emplace_back(e.extension);
    for (const std::string& output : request.outputs) {
        const std::string extension = fs::path(output).extension();
        if (!exporter::findExporter(extension))
            return Error{Error::Kind::Usage, fmt::format("'{}': no format has the ending '{}'; there are {}", output, extension, fmt::join(known, " "))};
        const fs::path folder = fs::path(output).parent_path();
        if (std::error_code ignored; !folder.empty() && !fs::is_directory(folder, ignored))
            return Error{Error::Kind::Input, fmt::format("'{}': the folder '{}' does not exist", output, folder.string())};
    }
    return Done{};
}

Result<std::map<std::string, std::string, std::less<>>> exportOptions(const BuildRequest& request) {
    std::map<std::string, std::string, std::less<>> options;
    for (const std::string& text : request.exportOptions) {
        const size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        bool known = false;
        for (const exporter::Exporter& e : exporter::exporters())
            for (const exporter::ExportOption& o : e.options) known |= o.name == name;
        if (equals == std::string::npos || !known)
            return Error{Error::Kind::Usage, fmt::format("--export {}: no format has that option (see `sgm reference`)", text)};
        options[name] = text.substr(equals + 1);
    }
    return options;
}

Result<mesh::Mesh> edited(mesh::Mesh mesh, const BuildRequest& request, Stages& stages, Progress* progress) {
    if (request.smooth > 0) {
        auto result = timed(stages, "smooth", [&] { return mesh::smooth(mesh, request.smooth, progress); });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    if (request.simplify < 1) {
        auto result = timed(stages, "simplify", [&] { return mesh::simplify(mesh, request.simplify, progress); });
        if (!result.ok()) return result;
        mesh = std::move(*result);
    }
    return mesh;
}

exporter::ExportInput exportInput(const BuildRequest& request, const Model& model, const mesh::Mesh& mesh) {
    exporter::ExportInput input;
    input.mesh = &mesh;
    input.provenance = &model.lowered->provenance;
    input.name = fs::path(request.model.file).stem();
    input.extras["grammar"] = fs::path(request.model.file).filename();
    input.extras["seed"] = fmt::format("{}", request.model.seed);
    const auto& params = model.derivation.grammar->params;
    for (size_t i = 0; i < params.size(); ++i) input.extras["param " + params[i].name] = rules::toText(model.derivation.params[i]);
    return input;
}

Status writeAll(const BuildRequest& request, const Model& model, const MeshedModel& meshed, exporter::ExportInput input, Progress* progress) {
    std::unique_ptr<volume::Volume> level;
    for (const std::string& output : request.outputs) {
        if (exporter::findExporter(fs::path(output).extension().string())->wantsVolume && !level) {
            auto sampled = volume::sample(meshed.blocks, model.tape, meshed.grid, bandVoxels, request.grid.threads, progress);
            if (!sampled.ok()) return sampled.error();
            level = std::make_unique<volume::Volume>(std::move(*sampled));
            input.volume = level.get();
        }
        if (const Status written = exporter::write(input, output); !written.ok()) return written;
    }
    return Done{};
}

void say(const BuildRequest& request, const Model& model, const mesh::MeshFigures& f, const Support& support, const Stages& stages) {
    double total = 0;
    for (const auto& stage : stages) total += stage.second;
    fmt::print("{} shapes, {} bonds, {} rules; {} triangles in {} component{}, {:.4g} m³; {:.2f} s\n", model.derivation.tree.shapes.size(),
               model.derivation.tree.bonds.size(), model.derivation.classic + model.derivation.morphic, f.triangles, f.components,
               f.components == 1 ? "" : "s", f.volume_m3, total);
    for (const std::string& output : request.outputs) fmt::print("wrote {}\n", output);
    sayFloating(model, support);
}

/// CGAL's word on the mesh as a line; Error::Input when it finds a fault.
Status judged(const mesh::Mesh& mesh, Stages& stages) {
    const auto judgement = timed(stages, "judge", [&] { return mesh::judge(mesh); });
    if (!judgement.ok()) return judgement.error();
    const std::string verdict = fmt::format("CGAL: {}, {}, {}, {:.6g} m³", judgement->closed ? "closed" : "not closed",
                                            judgement->outward ? "outward" : "not outward",
                                            judgement->selfIntersects ? "crosses itself" : "free of self-intersections", judgement->volume_m3);
    if (!judgement->closed || !judgement->outward || judgement->selfIntersects) return Error{Error::Kind::Input, verdict};
    fmt::print("{}\n", verdict);
    return Done{};
}

/// From a mesh to what was asked for: edits, judgement, files, figures.
Status deliver(const BuildRequest& request, const Model& model, MeshedModel meshed, Stages& stages, Progress* progress) {
    const auto options = exportOptions(request);
    if (!options.ok()) return options.error();
    auto mesh = edited(std::move(meshed.mesh), request, stages, progress);
    if (!mesh.ok()) return mesh.error();
    if (request.judge)
        if (const Status s = judged(*mesh, stages); !s.ok()) return s;

    exporter::ExportInput input = exportInput(request, model, *mesh);
    input.options = *options;
    input.progress = progress;
    const Status written = timed(stages, "write", [&] { return writeAll(request, model, meshed, input, progress); });
    if (!written.ok() || (request.quiet && request.report.empty())) return written;
    const mesh::MeshFigures figures = mesh::measure(*mesh);
    const Support support = supportOf(model, *mesh, meshed.grid.cell_m);
    if (!request.report.empty())
        if (const Status s = writeText(request.report, reportJson(model, meshed, figures, support, stages, request.grid.threads)); !s.ok()) return s;
    if (!request.quiet) say(request, model, figures, support, stages);
    return Done{};
}

Status buildOne(const BuildRequest& request) {
    if (const auto options = exportOptions(request); !options.ok()) return options.error();
    Stages stages;
    Watch watch(request.quiet);
    const auto model = makeModel(request.model, stages, watch.progress());
    if (!model.ok()) return model.error();
    auto meshed = makeMesh(*model, request.grid, stages, watch.progress());
    if (!meshed.ok()) return meshed.error();
    return deliver(request, *model, std::move(*meshed), stages, watch.progress());
}

/// The request of one frame: its files by name.
Result<BuildRequest> requestOf(const BuildRequest& request, int frame) {
    BuildRequest one = request;
    for (std::string& output : one.outputs) {
        const auto name = frameName(output, frame);
        if (!name.ok()) return name.error();
        output = *name;
    }
    if (one.report.empty()) return one;
    const auto report = frameName(one.report, frame);
    if (!report.ok()) return report.error();
    one.report = *report;
    return one;
}

/// All frames stand in one grid, so that what doesn't move has the same vertices in each: the box around them all.
Result<Box3f> boundsOfFrames(std::shared_ptr<const rules::Grammar> grammar, const derive::Options& options, const Animation& animation, Progress* progress) {
    Box3f bounds;
    for (int frame = 0; frame < animation.frames; ++frame) {
        derive::Options at = options;
        at.params = animation.values(options.params, frame);
        const auto derivation = derive::derive(grammar, at, progress);
        if (!derivation.ok()) return derivation.error();
        const auto lowered = lower::lower(*derivation, progress);
        if (!lowered.ok()) return lowered.error();
        bounds = hull(bounds, (*lowered)->field.bounds);
    }
    return bounds;
}

Status buildFrames(const BuildRequest& request) {
    if (request.outputs.empty()) return Error{Error::Kind::Usage, "--animate needs files to write: -o roof_%04d.glb"};
    for (int frame : {0, 1})
        if (const auto one = requestOf(request, frame); !one.ok()) return one.error();
    Stages loading;
    const auto grammar = loadGrammar(request.model.file, loading);
    if (!grammar) return Error{Error::Kind::Input, ""};
    auto options = optionsFor(*grammar, request.model);
    if (!options.ok()) return options.error();
    const auto animation = readAnimation(*grammar, request.animations);
    if (!animation.ok()) return animation.error();
    Watch watch(request.quiet);
    const auto bounds = boundsOfFrames(grammar, *options, *animation, watch.progress());
    if (!bounds.ok()) return bounds.error();
    const mesh::Grid grid = gridOver(*bounds, request.grid);
    const auto still = options->params;
    for (int frame = 0; frame < animation->frames; ++frame) {
        Stages stages;
        options->params = animation->values(still, frame);
        const auto model = makeModel(grammar, *options, stages, watch.progress());
        if (!model.ok()) return model.error();
        auto meshed = makeMesh(*model, grid, request.grid.threads, stages, watch.progress());
        if (!meshed.ok()) return meshed.error();
        if (!request.quiet) fmt::print("frame {} of {}, {}: ", frame + 1, animation->frames, animation->text(*grammar, frame));
        if (const Status s = deliver(*requestOf(request, frame), *model, std::move(*meshed), stages, watch.progress()); !s.ok()) return s;
        std::fflush(stdout);
    }
    return Done{};
}

int build(const BuildRequest& request) {
    Status done = checkOutputs(request);
    if (done.ok()) done = request.animations.empty() ? buildOne(request) : buildFrames(request);
    return done.ok() ? 0 : fail(done.error());
}

}  // namespace

void addBuild(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("build", "Grow a grammar and write meshes and volumes");
    auto request = std::make_shared<BuildRequest>();
    addModelOptions(*command, request->model);
    addGridOptions(*command, request->grid);
    command->add_option("-o,--output", request->outputs, "Output file, format by its ending; may be given again")->allow_extra_args(false);
    command->add_option("--export", request->exportOptions, "Option of a format, NAME=VALUE (see `sgm reference`)")->allow_extra_args(false);
    command->add_option("--animate", request->animations, "Run a parameter through frames, NAME=FROM..TO:FRAMES; -o needs a number: roof_%04d.glb")->allow_extra_args(false);
    command->add_option("--report", request->report, "Write the figures of this build as JSON");
    command->add_option("--smooth", request->smooth, "Passes of Laplacian smoothing")->check(CLI::Range(0, 1000));
    command->add_option("--simplify", request->simplify, "Decimate to this share of the triangles")->check(CLI::Range(0.001, 1.0));
    command->add_flag("--judge", request->judge, "Let CGAL judge the mesh before it is written: closed, outward, no self-intersection");
    command->add_flag("-q,--quiet", request->quiet, "Say nothing but errors");
    command->footer(
        "Examples:\n  sgm build examples/grotto.sgm -o grotto.glb -o grotto.vdb --resolution 256\n"
        "  sgm build examples/tower.sgm --set floors=12 --seed 7 -o tower.obj --report tower.json\n"
        "  sgm build examples/tower.sgm --animate peak=0..1:48 -o roof_%04d.glb");
    command->callback([request, &exitCode] { exitCode = build(*request); });
}

}  // namespace sgm::cli
