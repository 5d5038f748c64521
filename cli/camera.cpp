#include "cli/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/messages.h"
#include "modeler/eval/evaluate.h"

namespace sgm::cli {

Result<std::optional<render::Camera>> parseCamera(const std::string& text) {
    if (text.empty() || text == "inside") return std::optional<render::Camera>{};
    render::Camera c;
    int used = 0;
    const int read = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &c.eye.x, &c.eye.y, &c.eye.z, &c.at.x,
                                 &c.at.y, &c.at.z, &used);
    if (read != 6 || used != static_cast<int>(text.size()))
        return Error{Error::Kind::Usage,
                     fmt::format("--camera {}: write EYE,AT as x,y,z,x,y,z in metres, or 'inside'", text)};
    if (c.eye == c.at)
        return Error{Error::Kind::Usage,
                     fmt::format("--camera {}: the eye stands where it looks; let the last three numbers be another "
                                 "point",
                                 text)};
    return std::optional(c);
}

Result<render::Camera> cameraFor(const std::string& text, bool turns, const pipeline::Model& model, const Box3f& bounds,
                                 double aspect) {
    const bool hasObjects = !model.derivation.objects.empty();  // which the tape is without
    if (text.empty() && hasObjects) return render::frame(bounds, aspect);
    if (text.empty())
        return turns ? render::frameTurning(model.tape, bounds, aspect) : render::frame(model.tape, bounds, aspect);
    if (text == "inside" && hasObjects)
        return Error{Error::Kind::Usage, "--camera inside: with objects that 'place' puts, say where the eye is"};
    if (text == "inside") return render::inside(model.tape, bounds);
    const auto said = parseCamera(text);
    return said.ok() ? Result<render::Camera>(**said) : said.error();
}

void warnOfEye(const pipeline::Model& model, const render::Camera& camera, bool isInside, bool isFog) {
    if (model.lowered->field.bounds.empty() || (isFog && !isInside)) return;
    const Vec3f eye = camera.eye.as<float>();
    float value = 0;
    eval::Workspace workspace;
    eval::evaluate(model.tape, {&eye.x, &eye.y, &eye.z, 1}, &value, workspace);
    if (!(value < 0)) return;
    // The field bounds the distance only where it doesn't jump.
    const float depth_m = -value / std::max(1.f, model.lowered->field.lipschitz);
    const std::string deep = depth_m > 0 ? fmt::format("at least {:.3g} m ", depth_m) : "";
    if (isFog)
        return printMessage(
            "warning: the eye stands {}within the fog, where there is little else to be seen: leave --camera inside "
            "out, say where the eye is, or lower --extinction\n",
            deep);
    const char* const remedy = isInside ? "the model has no hollow to stand in: leave --camera inside out"
                                        : "move it, or write --camera inside";
    printMessage(
        "warning: the eye stands {}within the solid at ({:g}, {:g}, {:g}), from where walls are seen from within: "
        "{}\n",
        deep, camera.eye.x, camera.eye.y, camera.eye.z, remedy);
}

}  // namespace sgm::cli
