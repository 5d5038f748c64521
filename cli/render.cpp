// sgm render: pictures of the field, its mesh or fog, without a window.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/animation.h"
#include "cli/camera.h"
#include "cli/commands.h"
#include "cli/fog_picture.h"
#include "cli/ids.h"
#include "cli/mesh_warnings.h"
#include "cli/messages.h"
#include "cli/renamed.h"
#include "cli/requests.h"
#include "cli/validators.h"
#include "cli/watch.h"
#include "grammar/pipeline/mesh_edits.h"
#include "modeler/core/conventions.h"
#include "modeler/core/lower_case.h"
#include "viewer/render/draw.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;

/// What the command prints.
struct PrintRequest {
    bool stats = false, quiet = false;
    GridRequest warned;  ///< that of warnings about the mesh: as asked for, or as `sgm build` usually takes it
};

struct FogRequest {
    std::vector<std::string> options;  ///< "NAME=VALUE", as .vdb files take them
    double extinction = 0;
};

/// Where the eye stands, and by what light it sees.
struct CameraRequest {
    std::string place;             ///< as cameraFor reads it
    std::optional<double> lamp_m;  ///< reach of a lamp beside the eye; none: one where a mesh is seen from a hollow
};

struct RenderRequest {
    ModelRequest model;
    GridRequest grid{.resolution = 256};
    MeshEdits edits;
    std::string output, size = "960x720", view = "field", rays = "best";
    CameraRequest camera;
    std::vector<std::string> layers;
    FogRequest fog;
    int samples = 8, turntable = 0;  ///< turntable: how many pictures around the model, 0 for one
    bool noGround = false, wires = false;
    PrintRequest print;
};

/// Whether the view draws a mesh.
bool drawsMesh(const RenderRequest& request) {
    return request.view == "mesh" || request.view == "labels" || request.view == "creases";
}

Result<render::PictureOptions> parseSize(const std::string& text) {
    constexpr int longestSide = 16384;
    render::PictureOptions options;
    int used = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &options.width, &options.height, &used) != 2 ||
        used != static_cast<int>(text.size()) || std::min(options.width, options.height) < 1 ||
        std::max(options.width, options.height) > longestSide)
        return Error{Error::Kind::Usage,
                     fmt::format("--size {}: write WIDTHxHEIGHT in pixels, as 960x720; no side is longer than {}", text,
                                 longestSide)};
    return options;
}

/// A mesh with what its triangles are, as it is drawn: with the objects that `place` puts at all their places.
using DrawnMesh = std::optional<mesh::FlatScene>;

bool isExr(const RenderRequest& request) { return lowerCase(fs::path(request.output).extension().string()) == ".exr"; }

/// What can be refused before the work.
Status checkRequest(const RenderRequest& request) {
    const auto wrong = [](std::string why) -> Status { return Error{Error::Kind::Usage, std::move(why)}; };
    const fs::path output = request.output;
    if (lowerCase(output.extension().string()) != ".png" && !isExr(request))
        return wrong(fmt::format("'{}': pictures are .png, or .exr for floats", request.output));
    if (!request.layers.empty() && !isExr(request))
        return wrong(fmt::format("--aov: layers need a file that holds floats: -o {}",
                                 fs::path(output).replace_extension(".exr").string()));
    if (isExr(request) && request.view != "field")
        return wrong(
            fmt::format("'{}': layers are of the field; with --view {} write a .png", request.output, request.view));
    if (request.wires && !drawsMesh(request))
        return wrong("--wires are the edges of a mesh's triangles: add --view mesh, labels or creases");
    if (request.edits.isAsked() && !drawsMesh(request))
        return wrong("--keep, --smooth, --simplify and --tolerance change a mesh: add --view mesh, labels or creases");
    if (request.grid.objectCell_m > 0 && !drawsMesh(request))
        return wrong("--object-cell is of meshes: add --view mesh, labels or creases");
    if (request.fog.extinction > 0 && request.view != "fog") return wrong("--extinction is of fog: add --view fog");
    if (!request.fog.options.empty() && request.view != "fog")
        return wrong("--format-option is of fog, as .vdb files have it: add --view fog");
    if (const auto fog = fogOptions(request.fog.options); !fog.ok()) return fog.error();
    if (request.print.stats && (request.view != "field" || request.turntable > 0))
        return wrong("--stats counts evaluations of the field for one picture: leave out --view and --turntable");
    if (const auto camera = parseCamera(request.camera.place); !camera.ok()) return camera.error();
    const auto name = frameName(request.output, 0, "--turntable");
    if (request.turntable == 0 && name.ok())
        return wrong(fmt::format("-o {}: the name numbers pictures: add --turntable COUNT, or write a name without '%'",
                                 request.output));
    if (request.turntable > 0 && !name.ok()) return name.error();
    return request.view == "fog" ? checkFog() : Status(Done{});
}

