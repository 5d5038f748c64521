#include "modeler/town/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sgm::town {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double mostCorners = 1 << 20;  // of the lattice
constexpr double fall = .005;            // of a body of water along it
constexpr double shore = .4;             // how steep a bed begins
constexpr double extendedSlope = .25;    // how steep decks and water go on beside themselves
constexpr double cover_m = 7;            // ground above a tunnel's road where the tunnel begins

bool isKnown(double v) { return !std::isnan(v); }

double bilinearAt(Vec2 low, double cell_m, int columns, int rows, Vec2 p, const auto& heights) {
    const double u = std::clamp((p.x - low.x) / cell_m, 0.0, columns - 1.0);
    const double v = std::clamp((p.z - low.z) / cell_m, 0.0, rows - 1.0);
    const int i = std::min(static_cast<int>(u), columns - 2), k = std::min(static_cast<int>(v), rows - 2);
    const auto h = [&](int x, int z) {
        return static_cast<double>(
            heights[static_cast<size_t>(z) * static_cast<size_t>(columns) + static_cast<size_t>(x)]);
    };
    const double near = h(i, k) + (u - i) * (h(i + 1, k) - h(i, k));
    const double far = h(i, k + 1) + (u - i) * (h(i + 1, k + 1) - h(i, k + 1));
    return near + (v - k) * (far - near);
}

}  // namespace

double HeightMap::at(Vec2 p) const { return bilinearAt(low, cell_m, columns, rows, p, heights); }

double HeightLattice::bilinear(const std::vector<double>& heights, Vec2 p) const {
    return bilinearAt(low, cell_m, columns, rows, p, heights);
}

double Terrain::naturalAt(Vec2 p) const { return lattice_.bilinear(natural_, p); }

bool Terrain::isLevel() const {
    const auto [least, most] = std::minmax_element(natural_.begin(), natural_.end());
    return !hasWater_ && *most - *least < 1e-6;
}

double Terrain::leastRise(Vec2 p, double step_m) const {
    double least = 1e9;
    for (int i = 0; i < 32; ++i) {
        const Vec2 to = p + directionAt(i * .19634954084936207) * step_m;
        least = std::min(least, std::abs(naturalAt(to) - naturalAt(p)) / step_m);
    }
    return least;
}

HeightMap Terrain::mapOf(const std::vector<double>& heights) const {
    HeightMap map{lattice_.low, lattice_.cell_m, lattice_.columns, lattice_.rows, {}};
    map.heights.reserve(heights.size());
    for (const double h : heights) map.heights.push_back(static_cast<float>(h));
    return map;
}

Result<Terrain> Terrain::survey(const RoadParameters& parameters, const Land& land, Progress* progress) {
    Terrain t;
    t.parameters_ = parameters;
    const Vec2 size = parameters.hi - parameters.lo;
    t.lattice_.cell_m = std::max({parameters.street_m / 4, std::sqrt(size.x * size.z / mostCorners), 1e-3 * size.x});
    t.lattice_.low = parameters.lo - Vec2{t.lattice_.cell_m, t.lattice_.cell_m};
    t.lattice_.columns = static_cast<int>(std::ceil(size.x / t.lattice_.cell_m)) + 3;
    t.lattice_.rows = static_cast<int>(std::ceil(size.z / t.lattice_.cell_m)) + 3;
    const size_t count = static_cast<size_t>(t.lattice_.columns) * static_cast<size_t>(t.lattice_.rows);
    t.natural_.reserve(count), t.water_.assign(count, unknown);
    t.fixed_.assign(count, unknown);
    if (progress) progress->begin("heights", static_cast<uint64_t>(t.lattice_.rows));
    for (int k = 0; k < t.lattice_.rows; ++k) {
        if (cancelled(progress)) return cancelledError();
        tick(progress);
        for (int i = 0; i < t.lattice_.columns; ++i) {
            const Vec2 p = t.lattice_.placeOf(i, k);
            const double h = land.height(p);
            if (!(std::abs(h) <= 1e5))
                return Error{Error::Kind::Input,
                             fmt::format("the ground is {:.6g} m high at ({:.6g}, {:.6g}); heights are at most 100 km",
                                         h, p.x, p.z)};
            t.natural_.push_back(h);
            if (land.water && land.water(p)) t.water_[t.lattice_.indexOf(i, k)] = h, t.hasWater_ = true;
        }
    }
    if (t.hasWater_) t.carve(land);
    return t;
}

