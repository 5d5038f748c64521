// Level areas of a terrain: what buildings stand on.
#include <set>

#include "modeler/town/terrain.h"

namespace sgm::town {
namespace {

constexpr double wall = 1;    // how steep the ground may be between a road and a level area beside it
constexpr double step = 1.5;  // cells that neighbouring areas may differ by in height
constexpr int turns = 24;     // of bringing neighbours nearer to each other

}  // namespace

std::vector<Terrain::Level> Terrain::levelAreas() const {
    const std::vector<double> before = shaped();
    const auto [lower, upper] = cones(fixed_, wall);
    const double margin_m = reach * lattice_.cell_m;
    std::vector<Level> areas;
    for (const plan::Footprint& pad : pads_) {
        Level& area = areas.emplace_back(Level{{}, 0, -1e9, 1e9});
        double sum = 0;
        const plan::Box2 box = bounds(pad);
        for (const auto& [n, away] : cornersNear(pad, margin_m)) {
            area.corners.emplace_back(n, away);
            sum += before[n];
            area.least = std::max(area.least, lower[n]), area.most = std::min(area.most, upper[n]);
        }
        const double mean = area.corners.empty() ? lattice_.bilinear(before, box.empty() ? Vec2{} : box.centre())
                                                 : sum / static_cast<double>(area.corners.size());
        if (area.least > area.most) area.least = area.most = (area.least + area.most) / 2;
        area.height = std::clamp(mean, area.least, area.most);
    }
    return areas;
}

/// Corners in and around an area that no road lies on, with their distances.
std::vector<std::pair<size_t, double>> Terrain::cornersNear(const plan::Footprint& area, double margin_m) const {
    std::vector<std::pair<size_t, double>> corners;
    eachNear(bounds(area), margin_m, [&](int i, int k) {
        const Vec2 p = lattice_.placeOf(i, k);
        const double away = contains(area, p) ? 0 : distanceToEdges(area, p);
        if (away <= margin_m && std::isnan(fixed_[lattice_.indexOf(i, k)]))
            corners.emplace_back(lattice_.indexOf(i, k), away);
    });
    return corners;
}

/// Neighbours, which share corners, come nearer to each other until none is a wall above another.
void Terrain::stepBetween(std::vector<Level>& areas) const {
    std::set<std::pair<size_t, size_t>> neighbours;
    std::vector<size_t> last(natural_.size(), areas.size());
    for (size_t a = 0; a < areas.size(); ++a)
        for (const auto& [n, away] : areas[a].corners) {
            if (last[n] != areas.size() && last[n] != a) neighbours.emplace(last[n], a);
            last[n] = a;
        }
    bool changed = true;
    for (int turn = 0; changed && turn < turns; ++turn) {
        changed = false;
        for (const auto& [a, b] : neighbours) {
            const bool up = areas[a].height <= areas[b].height;
            Level &low = areas[up ? a : b], &high = areas[up ? b : a];
            const double over = high.height - low.height - step * lattice_.cell_m;
            if (over <= .01) continue;
            changed = true;
            low.height = std::min(low.height + over / 2, low.most);
            high.height = std::max(high.height - over / 2, high.least);
        }
    }
}

/// Corners in and around each area get the mean of the ground there, or as much as a wall at the road and the
/// neighbours allow, unless a road lies on them; where areas are near each other a corner is the nearest one's.
void Terrain::layPads() {
    std::vector<Level> areas = levelAreas();
    stepBetween(areas);
    std::vector<double> nearest(natural_.size(), 1e9), levelled = fixed_;
    levels_.clear();
    for (const Level& area : areas) {
        levels_.push_back(area.height);
        for (const auto& [n, away] : area.corners)
            if (away < nearest[n]) nearest[n] = away, levelled[n] = area.height;
    }
    fixed_ = std::move(levelled);
}

}  // namespace sgm::town
