// The lines where two slopes of a roof meet.
#include <algorithm>
#include <cmath>
#include <optional>

#include "modeler/field/roof_faces.h"
#include "modeler/field/roof_planes.h"

namespace sgm::field {
namespace {

using plan::Linear;
using plan::Vec2;

constexpr double leastLine_m = 1e-3;
/// Heights that differ by less are one, as a share of the roof's own.
constexpr double alike = 1e-9;

/// The line of points at which two slopes have one height.
struct Line {
    Vec2 from, way;  ///< a point, and a unit direction
    Vec2 at(double t) const { return from + way * t; }
};
std::optional<Line> lineBetween(const Linear& a, const Linear& b) {
    const Vec2 across{a.a - b.a, a.b - b.b};
    const double steep2 = dot(across, across);
    if (steep2 < 1e-12) return std::nullopt;  // parallel planes, or the same one
    const Vec2 from = across * ((b.c - a.c) / steep2);
    return Line{from, Vec2{across.z, -across.x} * (1 / std::sqrt(steep2))};
}

/// The lines of one roof.
class Lines {
public:
    Lines(const RoofPlanes& planes, const RoofSurface& roof) : planes_(planes), roof_(roof) {
        for (Linear& l : roof_.outline) l.c -= planes.overhang_m;
    }

    std::vector<RoofLine> run() {
        const auto count = static_cast<uint32_t>(planes_.sides.size());
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = i + 1; k < count; ++k)
                if (planes_.sides[i].slope > 0 && planes_.sides[k].slope > 0)
                    if (const auto line = lineBetween(roof_.slopes[i], roof_.slopes[k])) follow(*line, i, k);
        return std::move(found_);
    }

private:
    /// Where another plane or the outline may end what the roof has of a line.
    std::vector<double> stopsOf(const Line& line, const Linear& own) const {
        std::vector<double> stops;
        const auto stopWhere = [&](double value, double by) {
            if (std::abs(by) < 1e-12) return;
            if (const double t = -value / by; std::abs(t) < 1e6) stops.push_back(t);
        };
        const auto alongWay = [&](const Linear& l) { return l.a * line.way.x + l.b * line.way.z; };
        for (const Linear& l : roof_.slopes)
            stopWhere(l.at(line.from) - own.at(line.from), alongWay(l) - alongWay(own));
        for (const Linear& l : roof_.outline) stopWhere(l.at(line.from), alongWay(l));
        stopWhere(own.at(line.from) + planes_.highest_m, alongWay(own));
        std::sort(stops.begin(), stops.end());
        return stops;
    }

    bool isOnRoof(const Linear& own, Vec2 p) const {
        const double value = own.at(p);
        return plan::valueOf(roof_.formula, roof_.outline, p) <= 0 && -value <= planes_.highest_m * (1 + alike) &&
               std::abs(plan::valueOf(roof_.formula, roof_.slopes, p) - value) <= alike * (1 + std::abs(value));
    }

    void follow(const Line& line, uint32_t i, uint32_t k) {
        const Linear& own = roof_.slopes[i];
        const std::vector<double> stops = stopsOf(line, own);
        for (size_t first = 0; first + 1 < stops.size();) {
            size_t last = first;
            while (last + 1 < stops.size() && isOnRoof(own, line.at((stops[last] + stops[last + 1]) / 2))) ++last;
            if (last > first && stops[last] - stops[first] > leastLine_m) add(line, stops[first], stops[last], i, k);
            first = std::max(last, first + 1);
        }
    }

    double heightAt(Vec2 p) const { return -plan::valueOf(roof_.formula, roof_.slopes, p); }

    /// How the roof bends along a stretch: 1 where both sides rise from it, -1 where both fall, 0 where it is flat. Two
    /// of three places decide, for another line may cross at one of them.
    int bendOf(const Line& line, double low, double high) const {
        const Vec2 aside = Vec2{line.way.z, -line.way.x} * std::min(1e-3, (high - low) / 8);
        int up = 0, down = 0;
        for (const double share : {0.31, 0.5, 0.69}) {
            const Vec2 at = line.at(low + (high - low) * share);
            const double bend = heightAt(at + aside) + heightAt(at - aside) - 2 * heightAt(at);
            up += bend > 1e-9;
            down += bend < -1e-9;
        }
        return up >= 2 ? 1 : down >= 2 ? -1 : 0;
    }

    void add(const Line& line, double low, double high, uint32_t i, uint32_t k) {
        const Linear& own = roof_.slopes[i];
        RoofLine found;
        found.edges[0] = i, found.edges[1] = k;
        found.at = line.at((low + high) / 2);
        const double rise = own.at(line.at(low)) - own.at(line.at(high));
        found.along = line.way * (rise < 0 ? -1.0 : 1.0);
        found.rise_m = std::abs(rise);
        found.run_m = high - low;
        const int bend = bendOf(line, low, high);
        if (bend == 0) return;  // the roof goes on smoothly: another pair's line at most crosses there
        const bool isLevel = found.rise_m < 1e-6 * found.run_m;
        const bool known = std::any_of(found_.begin(), found_.end(), [&](const RoofLine& other) {
            return length(other.at - found.at) < leastLine_m && std::abs(other.run_m - found.run_m) < leastLine_m &&
                   std::abs(cross(other.along, found.along)) < 1e-6;
        });
        if (known) return;  // two edges in one line share a plane
        found.kind = bend > 0 ? RoofLine::Kind::Valley : isLevel ? RoofLine::Kind::Ridge : RoofLine::Kind::Hip;
        found.height_m = planes_.fascia_m + heightAt(found.at);
        found_.push_back(found);
    }

    const RoofPlanes& planes_;
    RoofSurface roof_;
    std::vector<RoofLine> found_;
};

}  // namespace

std::vector<RoofLine> roofLines(const Primitive& row, const plan::Footprint& footprint, const plan::Formula& formula,
                                std::span<const Argument> arguments) {
    if (!isRoof(row) || footprint.empty() || footprint.edgeCount() > mostRoofLineEdges) return {};
    const auto planes = roofPlanes(row, footprint, formula, arguments);
    return planes ? Lines(*planes, surfaceOf(*planes, footprint, formula)).run() : std::vector<RoofLine>{};
}

}  // namespace sgm::field