/// What draws pictures of a view.
struct Painter {
    /// Draws a picture, and its layers unless null.
    std::function<Result<render::Image>(const render::PictureOptions&, Progress*, render::Layers*)> draw;
    /// What the latest picture cost; null for views that don't count.
    std::function<render::DrawCost()> cost;
};

Result<Painter> fogPainter(const RenderRequest& request, const Model& model, const Box3f& bounds, Progress* progress) {
    const auto painter = fogPainter(model, bounds, request.grid, request.fog.options, request.fog.extinction, progress);
    if (!painter.ok()) return painter.error();
    return Painter{[p = *painter](const auto& options, Progress* progress, render::Layers*) mutable {
                       return p.draw(options, progress);
                   },
                   {}};
}

render::TracedBy tracedBy(const std::string& name) {
    return name == "shaders"     ? render::TracedBy::Gpu
           : name == "processor" ? render::TracedBy::Processor
                                 : render::TracedBy::Best;
}

/// The mesh that `sgm build` writes, objects at all their places.
Result<DrawnMesh> meshAsBuilt(const RenderRequest& request, const Model& model, Progress* progress) {
    Context context{progress, request.grid.threads};
    auto meshed = makeMesh(model, request.grid, context);
    if (!meshed.ok()) return meshed.error();
    if (!request.print.quiet)
        if (const Status s = warnOfMesh(model, *meshed, context); !s.ok()) return s.error();
    keepOnly(request.edits.keep, *meshed, request.grid.threads, request.print.quiet);
    auto mesh = edited(std::move(meshed->mesh), request.edits, {model.tape, request.grid.surface, meshed->grid.cell_m},
                       context);
    if (!mesh.ok()) return mesh.error();
    const auto scene = makeScene(model, request.model, request.grid, request.edits, request.print.quiet, context);
    if (!scene.ok()) return scene.error();
    auto flat = mesh::flatten(scene->scene, *mesh);
    if (!flat.ok()) return flat.error();
    return DrawnMesh(std::move(*flat));
}

/// What every picture of the model shares is done here.
Result<Painter> painterOf(const RenderRequest& request, const Model& model, const DrawnMesh& mesh, const Box3f& bounds,
                          Progress* progress) {
    const Provenance& provenance = model.lowered->provenance;
    if (request.view == "field") {
        const auto painter = render::FieldPainter::create(model.tape, bounds, provenance, request.grid.threads,
                                                          progress, tracedBy(request.rays));
        if (!painter.ok()) return painter.error();
        return Painter{[p = *painter](const auto& options, Progress* progress, render::Layers* layers) mutable {
                           return p.draw(options, progress, layers);
                       },
                       [p = *painter] { return p.cost(); }};
    }
    if (request.view == "fog") return fogPainter(request, model, bounds, progress);
    if (request.view == "ids")
        return Painter{[&model, bounds](const auto& options, Progress* progress, render::Layers*) {
                           return drawIds(model, bounds, options, progress);
                       },
                       {}};
    const auto painter = render::MeshPainter::create(mesh->mesh, mesh->provenance, progress);
    if (!painter.ok()) return painter.error();
    render::MeshStyle style;
    style.wireframe = request.wires;
    if (request.view == "labels") style.look = render::MeshLook::Labels;
    if (request.view == "creases") style.look = render::MeshLook::Creases;
    return Painter{[p = *painter, style](const auto& options, Progress* progress, render::Layers*) mutable {
                       return p.draw(options, progress, style);
                   },
                   {}};
}

