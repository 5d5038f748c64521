#include "grammar/operations/network_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "modeler/town/grow.h"

namespace sgm::operations {

using derive::ReliefLayer;
using derive::Scope;
using plan::Vec2;
using rules::Expr;

namespace {

/// The numbers of all maps that an expression asks, those that maps ask among them.
void addMaps(const rules::Grammar& grammar, const Expr& e, std::set<uint32_t>& maps) {
    if (e.kind == Expr::Kind::Map && maps.insert(e.index).second && grammar.maps[e.index].formula)
        addMaps(grammar, *grammar.maps[e.index].formula, maps);
    for (const Expr& arg : e.args) addMaps(grammar, arg, maps);
}

/// The ground that the scope stands on: half its extent along x and z, and its middle.
struct Area {
    Vec2 middle, half;
};
Area areaOf(const Scope& scope) {
    const Vec3d h = scope.half();
    return {{scope.centre.x, scope.centre.z},
            {std::abs(scope.axes.x.x) * h.x + std::abs(scope.axes.z.x) * h.z,
             std::abs(scope.axes.x.z) * h.x + std::abs(scope.axes.z.z) * h.z}};
}

/// About where roads begin, unless they are told: where most pulls them.
Vec2 strongest(const town::RoadParameters& parameters, const town::Land& land) {
    constexpr int steps = 64;
    Vec2 found = (parameters.lo + parameters.hi) * .5;
    double most = land.pull ? land.pull(found) : 0;
    for (int k = 1; land.pull && k < steps; ++k)
        for (int i = 1; i < steps; ++i) {
            const Vec2 size = parameters.hi - parameters.lo;
            const Vec2 p = parameters.lo + Vec2{size.x * i / steps, size.z * k / steps};
            if (const double pull = land.pull(p); pull > most) most = pull, found = p;
        }
    return found;
}

}  // namespace

void warnOfUncovered(derive::PartsContext& context, const rules::Roads& roads) {
    const rules::Grammar& grammar = context.grammar();
    const Area area = areaOf(context.scope());
    const double x = std::abs(area.middle.x) + area.half.x, z = std::abs(area.middle.z) + area.half.z;
    for (const auto* setting : {&roads.pull, &roads.spread, &roads.water, &roads.park, &roads.height}) {
        if (!*setting) continue;
        std::set<uint32_t> maps;
        addMaps(grammar, **setting, maps);
        for (const uint32_t index : maps) {
            const rules::Map& map = grammar.maps[index];
            if (!map.picture.raster) continue;
            const Vec2 half = map.picture.over_m * .5;
            if (half.x >= x - 1e-6 && half.z >= z - 1e-6) continue;
            context.warn(
                map.span,
                fmt::format(
                    "the map '{}' covers {:.6g} m by {:.6g} m about (0, 0), but the network reaches {:.6g} m and "
                    "{:.6g} m from there: outside, its border goes on",
                    map.name, 2 * half.x, 2 * half.z, x, z),
                fmt::format("write 'over ({:.6g}m, {:.6g}m)', or make the scope of the network smaller", 2 * x, 2 * z));
        }
    }
}

bool NetworkTerrain::survey(const town::RoadParameters& parameters, town::Land& land) {
    if (!land.height) return true;
    const syntax::SourceSpan at = roads_.height->span;
    if (context_.scope().axes.y.y < 1 - 1e-9)
        return context_.fail("the heights of a network lift it straight up, but its scope leans; turn it about y alone",
                             at);
    auto surveyed = town::Terrain::survey(parameters, land, context_.progress());
    if (!surveyed.ok()) return context_.fail(surveyed.error(), at);
    terrain_ = std::make_shared<town::Terrain>(std::move(*surveyed));
    if (terrain_->isLevel())
        context_.warn(at, "the ground is equally high everywhere, so that 'height' lifts nothing",
                      "leave it out, or give the map a range such as 'as 0m..80m'");
    land.height = [terrain = terrain_](Vec2 p) { return terrain->naturalAt(p); };
    return true;
}

void NetworkTerrain::grade(const town::RoadGraph& graph, const town::RoadParameters& parameters) {
    if (!terrain_) return;
    terrain_->grade(graph);
    const town::Terrain::Steepest steepest = terrain_->steepest();
    if (steepest.slope > parameters.slope * 1.01 + 1e-6)
        context_.warn(roads_.height->span,
                      fmt::format("a road at ({:.0f}, {:.0f}) rises by {:.1f}%, more than 'slope', {:.1f}%: roads or a "
                                  "bridge hold both of its ends",
                                  steepest.at.x, steepest.at.z, 100 * steepest.slope, 100 * parameters.slope),
                      "raise 'slope', or let the heights vary less");
}

std::string NetworkTerrain::obstacle(const town::RoadParameters& parameters, const town::Land& land) const {
    if (!terrain_) return {};
    const Vec2 from = parameters.from.value_or(strongest(parameters, land));
    const double slope = terrain_->leastRise(from, parameters.step_m);
    if (slope > parameters.slope)
        return fmt::format(
            "no road grows here: the ground rises by at least {:.0f}% in all directions, more than 'slope', "
            "{:.0f}%",
            100 * slope, 100 * parameters.slope);
    // Some ways are gentle enough, but roads begin along an axis and turn by less than to there.
    town::Land level = land;
    level.height = nullptr;
    town::RoadParameters few = parameters;
    few.limit = 4;  // whether any grow
    const auto grown = town::growRoads(few, level, context_.progress());
    if (grown.ok() ? grown->edges().empty() : grown.error().kind != Error::Kind::Budget) return {};
    return fmt::format(
        "no road grows here: at ({:.0f}, {:.0f}), where roads begin, the ground rises by more than 'slope', {:.0f}%, "
        "along all ways that they try",
        from.x, from.z, 100 * parameters.slope);
}

uint32_t NetworkTerrain::reliefOf(const std::string& layer) {
    if (!terrain_) return derive::none;
    const ReliefLayer which = layer == "bridge" || layer == "tunnel" || layer == "bore" ? ReliefLayer::Deck
                              : layer == "water"                                        ? ReliefLayer::Water
                                                                                        : ReliefLayer::Ground;
    uint32_t& relief = reliefs_[static_cast<size_t>(which)];
    const Scope& scope = context_.scope();
    if (relief == derive::none) relief = context_.addRelief({terrain_, which, {scope.centre, scope.axes}, nullptr});
    return relief;
}

}  // namespace sgm::operations
