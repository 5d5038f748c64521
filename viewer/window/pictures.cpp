#include "viewer/window/pictures.h"

#include <fmt/format.h>

#include "modeler/core/conventions.h"

namespace sgm::window {

void startTurntable(Workbench& bench, int count) {
    bench.pictures.turntable = Turntable{0, count, bench.view.orbit.yaw};
}

Result<bool> takePictures(Workbench& bench) {
    const bool whole = bench.view.look.pane == Pane::Mesh ? bench.view.mesh.visible() && bench.view.mesh.finished()
                                                          : bench.view.field.finished();
    if (!whole || (!bench.pictures.wanted && !bench.pictures.turntable)) return false;
    const std::filesystem::path stem =
        bench.document.path().empty() ? "untitled" : std::filesystem::path(bench.document.path()).replace_extension();
    std::string name;
    if (bench.pictures.turntable) {
        name = fmt::format("{}-turn-{:03}.png", stem.string(), bench.pictures.turntable->next);
    } else {
        for (int n = 1; name.empty() || std::filesystem::exists(name); ++n)
            name = fmt::format("{}-{}.png", stem.string(), n);
    }
    if (const Status s =
            writePng(bench.view.look.pane == Pane::Mesh ? bench.view.mesh.image() : bench.view.field.image(), name);
        !s)
        return s.error();
    bench.say("Wrote " + name);
    if (!bench.pictures.turntable) {
        bench.pictures.wanted = false;
        return true;
    }
    const int next = ++bench.pictures.turntable->next;
    bench.view.orbit.yaw = bench.pictures.turntable->yaw + 2 * pi * next / bench.pictures.turntable->count;
    if (next == bench.pictures.turntable->count) bench.pictures.turntable.reset();
    return true;
}

}  // namespace sgm::window
