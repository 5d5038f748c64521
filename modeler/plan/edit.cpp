#include "modeler/plan/edit.h"

#include "modeler/plan/clipper_paths.h"
#include "modeler/plan/crossings.h"
#include "modeler/plan/edge_match.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

constexpr double farthest_m = 1e5;

/// The sources of two operands in the tags of `result`; those of the second become cuts where they cut.
std::vector<SourceEdge> sourcesOfBoth(Footprint& result, Boolean how, const Footprint& a, const Footprint& b) {
    result.tags = a.tags;
    const std::vector<uint32_t> renumbered = addTags(result, b.tags);
    std::vector<SourceEdge> sources = sourcesOf(a);
    for (SourceEdge s : sourcesOf(b)) {
        s.edge.tag = s.edge.tag < renumbered.size() ? renumbered[s.edge.tag] : 0;
        if (how != Boolean::Union) s.edge.source = EdgeSource::Cut;
        sources.push_back(s);
    }
    return sources;
}

PathBoolean pathBoolean(Boolean how) {
    switch (how) {
        case Boolean::Difference:
            return PathBoolean::Difference;
        case Boolean::Intersection:
            return PathBoolean::Intersection;
        case Boolean::Union:
            break;
    }
    return PathBoolean::Union;
}

/// Of sound footprints, so that edges cross those of the other one alone.
bool crossTooOften(const Footprint& a, const Footprint& b) {
    if (a.edgeCount() * b.edgeCount() <= mostCrossings) return false;
    Footprint both = a;
    both.polygons.insert(both.polygons.end(), b.polygons.begin(), b.polygons.end());
    return countCrossings(both, mostCrossings) > mostCrossings;
}

}  // namespace

Footprint boolean(Boolean how, const Footprint& a, const Footprint& b) {
    if (b.empty() && how != Boolean::Intersection) return a;
    Footprint result = booleanOf(pathBoolean(how), pathsOf(a), pathsOf(b));
    const std::vector<SourceEdge> sources = sourcesOfBoth(result, how, a, b);
    matchEdges(result, sources);
    return tidied(std::move(result));
}

Result<Footprint> booleanInBudget(Boolean how, const Footprint& a, const Footprint& b) {
    if (crossTooOften(a, b))
        return Error{Error::Kind::Budget, "the outlines cross each other more than " + std::to_string(mostCrossings) +
                                              " times: draw them with fewer points"};
    return boolean(how, a, b);
}

bool shareArea(const Footprint& a, const Footprint& b, double least_m2) {
    return crossTooOften(a, b) || area(boolean(Boolean::Intersection, a, b)) > least_m2;
}

Result<Footprint> resolved(const Footprint& footprint) {
    size_t number = 0;
    for (const PlacedEdge& e : edgesOf(footprint)) {
        ++number;
        if (!(std::abs(e.from.x) <= farthest_m && std::abs(e.from.z) <= farthest_m))
            return Error{Error::Kind::Input, "point " + std::to_string(number) +
                                                 " of the outline is no number, or more than 100 km from the origin"};
    }
    if (countCrossings(footprint, mostCrossings) > mostCrossings)
        return Error{Error::Kind::Budget,
                     "the outline crosses itself more than " + std::to_string(mostCrossings) + " times"};
    Footprint result = booleanOf(PathBoolean::Union, pathsOf(footprint), {});
    result.tags = footprint.tags;
    matchEdges(result, sourcesOf(footprint));
    return tidied(std::move(result));
}

Footprint offset(const Footprint& footprint, double distance_m) {
    if (distance_m == 0 || footprint.empty()) return footprint;
    Footprint result = offsetOf(pathsOf(footprint), distance_m);
    result.tags = footprint.tags;
    matchEdges(result, sourcesOf(footprint, std::vector<double>(footprint.edgeCount(), distance_m)));
    return tidied(std::move(result));
}

Footprint rim(const Footprint& footprint, double width_m) {
    return boolean(Boolean::Difference, footprint, offset(footprint, -width_m));
}

std::optional<Footprint> court(const Footprint& footprint, double wing_m) {
    if (!(wing_m > 0)) return std::nullopt;
    const Footprint inner = offset(footprint, -wing_m);
    if (inner.empty()) return std::nullopt;
    Footprint result = booleanOf(PathBoolean::Difference, pathsOf(footprint), pathsOf(inner));
    result.tags = footprint.tags;
    const Edge made{result.tag("court"), EdgeSource::Court};
    std::vector<SourceEdge> sources = sourcesOf(footprint);
    for (SourceEdge s : sourcesOf(inner)) {
        s.edge = made;
        sources.push_back(s);
    }
    matchEdges(result, sources);
    return tidied(std::move(result));
}

}  // namespace sgm::plan
