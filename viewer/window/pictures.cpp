#include "viewer/window/pictures.h"

#include <fmt/format.h>

#include <chrono>

#include "modeler/core/conventions.h"

namespace sgm::window {

void startTurntable(Workbench& bench, int count) {
    bench.pictures.turntable = Turntable{0, count, bench.view.orbit.yaw};
}

namespace {

/// Beside the document: the turntable's next, or the first name that no file has.
std::string nextName(const Workbench& bench) {
    const std::filesystem::path stem =
        bench.document.path().empty() ? "untitled" : std::filesystem::path(bench.document.path()).replace_extension();
    if (bench.pictures.turntable)
        return fmt::format("{}-turn-{:03}.png", stem.string(), bench.pictures.turntable->next);
    for (int n = 1;; ++n)
        if (const std::string name = fmt::format("{}-{}.png", stem.string(), n); !std::filesystem::exists(name))
            return name;
}

}  // namespace

Result<bool> takePictures(Workbench& bench) {
    Pictures& pictures = bench.pictures;
    if (pictures.writing.valid()) {
        if (pictures.writing.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
        if (const Status s = pictures.writing.get(); !s) {
            pictures.turntable.reset();  // the rest would fail as well
            return s.error();
        }
        bench.say("Wrote " + pictures.name);
        return true;
    }
    const bool isMesh = bench.view.look.pane == Pane::Mesh;
    const bool whole = isMesh ? bench.view.mesh.visible() && bench.view.mesh.finished() : bench.view.field.finished();
    if (!whole || (!pictures.wanted && !pictures.turntable)) return false;
    pictures.name = nextName(bench);
    // Packing takes longer than a user should wait for an answer.
    pictures.writing =
        std::async(std::launch::async, [image = isMesh ? bench.view.mesh.image() : bench.view.field.image(),
                                        name = pictures.name] { return writePng(image, name); });
    if (!pictures.turntable) {
        pictures.wanted = false;
        return true;
    }
    const int next = ++pictures.turntable->next;
    bench.view.orbit.yaw = pictures.turntable->yaw + 2 * pi * next / pictures.turntable->count;
    if (next == pictures.turntable->count) pictures.turntable.reset();
    return true;
}

}  // namespace sgm::window