/// Calls relax(corner, neighbour, diagonal) over the lattice there and back, with the four neighbours that were come by
/// before.
template <class Relax>
void Terrain::sweep(Relax&& relax) const {
    const auto beside = [&](int i, int k, int di, int dk) {
        const int x = i + di, z = k + dk;
        if (x < 0 || z < 0 || x >= lattice_.columns || z >= lattice_.rows) return;
        relax(lattice_.indexOf(i, k), lattice_.indexOf(x, z), di != 0 && dk != 0);
    };
    for (int k = 0; k < lattice_.rows; ++k)
        for (int i = 0; i < lattice_.columns; ++i)
            beside(i, k, -1, 0), beside(i, k, -1, -1), beside(i, k, 0, -1), beside(i, k, 1, -1);
    for (int k = lattice_.rows - 1; k >= 0; --k)
        for (int i = lattice_.columns - 1; i >= 0; --i)
            beside(i, k, 1, 0), beside(i, k, 1, 1), beside(i, k, 0, 1), beside(i, k, -1, 1);
}

/// Two sweeps over the lattice: afterwards no corner is more than `slope` times its distance above (below) another,
/// distances being those of steps to eight neighbours.
void Terrain::spread(std::vector<double>& heights, double slope, bool upper) const {
    const double step = slope * lattice_.cell_m, across = step * std::sqrt(2.0);
    const auto relax = [&](size_t at, size_t beside, bool diagonal) {
        const double by = diagonal ? across : step, from = heights[beside];
        double& to = heights[at];
        to = upper ? std::min(to, from + by) : std::max(to, from - by);
    };
    sweep(relax);
}

std::vector<double> Terrain::extended(const std::vector<double>& known, double slope) const {
    auto [lower, upper] = cones(known, slope);
    for (size_t n = 0; n < known.size(); ++n) upper[n] = isKnown(known[n]) ? known[n] : (upper[n] + lower[n]) / 2;
    return std::move(upper);
}

/// Water falls by little along its way; the land beside it is cut down to it, and its bed lies below it.
void Terrain::carve(const Land& land) {
    // Heights spread among the corners of one body of water alone, as often as its windings ask for.
    const double step = fall * lattice_.cell_m, across = step * std::sqrt(2.0);
    bool changed = true;
    const auto relax = [&](size_t at, size_t beside, bool diagonal) {
        const double from = water_[beside] + (diagonal ? across : step);
        double& to = water_[at];
        if (from < to - 1e-6) to = from, changed = true;  // unknown compares as false
    };
    for (int turn = 0; changed && turn < 64; ++turn) {
        changed = false;
        sweep(relax);
    }
    layBeds(land);
}

/// Banks and beds begin at the shore itself, which lies somewhere between a corner in water and one on land.
void Terrain::layBeds(const Land& land) {
    constexpr double far = 1e9;
    std::vector<double> banks(water_.size(), far), depth(water_.size(), far);
    const auto meet = [&](int i, int k, int x, int z) {
        const size_t wet = lattice_.indexOf(i, k), dry = lattice_.indexOf(x, z);
        if (!isKnown(water_[wet]) || isKnown(water_[dry])) return;
        double near = 0, beyond = 1;  // shares of the way from the wet corner
        for (int halving = 0; halving < 6; ++halving) {
            const double middle = (near + beyond) / 2;
            (land.water(lattice_.placeOf(i, k) + (lattice_.placeOf(x, z) - lattice_.placeOf(i, k)) * middle) ? near
                                                                                                             : beyond) =
                middle;
        }
        banks[dry] = std::min(banks[dry], water_[wet] + parameters_.bank * lattice_.cell_m * (1 - near));
        depth[wet] = std::min(depth[wet], shore * lattice_.cell_m * near);
    };
    for (int k = 0; k < lattice_.rows; ++k)
        for (int i = 0; i < lattice_.columns; ++i) {
            if (i + 1 < lattice_.columns) meet(i, k, i + 1, k), meet(i + 1, k, i, k);
            if (k + 1 < lattice_.rows) meet(i, k, i, k + 1), meet(i, k + 1, i, k);
        }
    spread(banks, parameters_.bank, true);
    spread(depth, shore, true);
    for (size_t n = 0; n < water_.size(); ++n)
        natural_[n] =
            isKnown(water_[n]) ? water_[n] - std::min(depth[n], parameters_.bed_m) : std::min(natural_[n], banks[n]);
}

