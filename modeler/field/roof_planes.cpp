#include "modeler/field/roof_planes.h"

#include <cmath>

#include "modeler/plan/reflex.h"

namespace sgm::field {
namespace {

using plan::Linear;
using plan::PlacedEdge;

double valueAt(std::span<const Argument> arguments, size_t i) { return arguments[i].value[0]; }

void setGables(RoofPlanes& planes, const plan::Footprint& footprint, const plan::Formula& formula, double ends) {
    for (const uint32_t e : gablesOf(footprint, formula, static_cast<GableEnds>(static_cast<int>(ends))))
        planes.sides[e] = {};
}

}  // namespace

std::optional<RoofPlanes> roofPlanes(const Primitive& row, const plan::Footprint& footprint,
                                     const plan::Formula& formula, std::span<const Argument> a) {
    const std::vector<PlacedEdge> edges = plan::edgesOf(footprint);
    RoofPlanes planes;
    const bool isBroken = row.name == "mansardRoof" || row.name == "gambrelRoof";
    const bool isSaltbox = row.name == "saltboxRoof";
    if (!isBroken && !isSaltbox && row.name != "hipRoof" && row.name != "gableRoof" && row.name != "halfHipRoof")
        return std::nullopt;
    planes.sides.assign(edges.size(), {std::tan(valueAt(a, 0)), 0});
    const size_t overhang = isBroken ? 3 : isSaltbox ? 2 : 1;
    planes.overhang_m = valueAt(a, overhang);
    planes.fascia_m = valueAt(a, overhang + 1);
    if (isBroken) planes.highest_m = valueAt(a, 1);
    for (size_t i = 0; isSaltbox && i < edges.size(); ++i)
        planes.sides[i].slope = std::tan(valueAt(a, edges[i].normal().z > 0 ? 0 : 1));
    if (row.name == "gableRoof") setGables(planes, footprint, formula, valueAt(a, 4));
    if (row.name == "gambrelRoof") setGables(planes, footprint, formula, valueAt(a, 6));
    if (isSaltbox) setGables(planes, footprint, formula, valueAt(a, 5));
    if (row.name == "halfHipRoof")
        for (const uint32_t e : gablesOf(footprint, formula, static_cast<GableEnds>(static_cast<int>(valueAt(a, 4)))))
            planes.sides[e].rise = valueAt(a, 5) * planes.sides[e].slope * edges[e].length() / 2;
    return planes;
}

RoofSurface surfaceOf(const RoofPlanes& planes, const plan::Footprint& footprint, const plan::Formula& formula) {
    std::vector<Linear> outline = plan::distancesOf(footprint), slopes = outline;
    for (size_t i = 0; i < slopes.size(); ++i) {
        const RoofPlanes::Side& side = planes.sides[i];
        slopes[i] = side.slope > 0 ? Linear{slopes[i].a * side.slope, slopes[i].b * side.slope,
                                            slopes[i].c * side.slope - side.rise}
                                   : Linear{0, 0, -1e12};
    }
    return {formula, std::move(slopes), std::move(outline)};
}

}  // namespace sgm::field
