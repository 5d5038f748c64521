#include "viewer/window/framing.h"

#include "grammar/derive/lift.h"
#include "viewer/render/camera.h"

namespace sgm::window {

Box3d bounds(const Workbench& bench) {
    if (!bench.shown()) return {{-1, -1, -1}, {1, 1, 1}};
    return bench.view.field.hasField() ? bench.view.field.bounds().as<double>()
                                       : bench.shown()->model.lowered->field.bounds.as<double>();
}

Box3d boundsOf(const Workbench& bench, derive::ShapeId shape) {
    Box3d box;
    const derive::ShapeTree& shapes = *bench.tree();
    for (derive::ShapeId id = shape; id != derive::none; id = shapes.next(id, shape)) {
        const derive::Scope scope = derive::liftedScope(bench.shown()->model.derivation, id);
        for (int corner = 0; corner < 8; ++corner)
            box = hull(box, scope.point({corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0}));
    }
    return box;
}

void frameAll(Workbench& bench) {
    bench.view.orbit.lamp_m = 0;
    bench.view.orbit.fieldOfView = render::Camera{}.fieldOfView;
    bench.view.orbit.frame(bounds(bench));
}

void frameSelection(Workbench& bench) {
    if (bench.selected() == derive::none) return frameAll(bench);
    bench.view.orbit.frame(boundsOf(bench, bench.selected()));
}

render::MeshStyle meshStyle(const Workbench& bench) {
    render::MeshStyle style = bench.view.look.mesh;
    if (bench.view.look.section) {
        // A little beyond the plane, so that the cut of a mesh that ends there is seen; one that doesn't yet is cut
        // here.
        const Box3f box =
            bench.session.model() ? bench.session.model()->model.lowered->field.bounds : bounds(bench).as<float>();
        const pipeline::Section plane = bench.view.look.plane();
        style.section = render::Section{plane.normal().as<float>(),
                                        static_cast<float>(plane.offset_m(box)) + 1e-4f * length(box.size())};
    }
    return style;
}

std::optional<double> groundBelow(const Workbench& bench, Vec3d from) {
    if (!bench.shown()) return std::nullopt;
    const double foot_m = bounds(bench).lo.y;
    return render::surfaceBelow(bench.shown()->model.tape, from, foot_m).value_or(foot_m);
}

}  // namespace sgm::window
