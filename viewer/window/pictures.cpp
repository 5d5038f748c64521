#include "viewer/window/pictures.h"

#include <fmt/format.h>

#include <chrono>

#include "modeler/core/conventions.h"

namespace sgm::window {

namespace {

/// The document's file without its ending.
std::string stemOf(const Workbench& bench) {
    const std::filesystem::path path = bench.document.path();
    return path.empty() ? "untitled" : std::filesystem::path(path).replace_extension().string();
}

/// The first of "STEM-1ENDING", "STEM-2ENDING" … that nothing is called.
std::string firstFree(const std::string& stem, std::string_view ending) {
    for (int n = 1;; ++n)
        if (std::string name = fmt::format("{}-{}{}", stem, n, ending); !std::filesystem::exists(name)) return name;
}

}  // namespace

void startTurntable(Workbench& bench, int count) {
    const std::string folder = firstFree(stemOf(bench) + "-turn", "");
    std::error_code failed;
    std::filesystem::create_directory(folder, failed);
    if (failed) return bench.say(fmt::format("can't make '{}': {}", folder, failed.message()), true);
    bench.pictures.turntable = Turntable{0, count, bench.view.orbit.yaw, folder};
}

namespace {

/// Beside the document: the turntable's next, or the first name that no file has.
std::string nextName(const Workbench& bench) {
    if (const auto& table = bench.pictures.turntable) return fmt::format("{}/{:03}.png", table->folder, table->next);
    return firstFree(stemOf(bench), ".png");
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
