#include "viewer/window/camera_keys.h"
#include "viewer/window/framing.h"

#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "modeler/core/conventions.h"

namespace sgm::window {
namespace {

constexpr double eyeHeight_m = 1.7, step_m = 1, walk_m = 1.8;  // of a visitor who walks, the last in a second
constexpr double run = 5;                                      // times as fast, with Shift

/// What is held of two keys that do the opposite: −1, 0 or 1.
double held(const Workbench& bench, char less, char more) {
    const auto down = [&](char key) {
        const bool isFree = bench.panels.hotkeys.find(static_cast<char>(std::tolower(key))) == std::string::npos;
        return isFree && ImGui::IsKeyDown(key) ? 1.0 : 0.0;
    };
    return down(more) - down(less);
}

void orbitByKeys(Workbench& bench, double seconds) {
    Orbit& orbit = bench.view.orbit;
    orbit.turn(held(bench, 'D', 'A') * seconds / 2, held(bench, 'S', 'W') * seconds / 2);
    const double wider = held(bench, 'Q', 'E') * seconds;
    if (wider != 0) orbit.fieldOfView = std::clamp(orbit.fieldOfView * std::exp(wider), radians(5), radians(120));
}

/// A visitor walks as fast as a person, or runs; the ground carries the eye.
void travel(Workbench& bench, double seconds) {
    Orbit& orbit = bench.view.orbit;
    const bool walks = bench.view.look.motion == Motion::Walk;
    const double span_m = static_cast<double>(length(bounds(bench).size()));
    const double pace_m = seconds * (walks ? walk_m : std::max(1.4, span_m / 8)) * (ImGui::GetIO().KeyShift ? run : 1);
    const double right = held(bench, 'A', 'D'), ahead = held(bench, 'S', 'W'), up = walks ? 0 : held(bench, 'Q', 'E');
    if (right == 0 && ahead == 0 && up == 0) return;
    orbit.walk(right * pace_m, up * pace_m, ahead * pace_m, walks);
    if (!walks) return;
    const Vec3d eye = orbit.eye();
    if (const auto ground = groundBelow(bench, eye + Vec3d{0, step_m, 0}))
        orbit.walk(0, *ground + eyeHeight_m - eye.y, 0, true);
}

}  // namespace

void cameraKeys(Workbench& bench) {
    bool pressedNow = false;
    for (const char key : std::string_view("WASDQEK")) pressedNow |= ImGui::IsKeyPressed(key, false);
    const double seconds = secondsHeld(ImGui::GetIO().DeltaTime, pressedNow);
    bench.view.look.motion == Motion::Orbit ? orbitByKeys(bench, seconds) : travel(bench, seconds);
    const bool isFree = bench.panels.hotkeys.find('k') == std::string::npos;
    if (isFree && ImGui::IsKeyDown('K'))
        bench.view.orbit.approach(std::exp(ImGui::GetIO().KeyShift ? seconds : -seconds));
}

}  // namespace sgm::window
