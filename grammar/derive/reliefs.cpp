#include "grammar/derive/reliefs.h"

#include <algorithm>
#include <set>

#include "grammar/derive/lift.h"
#include "modeler/field/height_grid.h"
#include "modeler/town/terrain.h"

namespace sgm::derive {
namespace {

using plan::Vec2;

/// An object of its own that a relief lifts.
struct Lifted {
    ShapeId shape = none;
    uint32_t relief = none;
    std::optional<size_t> level;  ///< the area below it, of the terrain
};

/// By shape: the relief of the nearest one at or above it that has one.
std::vector<uint32_t> reliefsOf(const ShapeTree& tree) {
    std::vector<uint32_t> reliefs(tree.shapes.size(), none);
    for (ShapeId s = 0; s != none; s = tree.next(s)) {
        const Extras* extras = tree.extrasOf(s);
        const ShapeId parent = tree.shapes[s].parent;
        reliefs[s] = extras && extras->relief != none ? extras->relief : parent == none ? none : reliefs[parent];
    }
    return reliefs;
}

Vec2 inPlan(const Pose& frame, Vec3d p) {
    const Vec3d local = frame.axes.transposed() * (p - frame.origin);
    return {local.x, local.z};
}

/// The foot of a scope in the terrain's plan.
plan::Footprint footOf(const Scope& scope, const Pose& frame) {
    std::vector<Vec2> corners;
    for (const Vec3d& at : {Vec3d{-1, -1, -1}, Vec3d{1, -1, -1}, Vec3d{1, -1, 1}, Vec3d{-1, -1, 1}})
        corners.push_back(inPlan(frame, scope.point(at)));
    return plan::footprintOf(plan::polygonOf(std::move(corners)));
}

const town::HeightMap& mapOf(const town::TerrainLayers& layers, ReliefLayer layer) {
    return layer == ReliefLayer::Ground ? layers.ground : layer == ReliefLayer::Deck ? layers.deck : layers.water;
}

/// How high an object stands on an area that was levelled: where a road took a corner of it, hardly above that corner.
double footing(const town::HeightMap& ground, double level, const plan::Footprint& foot) {
    constexpr double most_m = 1, plinth_m = .3;  // that it sinks; that its foot may stand free at a corner
    double least = level;
    for (const plan::PlacedEdge& edge : plan::edgesOf(foot))
        for (const Vec2 p : {edge.from, (edge.from + edge.to) * .5}) least = std::min(least, ground.at(p));
    return std::clamp(least + plinth_m, level - most_m, level);
}

}  // namespace

void finishReliefs(Derivation& derivation) {
    if (derivation.reliefs.empty()) return;
    ShapeTree& tree = derivation.tree;
    const std::vector<uint32_t> reliefs = reliefsOf(tree);
    std::vector<Lifted> lifted;
    for (const Placement& placement : placementsOf(derivation)) {
        if (reliefs[placement.shape] == none) continue;
        Lifted& one = lifted.emplace_back(Lifted{placement.shape, reliefs[placement.shape], std::nullopt});
        const Relief& relief = derivation.reliefs[one.relief];
        if (relief.layer == ReliefLayer::Ground)
            one.level = relief.terrain->level(footOf(tree.shapes[one.shape].scope, relief.frame));
    }
    std::set<const town::Terrain*> finished;
    for (Relief& relief : derivation.reliefs) {
        if (finished.insert(relief.terrain.get()).second) relief.terrain->finish();
        const town::HeightMap& map = mapOf(relief.terrain->layers(), relief.layer);
        if (!map.empty())
            relief.heights = field::heightGrid(static_cast<float>(map.low.x), static_cast<float>(map.low.z),
                                               static_cast<float>(map.cell_m), map.columns, map.rows, map.heights);
    }
    for (const Lifted& one : lifted) {
        const Relief& relief = derivation.reliefs[one.relief];
        if (!relief.heights) continue;
        const Scope& scope = tree.shapes[one.shape].scope;
        const town::HeightMap& map = mapOf(relief.terrain->layers(), relief.layer);
        tree.extras[tree.shapes[one.shape].extras].lift_m =
            one.level ? footing(map, relief.terrain->levelOf(*one.level), footOf(scope, relief.frame))
                      : map.at(inPlan(relief.frame, scope.centre));
    }
}

double liftOf(const Derivation& derivation, ShapeId shape) {
    if (derivation.reliefs.empty()) return 0;
    const Vec3d centre = derivation.tree.shapes[shape].scope.centre;
    for (; shape != none; shape = derivation.tree.shapes[shape].parent) {
        const Extras* extras = derivation.tree.extrasOf(shape);
        if (!extras || extras->relief == none) continue;
        const Relief& relief = derivation.reliefs[extras->relief];
        const Vec2 at = inPlan(relief.frame, centre);
        return relief.heights ? static_cast<double>(field::heightAt(*relief.heights, static_cast<float>(at.x),
                                                                    static_cast<float>(at.z)))
                              : 0;
    }
    return 0;
}

Scope liftedScope(const Derivation& derivation, ShapeId shape) {
    Scope scope = derivation.tree.shapes[shape].scope;
    scope.centre.y += liftOf(derivation, shape);
    return scope;
}

}  // namespace sgm::derive
