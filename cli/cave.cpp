#include "cli/cave.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "modeler/eval/evaluate.h"

namespace sgm::cli {
namespace {

using Json = nlohmann::ordered_json;
using volume::Cave;

/// The tag that `walk none` gives a shape.
constexpr std::string_view walkNone = "walk none";
constexpr const char* faces[6] = {"+x", "-x", "+y", "-y", "+z", "-z"};

Json place(Vec3f p) { return {p.x, p.y, p.z}; }
std::string placeText(Vec3f p) { return fmt::format("({:.1f}, {:.1f}, {:.1f})", p.x, p.y, p.z); }

template <class List, class ToJson>
Json listOf(const List& list, ToJson toJson) {
    Json all = Json::array();
    for (const auto& item : list) all.push_back(toJson(item));
    return all;
}

/// At most this many rows of a kind in the table; the JSON has all.
constexpr size_t mostRows = 8;

template <class List, class ToText>
void rows(std::string& out, const char* title, const List& list, ToText toText) {
    for (size_t i = 0; i < std::min(list.size(), mostRows); ++i)
        out += fmt::format("  {:<16}{}\n", i ? "" : title, toText(list[i], i));
    if (list.size() > mostRows) out += fmt::format("  {:<16}and {} more\n", "", list.size() - mostRows);
}

const char* plural(size_t n) { return n == 1 ? "" : "s"; }

}  // namespace

Result<volume::Agent> parseAgent(const std::string& text) {
    volume::Agent agent;
    double slope_deg = degrees(agent.slope_rad);
    int used = 0, all = static_cast<int>(text.size());
    const auto whole = [&](int wanted, int got) { return got == wanted && used == all; };
    if (!whole(2, std::sscanf(text.c_str(), "%lf,%lf%n", &agent.radius_m, &agent.height_m, &used)) &&
        !whole(3, std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &agent.radius_m, &agent.height_m, &slope_deg, &used)))
        return Error{
            Error::Kind::Usage,
            fmt::format("--agent {}: write RADIUS,HEIGHT or RADIUS,HEIGHT,SLOPE in metres and degrees, as .3,1.8,45",
                        text)};
    agent.slope_rad = radians(slope_deg);
    return agent;
}

volume::FloorFilter floorFilter(const pipeline::Model& model) {
    const derive::ShapeTree& tree = model.derivation.tree;
    std::vector<bool> refused(tree.shapes.size(), false);
    bool any = false;
    for (derive::ShapeId id = 0; id < tree.shapes.size(); ++id) {
        const auto* extras = tree.extrasOf(id);
        const derive::ShapeId parent = tree.shapes[id].parent;
        refused[id] = (parent != derive::none && refused[parent]) ||
                      (extras && std::ranges::find(extras->tags, walkNone) != extras->tags.end());
        any = any || refused[id];
    }
    if (!any) return {};
    return [&model, refused](std::span<const Vec3f> places) {
        std::vector<float> x, y, z;
        for (const Vec3f p : places) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
        std::vector<OriginId> origins(places.size());
        eval::Workspace workspace;
        eval::evaluateOrigin(model.tape, {x.data(), y.data(), z.data(), x.size()}, origins.data(), workspace);
        std::vector<bool> kept;
        for (const OriginId origin : origins) {
            const derive::ShapeId shape = model.lowered->shapeOf[origin];
            kept.push_back(shape == derive::none ? !refused[0] : !refused[shape]);
        }
        return kept;
    };
}

Result<Survey> surveyFor(const SurveyRequest& request, const exporter::ExportInput& input) {
    const auto agent = request.agent.empty() ? volume::Agent{} : parseAgent(request.agent);
    if (!agent.ok()) return agent.error();
    auto cave = volume::surveyCave(*input.volume, *agent, request.flipNormals, input.progress, request.isFloor);
    if (!cave.ok()) return cave.error();
    Survey made{std::move(*cave), {}};
    if (request.floor.empty()) return made;
    made.floor = volume::walkableFloor(*input.mesh, made.cave);
    if (made.floor.triangleCount() == 0)
        return Error{Error::Kind::Input, fmt::format("--floor {}: the agent can stand nowhere", request.floor)};
    return made;
}

Status writeFloor(const std::string& file, exporter::ExportInput input, const mesh::Mesh& floor) {
    input.mesh = &floor;
    input.colliders = {};
    input.levels = {};
    input.objects = nullptr;
    input.name += "-floor";
    return exporter::write(input, file);
}

