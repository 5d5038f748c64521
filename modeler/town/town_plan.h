// The plan of a town as files for other programs.
// Enters: features with areas. Leaves: the bytes of an SVG or GeoJSON file, the same everywhere. Assumes sound areas.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::town {

/// One area of the plan.
struct PlanFeature {
    std::string
        layer;  ///< a part of the plan: highway, street, bridge, crossing, block, lot, corner, inner, water, park
    plan::Footprint area;  ///< metres, x east, z south
    uint64_t key = 0;      ///< tells it from the others of its layer and stays when others change; 0: none
    double street_m = 0;   ///< of a lot: metres along streets
};

/// All of it, in the order of drawing.
struct TownPlan {
    std::vector<PlanFeature> features;
    bool empty() const { return features.empty(); }
};

/// Takes a text piece by piece, front to back.
using TextSink = std::function<void(std::string_view)>;

/// Metres as user units, x right and z down; a group a layer, with its name as class. `write` gets a piece an area, so
/// that no plan is held as a text.
void writeSvg(const TownPlan& plan, const TextSink& write);
/// RFC 7946 in form, with metres for coordinates (x east, z south turned to north) as `readGeoJson` takes them: a
/// feature an area, with layer, key, area and the length along streets. `write` gets a piece a feature.
void writeGeoJson(const TownPlan& plan, const TextSink& write);

}  // namespace sgm::town
