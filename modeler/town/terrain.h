// The ground of a town: heights that roads, water and buildings have shaped.
// Enters: a map of heights and of water, a road graph, areas that have to be level. Leaves: heights over a lattice of
// squares, for the ground itself, for bridges over it and for the water's surface. Assumes one thread. Earthworks are
// as steep as `bank` at most: fills and cuts beside a road are cones from its edge, so that what they make of the
// ground is an upper and a lower envelope of cones with the natural ground between them. No libm but √: the same bits
// everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"
#include "modeler/town/grow.h"

namespace sgm::town {

/// Heights in metres at the corners of squares; bilinear between them, those of the border beyond.
struct HeightMap {
    Vec2 low;
    double cell_m = 1;
    int columns = 0, rows = 0;
    std::vector<float> heights;  ///< row by row, z in the outer loop
    bool empty() const { return heights.empty(); }
    double at(Vec2 p) const;
};

/// The shaped ground as layers over one lattice.
struct TerrainLayers {
    HeightMap ground;
    HeightMap deck;   ///< of bridges and tunnels, and how their heights go on beside them; empty without
    HeightMap water;  ///< its surface, and how its heights go on beside it; empty without water
};

/// The corners of squares over a town's area, row by row.
struct HeightLattice {
    Vec2 low;
    double cell_m = 1;
    int columns = 0, rows = 0;

    size_t indexOf(int i, int k) const {
        return static_cast<size_t>(k) * static_cast<size_t>(columns) + static_cast<size_t>(i);
    }
    Vec2 placeOf(int i, int k) const { return low + Vec2{i * cell_m, k * cell_m}; }
    /// Between the four corners around `p`; that of the border beyond.
    double bilinear(const std::vector<double>& heights, Vec2 p) const;
};

class Terrain {
public:
    /// Samples `land.height` over the roads' area and lays beds of rivers and lakes into it: a body of water is level
    /// but for a fall of .5 % along it, `bed_m` deep, with banks as steep as `bank` where it lies below the land around
    /// it. Error::Input where a height isn't finite, Error::Cancelled.
    static Result<Terrain> survey(const RoadParameters& parameters, const Land& land, Progress* progress);

    /// The ground before any road.
    double naturalAt(Vec2 p) const;
    /// Whether it is equally high everywhere, and without water.
    bool isLevel() const;
    /// The least rise or fall from `p` over `step_m` in 32 directions: a road from there is no less steep.
    double leastRise(Vec2 p, double step_m) const;
    /// Gives every node of the graph its height: that of the ground, moved until no road between two nodes is steeper
    /// than `slope`, with bridges over the water.
    void grade(const RoadGraph& graph);
    /// After `grade`: the steepest road, and where its middle lies.
    struct Steepest {
        double slope = 0;
        Vec2 at;
    };
    Steepest steepest() const { return steepest_; }
    /// An area that shall be level: its number. All are levelled together by `finish`, at the mean of the ground that
    /// roads have left there.
    size_t level(const plan::Footprint& area);
    /// Shapes the ground: no `level` after it.
    void finish();

    const TerrainLayers& layers() const { return layers_; }
    /// After `finish`: the height of an area that is level.
    double levelOf(size_t area) const { return levels_[area]; }
    /// Heights of the graph's nodes, after `grade`.
    const std::vector<double>& nodeHeights() const { return nodeHeights_; }

private:
    HeightMap mapOf(const std::vector<double>& heights) const;
    void carve(const Land& land);
    void layBeds(const Land& land);
    void solve(const RoadGraph& graph);
    void layRoads(const RoadGraph& graph);
    void layBridges(const RoadGraph& graph);
    /// A level area's corners that no road lies on, its height, and how low and high that may be beside the roads.
    struct Level {
        std::vector<std::pair<size_t, double>> corners;  ///< with their distances from the area
        double height = 0, least = 0, most = 0;
    };
    std::vector<Level> levelAreas() const;
    std::vector<std::pair<size_t, double>> cornersNear(const plan::Footprint& area, double margin_m) const;
    void stepBetween(std::vector<Level>& areas) const;
    void layPads();
    template <class Visit>
    void eachNear(const plan::Box2& box, double margin_m, Visit&& visit) const;
    /// Calls visit(corner, the road's height there, metres from its axis) for the corners at a road.
    template <class Visit>
    void eachBeside(const RoadGraph& graph, const RoadEdge& e, Visit&& visit) const;
    /// Half a road's width and the reach of its corners, metres.
    double besideWidth(const RoadEdge& e) const;
    template <class Relax>
    void sweep(Relax&& relax) const;
    /// What is known at some corners, as the lower and the upper envelope of cones that steep.
    std::pair<std::vector<double>, std::vector<double>> cones(const std::vector<double>& known, double slope) const;
    /// `natural_` between the cones of what is fixed.
    std::vector<double> shaped() const;
    /// Heights that are known at some corners, over the whole lattice, as steep as `slope` where they can be.
    std::vector<double> extended(const std::vector<double>& known, double slope) const;
    void spread(std::vector<double>& heights, double slope, bool upper) const;

    RoadParameters parameters_;
    HeightLattice lattice_;
    std::vector<double> natural_;  ///< the ground with beds of water
    std::vector<double> water_;    ///< its surface where there is water, else NaN
    std::vector<double> fixed_;    ///< what roads and level areas say, else NaN
    std::vector<double> deck_;     ///< what bridges and tunnels say, else NaN
    std::vector<double> nodeHeights_, levels_;
    std::vector<plan::Footprint> pads_;
    bool hasWater_ = false, hasBridge_ = false;
    Steepest steepest_;
    TerrainLayers layers_;

    /// Cells beyond an area on which bilinear heights over it hang.
    static constexpr double reach = 1.42;
};

template <class Visit>
void Terrain::eachNear(const plan::Box2& box, double margin_m, Visit&& visit) const {
    const auto first = [&](double v, double low) {
        return std::max(0, static_cast<int>(std::ceil((v - margin_m - low) / lattice_.cell_m)));
    };
    const auto last = [&](double v, double low, int count) {
        return std::min(count - 1, static_cast<int>(std::floor((v + margin_m - low) / lattice_.cell_m)));
    };
    for (int k = first(box.lo.z, lattice_.low.z); k <= last(box.hi.z, lattice_.low.z, lattice_.rows); ++k)
        for (int i = first(box.lo.x, lattice_.low.x); i <= last(box.hi.x, lattice_.low.x, lattice_.columns); ++i)
            visit(i, k);
}

}  // namespace sgm::town
