#include "modeler/town/lots.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/ring_parts.h"
#include "modeler/town/lot_parts.h"
#include "modeler/town/point.h"

namespace sgm::town {
namespace {

using plan::Footprint;
using plan::Polygon;
using plan::Vec2;

constexpr int mostCuts = 24;  // one inside the other

class Cutter {
public:
    Cutter(const LotParameters& parameters, const Footprint& block, std::vector<Lot>& out, const Progress* progress)
        : parameters_(parameters), tags_(block.tags), isStreet_(block), out_(out), progress_(progress) {}

    void run(Polygon land, uint64_t key, int depth) {
        if (cancelled(progress_)) return;
        if (depth < mostCuts && area(land) > 1.5 * parameters_.area_m2) {
            std::vector<Polygon> parts = divide(land, key);
            for (size_t i = 0; i < parts.size(); ++i) run(std::move(parts[i]), combine(key, i), depth + 1);
            if (!parts.empty()) return;
        }
        out_.push_back(lotOf(std::move(land), tags_, isStreet_));
    }

private:
    /// Both sides of a line, each polygon by itself.
    std::vector<Polygon> cutAcross(const Polygon& land, Vec2 n, double at) const {
        std::vector<Polygon> parts;
        parts.reserve(2);
        const bool once = land.courts.empty() && plan::isCutOnce(land.outer, n, at);
        const auto add = [&](Polygon&& part) {
            if (part.outer.size() >= 3 && area(part) > 1e-3) parts.push_back(std::move(part));
        };
        for (const double side : {1.0, -1.0}) {
            if (once)
                add({plan::partBelow(land.outer, n * side, at * side), {}});
            else
                for (Polygon& polygon : plan::clipped({{land}, tags_}, {n * side, at * side}).polygons)
                    add(std::move(polygon));
        }
        return parts;
    }

    /// Across the longer side of the box; else across the shorter one; else the back is cut off; else nothing is, and
    /// there are no parts.
    std::vector<Polygon> divide(const Polygon& land, uint64_t key) const {
        if (streetOf(land, isStreet_) <= 0) return {};
        const OrientedBox box = leastBox(land.outer);
        const double share = .5 + uniform(combine(key, 3), -parameters_.jitter, parameters_.jitter);
        const auto haveFront = [&](const std::vector<Polygon>& parts) {
            return parts.size() > 1 && std::all_of(parts.begin(), parts.end(), [&](const Polygon& part) {
                       return longestStreet(part, isStreet_) >= parameters_.front_m;
                   });
        };
        auto parts = cutAcross(land, box.along, box.from + box.length * share);
        if (haveFront(parts)) return parts;
        // Strips deeper than this are no lots any more.
        const double deep_m = mostDepth * std::sqrt(parameters_.area_m2);
        if (box.length > 1.5 * deep_m)
            for (const double at : {box.from + deep_m, box.from + box.length - deep_m}) {
                parts = cutAcross(land, box.along, at);
                const auto hasStreet = [&](const Polygon& part) { return streetOf(part, isStreet_) > 0; };
                if (parts.size() == 2 && hasStreet(parts[0]) != hasStreet(parts[1])) return parts;
            }
        const Vec2 across{-box.along.z, box.along.x};
        plan::Box2 extent;
        for (const Vec2 p : land.outer.points) extent.add({dot(p, across), 0});
        parts = cutAcross(land, across, extent.lo.x + extent.size().x * share);
        if (haveFront(parts)) return parts;
        return {};
    }

    const LotParameters& parameters_;
    const std::vector<std::string>& tags_;
    const StreetTags isStreet_;
    std::vector<Lot>& out_;
    const Progress* progress_;
};

}  // namespace

bool isStreet(const plan::Footprint& land, const plan::Edge& edge) { return land.tags[edge.tag].starts_with("street"); }

std::vector<Lot> lotsOf(const plan::Footprint& block, const LotParameters& parameters, uint64_t key,
                        const Progress* progress) {
    std::vector<Lot> lots;
    Cutter cutter(parameters, block, lots, progress);
    for (const plan::Polygon& polygon : block.polygons)
        if (parameters.cuts == Cuts::Boxes || !cutBySkeleton({{polygon}, block.tags}, parameters, key, progress, lots))
            cutter.run(polygon, key, 0);
    return lots;
}

}  // namespace sgm::town