/// What the numbers of a file with layers mean.
std::map<std::string, std::string> metadataOf(const RenderRequest& request, const Provenance& provenance) {
    nlohmann::ordered_json origins = nlohmann::ordered_json::object();
    for (size_t id = 1; id < provenance.parts.size(); ++id) {
        const Part& part = provenance.parts[id];
        origins[std::to_string(id)] = {
            {"shape", part.path.text()}, {"symbol", part.symbol()}, {"rule", part.rule()}, {"line", part.line()}};
    }
    return {{"model", request.model.file},
            {"seed", std::to_string(request.model.seed)},
            {"units", "metres, Y up"},
            {"origins", origins.dump()}};
}

/// Evaluations of the field beside those of plain sphere tracing for the same samples, and seconds.
void printStatistics(const render::DrawCost& cost, const Model& model, const Box3f& bounds,
                     const render::PictureOptions& options, const Stages& stages) {
    const double pixels = static_cast<double>(options.width) * options.height,
                 samples = static_cast<double>(cost.samples) / pixels;
    const double hits = static_cast<double>(cost.hitEvaluations) / pixels,
                 light = static_cast<double>(cost.lightEvaluations) / pixels, all = std::max(hits + light, 1e-9);
    const double plain = render::plainEvaluations(model.tape, bounds, options, cost.probes) * samples;
    const double length = static_cast<double>(cost.instructions) / pixels / all,
                 whole = static_cast<double>(model.tape.size());
    fmt::print("samples a pixel       {:9.2f}\n", samples);
    fmt::print(
        "evaluations a pixel   {:9.2f}  of {:.0f} instructions ({:.2f} for hits, {:.2f} for normals and light)\n",
        hits + light, length, hits, light);
    fmt::print(
        "plain sphere tracing  {:9.2f}  of {:.0f}: {:.1f} times the evaluations, {:.0f} times the instructions\n",
        plain, whole, plain / all, plain * whole / (all * length));
    for (const auto& [stage, seconds] : stages) fmt::print("{:<21} {:9.3f} s\n", stage, seconds);
    fmt::print("cells, upload         {:9.3f} s\ndraw                  {:9.3f} s  ({:.3f} s of the processor's time)\n",
               cost.prepareSeconds, cost.drawSeconds, cost.drawProcessorSeconds);
}

Status drawOne(const RenderRequest& request, const Painter& paint, const render::PictureOptions& options,
               const Provenance& provenance, const std::string& file, Progress* progress) {
    render::Layers layers;
    const auto image = paint.draw(options, progress, isExr(request) ? &layers : nullptr);
    if (!image.ok()) return image.error();
    const Status written = isExr(request)
                               ? render::writeExr(layers, request.layers, metadataOf(request, provenance), file)
                               : render::writePng(*image, file);
    if (written.ok() && !request.print.quiet) fmt::print("wrote {}\n", file);
    std::fflush(stdout);
    return written;
}

/// The camera after a share of a turn: around the model, or from inside it around where the eye stands.
render::Camera cameraAfter(const RenderRequest& request, render::Camera camera, int picture) {
    const double angle = 2 * pi * picture / request.turntable;
    if (request.camera.place != "inside") return render::turned(camera, angle);
    std::swap(camera.eye, camera.at);
    camera = render::turned(camera, angle);
    std::swap(camera.eye, camera.at);
    return camera;
}

