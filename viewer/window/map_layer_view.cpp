#include "viewer/window/map_layer_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "viewer/document/plan_handles.h"
#include "viewer/window/overlay.h"
#include "viewer/window/widgets.h"
#include "viewer/window/workbench.h"

namespace sgm::window {
namespace {

constexpr uint32_t cells = 96;  // along the longer side
constexpr float opacity = .55f;

/// From dark to light, evenly to the eye.
ImU32 ramp(float share) {
    constexpr std::array<std::array<float, 3>, 5> stops{
        {{.27f, .00f, .33f}, {.23f, .32f, .55f}, {.13f, .57f, .55f}, {.37f, .79f, .38f}, {.99f, .91f, .14f}}};
    const float at = std::clamp(share, 0.0f, 1.0f) * (stops.size() - 1);
    const size_t low = std::min(static_cast<size_t>(at), stops.size() - 2);
    const float t = at - static_cast<float>(low);
    const auto mixed = [&](size_t c) { return stops[low][c] * (1 - t) + stops[low + 1][c] * t; };
    return ImGui::ColorConvertFloat4ToU32({mixed(0), mixed(1), mixed(2), opacity});
}

ImU32 hue(float number) {
    float r, g, b;
    ImGui::ColorConvertHSVtoRGB(number * .381966f - std::floor(number * .381966f), .55f, .9f, r, g, b);
    return ImGui::ColorConvertFloat4ToU32({r, g, b, opacity});
}

}  // namespace

bool MapLayerView::choose(Workbench& bench) {
    if (!bench.shown() || bench.shown()->grammar->maps.empty()) return false;
    std::vector<std::string> names{"No map"};
    int at = 0;
    for (const rules::Map& map : bench.shown()->grammar->maps) {
        if (map.name == chosen_) at = static_cast<int>(names.size());
        names.push_back(map.name);
    }
    if (widgets::choice(bench.report, "look.map", names, at, ImGui::GetFontSize() * 7)) {
        chosen_ = at == 0 ? "" : names[static_cast<size_t>(at)];
        shown_.reset();
    }
    widgets::hint("A map of the grammar over the ground");
    return true;
}

ImU32 MapLayerView::colorOf(float value) const {
    if (!layer_.words.empty()) return hue(value);
    return ramp(layer_.most > layer_.least ? (value - layer_.least) / (layer_.most - layer_.least) : 0);
}

void MapLayerView::draw(Workbench& bench, const Projection& project, ImDrawList& list) {
    if (chosen_.empty() || !bench.shown()) return;
    const derive::Derivation& derivation = bench.shown()->model.derivation;
    const auto& maps = derivation.grammar->maps;
    const auto map = std::find_if(maps.begin(), maps.end(), [&](const rules::Map& m) { return m.name == chosen_; });
    if (map == maps.end()) return;
    if (shown_.lock() != bench.session.model()) {
        const derive::Scope& ground = derivation.tree.shapes[document::widestShape(derivation.tree)].scope;
        const Vec3d h = ground.half(), c = ground.centre;
        const plan::Box2 area{{c.x - h.x, c.z - h.z}, {c.x + h.x, c.z + h.z}};
        height_m_ = c.y + h.y;
        const double cell_m = std::max(area.size().x, area.size().z) / cells;
        auto asked = derive::mapLayer(derivation, static_cast<uint32_t>(map - maps.begin()), area,
                                      static_cast<uint32_t>(std::ceil(area.size().x / cell_m)),
                                      static_cast<uint32_t>(std::ceil(area.size().z / cell_m)));
        shown_ = bench.session.model();
        layer_ = asked.ok() ? std::move(*asked) : derive::MapLayer{};
        if (!asked.ok()) bench.say(asked.error().message, true);
    }
    std::vector<std::optional<ImVec2>> corners;
    for (uint32_t row = 0; row <= layer_.rows; ++row)
        for (uint32_t column = 0; column <= layer_.columns; ++column)
            corners.push_back(
                project({layer_.area.lo.x + layer_.area.size().x * column / std::max(1u, layer_.columns), height_m_,
                         layer_.area.lo.z + layer_.area.size().z * row / std::max(1u, layer_.rows)}));
    const auto corner = [&](uint32_t column, uint32_t row) { return corners[row * (layer_.columns + 1) + column]; };
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // seams would show between quads
    for (uint32_t row = 0; row < layer_.rows; ++row)
        for (uint32_t column = 0; column < layer_.columns; ++column) {
            const auto a = corner(column, row), b = corner(column + 1, row), c = corner(column + 1, row + 1),
                       d = corner(column, row + 1);
            if (a && b && c && d)
                list.AddQuadFilled(*a, *b, *c, *d, colorOf(layer_.values[row * layer_.columns + column]));
        }
    list.Flags = flags;
    legend(project, list);
}

void MapLayerView::legend(const Projection& project, ImDrawList& list) const {
    const float line = ImGui::GetTextLineHeightWithSpacing(), side = ImGui::GetFontSize() * .8f;
    ImVec2 at(project.low.x + 14, project.low.y + 14);
    const auto rows = static_cast<float>(layer_.words.empty() ? 2 : layer_.words.size());
    list.AddRectFilled({at.x - 8, at.y - 8}, {at.x + 9 * ImGui::GetFontSize(), at.y + rows * line + 4},
                       IM_COL32(20, 22, 26, 170), 4);
    const auto row = [&](ImU32 color, const std::string& text) {
        list.AddRectFilled(at, {at.x + side, at.y + side}, color | 0xff000000);
        list.AddText({at.x + side + 6, at.y - 2}, IM_COL32(240, 240, 235, 255), text.c_str());
        at.y += line;
    };
    if (layer_.words.empty()) {
        row(ramp(1), fmt::format("{:.4g}", layer_.most));
        row(ramp(0), fmt::format("{:.4g}", layer_.least));
    }
    for (size_t i = 0; i < layer_.words.size(); ++i) row(hue(static_cast<float>(i)), layer_.words[i]);
}

}  // namespace sgm::window
