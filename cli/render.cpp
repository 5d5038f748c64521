// sgm render: a picture of the field or its mesh, without a window.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/pipeline.h"
#include "cli/watch.h"
#include "viewer/offscreen.h"

namespace sgm::cli {
namespace {

struct RenderRequest {
    ModelRequest model;
    GridRequest grid{.resolution = 256};
    std::string output, size = "960x720", view = "field", camera;
    int samples = 4;
    bool noGround = false, quiet = false;
};

Result<viewer::PictureOptions> parseSize(const std::string& text) {
    viewer::PictureOptions options;
    int used = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &options.width, &options.height, &used) != 2 || used != static_cast<int>(text.size()) ||
        std::min(options.width, options.height) < 1 || std::max(options.width, options.height) > 16384)
        return Error{Error::Kind::Usage, fmt::format("--size {}: write WIDTHxHEIGHT in pixels, as 960x720", text)};
    return options;
}

/// "ex,ey,ez,ax,ay,az": where the eye is and what it looks at, metres; "inside"; or nothing for the default frame.
Result<viewer::Camera> parseCamera(const std::string& text, const Model& model, const Box3f& bounds, double aspect) {
    if (text.empty()) return viewer::frame(model.tape, bounds, aspect);
    if (text == "inside") return viewer::inside(model.tape, bounds);
    viewer::Camera c;
    int used = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &c.eye.x, &c.eye.y, &c.eye.z, &c.at.x, &c.at.y, &c.at.z, &used) != 6 ||
        used != static_cast<int>(text.size()) || c.eye == c.at)
        return Error{Error::Kind::Usage, fmt::format("--camera {}: write EYE,AT as x,y,z,x,y,z in metres, or 'inside'", text)};
    return c;
}

Result<viewer::Image> draw(const RenderRequest& request, const Model& model, const Box3f& bounds, const viewer::PictureOptions& options,
                           Progress* progress) {
    const Provenance& provenance = model.lowered->provenance;
    if (request.view == "field") return viewer::drawField(model.tape, bounds, provenance, options, progress);
    Stages stages;
    const auto meshed = makeMesh(model, request.grid, stages, progress);
    if (!meshed.ok()) return meshed.error();
    return viewer::drawMesh(meshed->mesh, provenance, options, progress);
}

int render(const RenderRequest& request) {
    auto options = parseSize(request.size);
    if (!options.ok()) return fail(options.error());
    Stages stages;
    Watch watch(request.quiet);
    const auto model = makeModel(request.model, stages, watch.progress());
    if (!model.ok()) return fail(model.error());
    const Box3f bounds = viewer::tighten(model->tape, model->lowered->field.bounds);
    const auto camera = parseCamera(request.camera, *model, bounds, static_cast<double>(options->width) / options->height);
    if (!camera.ok()) return fail(camera.error());
    options->camera = *camera;
    options->samples = request.samples;
    options->ground = !request.noGround && request.camera != "inside";
    const auto image = draw(request, *model, bounds, *options, watch.progress());
    if (!image.ok()) return fail(image.error());
    if (const Status s = viewer::writePng(*image, request.output); !s.ok()) return fail(s.error());
    if (!request.quiet) fmt::print("wrote {}\n", request.output);
    return 0;
}

}  // namespace

void addRender(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("render", "Draw a picture; no display or GPU needed");
    auto request = std::make_shared<RenderRequest>();
    addModelOptions(*command, request->model);
    addGridOptions(*command, request->grid);
    command->add_option("-o,--output", request->output, "Picture to write (.png)")->required();
    command->add_option("--size", request->size, "Pixels, WxH")->capture_default_str();
    command->add_option("--view", request->view, "What is drawn")->check(CLI::IsMember({"field", "mesh"}))->capture_default_str();
    command->add_option("--camera", request->camera, "x,y,z,x,y,z: the eye and what it looks at; or 'inside' for a cave");
    command->add_option("--samples", request->samples, "Samples a pixel, for smooth edges")->check(CLI::Range(1, 64))->capture_default_str();
    command->add_flag("--no-ground", request->noGround, "Leave out the ground");
    command->add_flag("-q,--quiet", request->quiet, "Say nothing but errors");
    command->footer("Examples:\n  sgm render examples/cumulus.sgm -o cumulus.png --size 640x640\n  sgm render examples/grotto.sgm -o in.png --camera inside");
    command->callback([request, &exitCode] { exitCode = render(*request); });
}

}  // namespace sgm::cli