/// The camera with the lamp that the request says, or one that lights a hollow from which a mesh is seen.
render::Camera withLamp(const RenderRequest& request, const pipeline::Model& model, const Box3f& bounds,
                        render::Camera camera) {
    if (request.camera.lamp_m)
        camera.lamp_m = *request.camera.lamp_m;
    else if (camera.lamp_m == 0 && drawsMesh(request) && model.derivation.objects.empty())
        camera.lamp_m = render::lampFor(model.tape, bounds, camera.eye);
    return camera;
}

Status drawAll(const RenderRequest& request) {
    auto options = parseSize(request.size);
    if (!options.ok()) return options.error();
    Watch watch(request.print.quiet);
    Context context{watch.progress()};
    const auto model =
        makeModel(request.model, context, drawsMesh(request) ? pipeline::Objects::Apart : pipeline::Objects::Sketched);
    if (!model.ok()) return model.error();
    if (!request.print.quiet) printWarnings(*model);
    if (!request.print.quiet && request.view == "field")
        if (const Status told = warnAsBuild(*model, request.model, request.print.warned, watch.progress()); !told.ok())
            return told;
    if (const std::string note = pipeline::sketchNote(model->derivation); !note.empty() && !request.print.quiet)
        printMessage("note: {}; add --view mesh\n", note);
    DrawnMesh mesh;
    if (drawsMesh(request)) {
        auto built = meshAsBuilt(request, *model, watch.progress());
        if (!built.ok()) return built.error();
        mesh = std::move(*built);
    }
    const Box3f bounds = model->derivation.objects.empty() ? render::tighten(model->tape, model->lowered->field.bounds)
                                                           : mesh->mesh.bounds();
    const auto camera = cameraFor(request.camera.place, request.turntable > 0, *model, bounds,
                                  static_cast<double>(options->width) / options->height);
    if (!camera.ok()) return camera.error();
    if (!request.print.quiet) warnOfEye(*model, *camera, request.camera.place == "inside", request.view == "fog");
    options->camera = withLamp(request, *model, bounds, *camera);
    options->samples = request.samples;
    options->threads = request.grid.threads;
    options->ground = !request.noGround && request.camera.place != "inside";
    const auto paint = painterOf(request, *model, mesh, bounds, watch.progress());
    if (!paint.ok()) return paint.error();
    const Provenance& provenance = model->lowered->provenance;
    if (request.turntable == 0) {
        const Status drawn = drawOne(request, *paint, *options, provenance, request.output, watch.progress());
        if (drawn.ok() && request.print.stats) printStatistics(paint->cost(), *model, bounds, *options, context.stages);
        return drawn;
    }
    for (int i = 0; i < request.turntable; ++i) {
        options->camera = withLamp(request, *model, bounds, cameraAfter(request, *camera, i));
        const auto name = frameName(request.output, i, "--turntable");
        if (const Status s = drawOne(request, *paint, *options, provenance, *name, watch.progress()); !s.ok()) return s;
    }
    return Done{};
}

/// Every picture that will be drawn.
std::vector<Target> targetsOf(const RenderRequest& request) {
    std::vector<Target> targets;
    for (int i = 0; i < std::max(request.turntable, 1); ++i)
        targets.push_back(
            {"-o", request.turntable == 0 ? request.output : *frameName(request.output, i, "--turntable")});
    return targets;
}

int render(RenderRequest request) {
    request.model.quiet = request.print.quiet;
    Status done = checkRequest(request);
    if (done.ok()) request.model.targets = targetsOf(request);
    if (done.ok()) done = checkTargets(request.model.targets);
    if (done.ok()) done = drawAll(request);
    return done.ok() ? 0 : fail(done.error());
}