std::pair<std::vector<double>, std::vector<double>> Terrain::cones(const std::vector<double>& known,
                                                                   double slope) const {
    constexpr double far = 1e9;
    std::vector<double> upper(known.size()), lower(known.size());
    for (size_t n = 0; n < known.size(); ++n)
        upper[n] = isKnown(known[n]) ? known[n] : far, lower[n] = isKnown(known[n]) ? known[n] : -far;
    spread(upper, slope, true);
    spread(lower, slope, false);
    return {std::move(lower), std::move(upper)};
}

std::vector<double> Terrain::shaped() const {
    auto [lower, upper] = cones(fixed_, parameters_.bank);
    for (size_t n = 0; n < fixed_.size(); ++n)
        upper[n] = isKnown(fixed_[n])    ? fixed_[n]
                   : lower[n] > upper[n] ? (lower[n] + upper[n]) / 2
                                         : std::clamp(natural_[n], lower[n], upper[n]);
    return std::move(upper);
}

void Terrain::grade(const RoadGraph& graph) {
    solve(graph);
    layRoads(graph);
    layBridges(graph);
}

double Terrain::besideWidth(const RoadEdge& e) const {
    return parameters_.width_m(e.kind) / 2 + reach * lattice_.cell_m;
}

template <class Visit>
void Terrain::eachBeside(const RoadGraph& graph, const RoadEdge& e, Visit&& visit) const {
    const Vec2 a = graph.metresAt(e.a), b = graph.metresAt(e.b), d = b - a;
    const double wide = besideWidth(e), from = nodeHeights_[e.a], to = nodeHeights_[e.b];
    plan::Box2 box;
    box.add(a), box.add(b);
    eachNear(box, wide, [&](int i, int k) {
        const Vec2 p = lattice_.placeOf(i, k);
        const double t = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
        const Vec2 off = p - (a + d * t);
        const double away = lengthOf(off);
        if (away <= wide) visit(lattice_.indexOf(i, k), from + t * (to - from), away);
    });
}

/// Corners beside a road get its height there; where roads meet, the mean of theirs by how near they are.
void Terrain::layRoads(const RoadGraph& graph) {
    std::vector<double> sum(natural_.size(), 0), weight(natural_.size(), 0);
    for (const RoadEdge& e : graph.edges()) {
        if (e.removed || e.bridge) continue;  // a tunnel is laid as far as its ground is low enough for a cut
        const double wide = besideWidth(e);
        eachBeside(graph, e, [&](size_t n, double height, double away) {
            if (e.tunnel && natural_[n] > height + cover_m) return;
            const double near = 1.001 - away / wide, w = near * near;
            sum[n] += w * height, weight[n] += w;
        });
    }
    for (size_t n = 0; n < sum.size(); ++n)
        if (weight[n] > 0) fixed_[n] = sum[n] / weight[n];
}

void Terrain::layBridges(const RoadGraph& graph) {
    deck_.assign(natural_.size(), unknown);
    std::vector<double> nearest(natural_.size(), 1e9);
    for (const RoadEdge& e : graph.edges()) {
        if (e.removed || !(e.bridge || e.tunnel)) continue;
        hasBridge_ = true;
        eachBeside(graph, e, [&](size_t n, double height, double away) {
            if (away < nearest[n]) nearest[n] = away, deck_[n] = height;
        });
    }
}

size_t Terrain::level(const plan::Footprint& area) {
    pads_.push_back(area);
    return pads_.size() - 1;
}

void Terrain::finish() {
    if (!pads_.empty()) layPads();
    layers_.ground = mapOf(shaped());
    if (hasBridge_) layers_.deck = mapOf(extended(deck_, extendedSlope));
    if (hasWater_) layers_.water = mapOf(extended(water_, extendedSlope));
    for (auto* done : {&natural_, &water_, &fixed_, &deck_}) *done = {};
}

}  // namespace sgm::town