Json caveJson(const Cave& cave) {
    Json json;
    json["agent"] = {{"radius_m", cave.agent.radius_m},
                     {"height_m", cave.agent.height_m},
                     {"slope_deg", degrees(cave.agent.slope_rad)},
                     {"step_m", cave.agent.step_m()}};
    json["voxel_m"] = cave.voxel_m;
    json["air_m3"] = cave.air_m3;
    json["spaces"] = listOf(cave.spaces, [](const volume::Space& s) {
        return Json{{"volume_m3", s.volume_m3}, {"rooms", s.rooms}, {"entrances", s.entrances}};
    });
    json["pockets"] = cave.pockets;
    json["rooms"] = listOf(cave.rooms, [](const volume::Room& r) {
        return Json{{"at", place(r.at)}, {"radius_m", r.radius_m}, {"space", r.space}};
    });
    json["passages"] = listOf(cave.passages, [](const volume::Passage& p) {
        return Json{{"rooms", {p.rooms[0], p.rooms[1]}},
                    {"at", place(p.at)},
                    {"radius_m", p.radius_m},
                    {"passable", p.passable}};
    });
    json["entrances"] = listOf(cave.entrances, [](const volume::Entrance& e) {
        return Json{{"face", faces[e.face]},          {"at", place(e.at)},
                    {"area_m2", e.area_m2},           {"radius_m", e.radius_m},
                    {"bottleneck_m", e.bottleneck_m}, {"space", e.space}};
    });
    if (std::isfinite(cave.narrowest_m())) json["narrowest_m"] = cave.narrowest_m();
    for (size_t k = 0; k < 4; ++k)
        json["floor_m2"][fmt::format("to_{}_deg", Cave::slopeClasses_deg[k])] = cave.floor_m2[k];
    if (const auto& height = cave.headroom; height.greatest_m > 0)
        json["headroom_m"] = {{"least", height.least_m}, {"median", height.median_m}, {"greatest", height.greatest_m}};
    else
        json["headroom_m"] = nullptr;
    json["walkable"] = {{"area_m2", cave.walkable_m2}, {"parts", cave.walkParts}, {"reachable_m2", cave.reachable_m2}};
    json["longest_path_m"] = cave.longestPath_m;
    json["longest_walk_m"] = cave.longestWalk_m;
    return json;
}

std::string caveTable(const Cave& cave) {
    std::string out = fmt::format("cave, for an agent of radius {:.4g} m and height {:.4g} m, voxels of {:.3g} m\n",
                                  cave.agent.radius_m, cave.agent.height_m, cave.voxel_m);
    const auto row = [&](const char* title, const std::string& text) {
        out += fmt::format("  {:<16}{}\n", title, text);
    };
    row("air", fmt::format("{:.4g} m³, {} space{}{}", cave.air_m3, cave.spaces.size(), plural(cave.spaces.size()),
                           cave.pockets ? fmt::format(" and {} pocket{} too small for the agent", cave.pockets,
                                                      plural(cave.pockets))
                                        : ""));
    rows(out, "rooms", cave.rooms, [](const volume::Room& r, size_t i) {
        return fmt::format("{}: radius {:.2f} m at {}", i, r.radius_m, placeText(r.at));
    });
    rows(out, "passages", cave.passages, [](const volume::Passage& p, size_t) {
        return fmt::format("{} – {}: radius {:.2f} m at {}{}", p.rooms[0], p.rooms[1], p.radius_m, placeText(p.at),
                           p.passable ? "" : ", too narrow");
    });
    rows(out, "entrances", cave.entrances, [](const volume::Entrance& e, size_t) {
        return fmt::format("{}: {:.4g} m² at {}, narrowest way in {:.2f} m", faces[e.face], e.area_m2, placeText(e.at),
                           e.bottleneck_m);
    });
    if (std::isfinite(cave.narrowest_m())) row("narrowest", fmt::format("{:.2f} m", cave.narrowest_m()));
    std::string floor;
    for (size_t k = 0; k < 4; ++k)
        floor += fmt::format("{}{:.4g} m² to {}°", k ? ", " : "", cave.floor_m2[k], Cave::slopeClasses_deg[k]);
    row("floor", floor);
    if (const auto& height = cave.headroom; height.greatest_m > 0)
        row("headroom", fmt::format("{:.2f} m at least, {:.2f} in the middle, {:.2f} at most", height.least_m,
                                    height.median_m, height.greatest_m));
    else
        row("headroom", "no floor lies under a roof");
    row("walkable", fmt::format("{:.4g} m² in {} part{}, {:.4g} m² of it reachable", cave.walkable_m2, cave.walkParts,
                                plural(cave.walkParts), cave.reachable_m2));
    row("longest way",
        fmt::format("{:.1f} m through the air, {:.1f} m on foot", cave.longestPath_m, cave.longestWalk_m));
    return out;
}

}  // namespace sgm::cli
