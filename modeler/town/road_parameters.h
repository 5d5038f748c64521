// How roads grow, as numbers and choices: what a grammar sets and `growRoads` follows.
// Enters: nothing. Leaves: plain values; the defaults are ours, for paper A prints none. Assumes metres and radians.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "modeler/plan/polygon.h"

namespace sgm::town {

using plan::Vec2;

enum class RoadClass : uint8_t { Highway, Street };

enum class Pattern : uint8_t {
    Grown,   ///< highways seek the densest ground, streets go straight on
    Raster,  ///< all along the axes of `axis`
    Radial,  ///< towards `centre` and around it
    Field,   ///< along the eigenvectors of a tensor field (tensor_field.h)
};
enum class Turns : uint8_t { Left, Right, Both };
enum class Ends : uint8_t {
    Prune,  ///< dead ends go, until there are none
    Join,   ///< they are prolonged to the next road in reach; what reaches none goes
    Keep,
};

/// How roads grow, piece after piece.
struct RoadGrowth {
    double step_m = 80, block_m = 80;   ///< lengths of a piece of highway and of street
    double turn = .1222, look_m = 800;  ///< radians that a highway bends at most a piece; how far it looks
    double probes = 5;                  ///< rays it looks along
    double junction = 8;                ///< pieces between places where highways branch
    double delay = 60;                  ///< ticks before streets leave highways
    double snap_m = 30;                 ///< a road that ends nearer than this to another joins it
    double angle = .61;                 ///< least angle between roads, radians
};

/// What roads do to the ground and to water.
struct RoadGround {
    double bridge_m = 300;       ///< longest bridge
    double streetBridges = .25;  ///< share of streets that may cross water
    double slope = .12;          ///< steepest rise along a road
    double bank = .6;            ///< steepest rise of ground cut or filled beside roads and water
    double bed_m = 4;            ///< depth of water
    double tunnel_m = 0;         ///< longest tunnel
};

/// What roads follow.
struct RoadPattern {
    double axis = 0;       ///< radians, of the raster and of the first highways
    double reach_m = 200;  ///< how far from water the field's `shore` turns roads
    Turns turns = Turns::Left;
    Pattern pattern = Pattern::Grown;
    Ends ends = Ends::Prune;
    std::optional<Vec2> from,
        centre;  ///< where growth begins: else the densest place; the middle of Radial: else `from`
};

/// What grows roads. The paper prints no number: the defaults are ours.
struct RoadParameters : RoadGrowth, RoadGround, RoadPattern {
    Vec2 lo{-1000, -1000}, hi{1000, 1000};           ///< where roads may be
    double highway_m = 20, street_m = 10;            ///< widths
    double highwayRadius_m = 0, streetRadius_m = 0;  ///< least radius of curves in bends; 0: bends stay corners
    double limit = 100'000;                          ///< most pieces
    uint64_t random = 1;
    double width_m(RoadClass kind) const { return kind == RoadClass::Highway ? highway_m : street_m; }
};

/// A numeric parameter: a row of the table that the language, its reference and its checks read.
struct RoadParameter {
    enum class Unit : uint8_t { Length, Angle, Share, Count };
    std::string_view name;
    double RoadParameters::*field;
    Unit unit;
    double lo, hi;
    std::string_view range, doc;
};
std::span<const RoadParameter> roadParameters();

}  // namespace sgm::town
