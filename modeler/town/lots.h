// Lots: a block cut into pieces that each touch a street.
// Enters: a block with tagged edges. Leaves: lots that tile it. Assumes a sound footprint. The cuts are those of
// oriented boxes or of the straight skeleton (Vanegas et al., "Procedural generation of parcels in urban modeling",
// 2012, algorithm 2 and section 5).
#pragma once

#include "modeler/core/progress.h"
#include "modeler/plan/polygon.h"

namespace sgm::town {

/// How a block is cut.
enum class Cuts : uint8_t {
    Boxes,     ///< across oriented boxes, again and again
    Skeleton,  ///< into strips along its streets, and these across
};

struct LotParameters {
    double area_m2 = 400;  ///< wished; a piece of up to 1.5 times that stays whole
    double front_m = 8;    ///< a lot has at least so much of a street
    double jitter = .15;   ///< how far from the middle cuts may lie, as a share of the length
    Cuts cuts = Cuts::Boxes;
    double depth_m = 0;  ///< of the strips; what lies behind them has no street. 0: twice the root of the area
};

/// A lot in a frame of its own: x runs along its front from left to right seen from the street, z to the street.
struct Lot {
    plan::Footprint
        land;           ///< about the middle of its box in that frame; edges as in the block, those of cuts without tag
    plan::Vec2 centre;  ///< of the box, in the block's coordinates
    plan::Vec2 right{1, 0};  ///< its x axis there
    plan::Vec2 front{0, 1};  ///< its z axis
    double street_m = 0;     ///< of its edges along streets
    bool corner = false;     ///< at streets of two directions
    uint64_t key = 0;        ///< of the place
};

/// The lots of a block. Cuts across boxes that would leave a part without a street, or with less than `front_m` of it,
/// are turned, and left undone where both ways would. Strips of the skeleton belong, at a corner, to the longer street;
/// a block of more than 400 edges, or without a skeleton, is cut by boxes. Where lots would be deeper than twice the
/// root of their area, what lies behind is cut off: such land within a block has street_m = 0 and is whole, as is a
/// block without a street. Ends early, with some lots missing, where `progress` is cancelled.
std::vector<Lot> lotsOf(const plan::Footprint& block, const LotParameters& parameters, uint64_t key,
                        const Progress* progress = nullptr);

/// Whether an edge lies along a street or highway.
bool isStreet(const plan::Footprint& land, const plan::Edge& edge);

}  // namespace sgm::town