/// How fog looks, and how finely and by what its rays are traced.
void addRayOptions(CLI::App& app, RenderRequest& request) {
    app.add_option("--extinction", request.fog.extinction, "Of fog, per metre (default: 180 over the model's diagonal)")
        ->check(between(1e-6, 1e6));
    app.add_option("--format-option", request.fog.options,
                   "Of fog, NAME=VALUE as `sgm build` takes it for .vdb: density, edge, wisps, billow, lump; the "
                   "picture then is of the fog that such a file holds")
        ->allow_extra_args(false);
    addRenamedOption(app, "--export", "--format-option", request.fog.options);
    app.add_option("--samples", request.samples, "Samples a pixel, for smooth edges")
        ->check(wholeNumber(1, 64))
        ->capture_default_str();
    app.add_option(
           "--rays", request.rays,
           "What traces the rays of a field: shaders, the processor, or the best of them here, which is the processor "
           "where OpenGL has no GPU")
        ->check(oneOf({"best", "shaders", "processor"}))
        ->capture_default_str();
}

}  // namespace

void addRender(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("render", "Draw a picture; no display or GPU needed");
    auto request = std::make_shared<RenderRequest>();
    addModelOptions(*command, request->model);
    addSectionOption(*command, request->model);
    addGridOptions(*command, request->grid);
    addObjectOptions(*command, request->grid);
    addEditOptions(*command, request->edits);
    command->add_option("-o,--output", request->output, "Picture to write (.png, or .exr for floats)")->required();
    command->add_option("--size", request->size, "Pixels, WxH")->capture_default_str();
    command
        ->add_option("--view", request->view,
                     "What is drawn: the field, its mesh, the mesh with a hue for each smooth piece (labels) or with "
                     "its hard edges (creases), fog in its place, or the facade ids and storeys of what is clad")
        ->check(oneOf({"field", "mesh", "labels", "creases", "fog", "ids"}))
        ->capture_default_str();
    command->add_option("--camera", request->camera.place,
                        "x,y,z,x,y,z: the eye and what it looks at; or 'inside' for a cave");
    command
        ->add_option("--lamp", request->camera.lamp_m,
                     "Reach of a warm lamp beside the eye in metres, 0 for none; by default one lights hollows from "
                     "which a mesh is seen, and what --camera inside shows")
        ->check(CLI::Range(0.0, 1e6));
    command
        ->add_option("--aov", request->layers,
                     "Layers beside the colour of an .exr: depth, normal, position, origin, ao; metres, ids of shapes "
                     "with their names in the file")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(oneOf(render::layerNames()));
    command
        ->add_option("--turntable", request->turntable,
                     "Draw this many pictures around the model; -o needs a number: turn_%04d.png")
        ->check(wholeNumber(1, 10'000));
    addRayOptions(*command, *request);
    command->add_flag("--wires", request->wires, "Draw the edges of the mesh's triangles");
    command->add_flag("--no-ground", request->noGround, "Leave out the ground");
    command->add_flag("--stats", request->print.stats,
                      "Print how often the field was evaluated a pixel, beside plain sphere tracing, and the times");
    command->add_flag("-q,--quiet", request->print.quiet, "Say nothing but errors");
    command->footer(
        "Examples:\n  sgm render examples/cumulus.sgm -o cumulus.png --size 640x640\n  sgm render examples/grotto.sgm "
        "-o in.png --camera inside\n"
        "  sgm render examples/cumulus.sgm -o sky.png --view fog --no-ground\n"
        "  sgm render examples/tower.sgm -o mesh.png --view mesh --wires\n"
        "  sgm render examples/tower.sgm -o tower.exr --aov depth,normal,origin\n  sgm render examples/tower.sgm -o "
        "turn_%04d.png --turntable 36");
    command->callback([request, command, &exitCode] {
        const bool isAsked = command->count("--resolution") + command->count("--cell") > 0;
        request->print.warned =
            isAsked ? request->grid : GridRequest{.halvings = request->grid.halvings, .threads = request->grid.threads};
        exitCode = render(*request);
    });
}

}  // namespace sgm::cli
