#include "modeler/plan/crossings.h"

#include <algorithm>

#include "modeler/plan/lattice.h"

namespace sgm::plan {
namespace {

struct Segment {
    LatticePoint from, to;
    int64_t lowX() const { return std::min(from.x, to.x); }
    int64_t highX() const { return std::max(from.x, to.x); }
};

bool cross(const Segment& a, const Segment& b) {
    return turn(a.from, a.to, b.from) * turn(a.from, a.to, b.to) < 0 &&
           turn(b.from, b.to, a.from) * turn(b.from, b.to, a.to) < 0;
}

}  // namespace

size_t countCrossings(const Footprint& footprint, size_t most) { return countCrossings(pathsOf(footprint), most); }

size_t countCrossings(const LatticePaths& paths, size_t most) {
    std::vector<Segment> segments, open;
    for (const LatticePath& path : paths)
        for (size_t i = 0; i < path.size(); ++i) segments.push_back({path[i], path[i + 1 == path.size() ? 0 : i + 1]});
    std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) { return a.lowX() < b.lowX(); });
    size_t crossings = 0, compared = 0;
    for (const Segment& next : segments) {
        std::erase_if(open, [&](const Segment& s) { return s.highX() < next.lowX(); });
        for (const Segment& s : open) crossings += cross(s, next);
        compared += open.size();
        if (crossings > most || compared > 10'000 * most) return most + 1;
        open.push_back(next);
    }
    return crossings;
}

}  // namespace sgm::plan
