// Judges footprints and repairs what can be repaired without changing their form.
// Enters: any numbers. Leaves: the first fault with its place, or nothing. Assumes nothing.
// Whether edges cross is decided exactly on a lattice of 2⁻²⁰ m, to which every point is rounded first.
#pragma once

#include <optional>
#include <string>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// What footprints may be.
struct Limits {
    double leastEdge_m = 1e-3;   ///< shorter edges are faults
    double leastArea_m2 = 1e-6;  ///< smaller rings are faults
    double farthest_m = 1e5;     ///< of a coordinate from 0
    size_t mostPoints = 100'000;
};

enum class FaultKind : uint8_t {
    Empty,          ///< no polygon, or a ring without points
    TooManyPoints,  ///< in all rings together
    NotFinite,      ///< a coordinate is no number, or infinite
    TooFar,         ///< a coordinate beyond Limits::farthest_m
    TooFewPoints,   ///< a ring of fewer than three
    EdgeList,       ///< not as many edges as points, or a tag that isn't in the list
    SamePoint,      ///< an edge's ends are one point
    ShortEdge,      ///< an edge shorter than Limits::leastEdge_m
    Crossing,       ///< two edges cross, touch or run over each other
    NoArea,         ///< a ring around less than Limits::leastArea_m2
    WrongWay,       ///< an outer ring clockwise or a court counter-clockwise
    CourtOutside,   ///< a court that lies outside its outline or in another court
    Overlap         ///< a polygon in another one
};

/// A fault and where it is. Numbers count from 0.
struct Fault {
    FaultKind kind = FaultKind::Empty;
    size_t polygon = 0, ring = 0, edge = 0;                 ///< ring 0 is the outline
    size_t otherPolygon = 0, otherRing = 0, otherEdge = 0;  ///< of Crossing, CourtOutside and Overlap
    Vec2 at;                                                ///< metres, near the fault
};

/// The first fault in the order of FaultKind, and there in the order of edges; nothing for a sound footprint.
/// O(n log n + p), p the pairs of edges whose x-ranges meet; n² at worst, .2 s for 10⁴ edges that all do.
std::optional<Fault> firstFault(const Footprint& footprint, const Limits& limits = {});

/// "edge 3 of the outline crosses edge 7 near (4.2, 1): …", one sentence with the hint; edges are counted from 1, and
/// polygons and courts named where there are more than one.
std::string sentenceOf(const Fault& fault, const Footprint& footprint);

/// The footprint itself where it is sound, else Error::Input with the sentence of its first fault.
Result<Footprint> checked(Footprint footprint, const Limits& limits = {});

/// The same outline without points nearer than `near_m` to the one before, without points that lie within `straight_m`
/// of the line through their neighbours where both edges are alike, and with every ring in its sense. Rings that lose
/// their area go. Crossings stay. O(n).
Footprint cleaned(const Footprint& footprint, double near_m = 1e-3, double straight_m = 1e-3);

}  // namespace sgm::plan
