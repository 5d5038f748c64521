// Lots by the straight skeleton (Vanegas et al. 2012, section 5): strips along streets, cut square to them.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "modeler/core/random.h"
#include "modeler/plan/cut.h"
#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"
#include "modeler/town/join_pieces.h"
#include "modeler/town/lot_parts.h"
#include "modeler/town/point.h"
#include "modeler/town/road_graph.h"
#include "modeler/town/skeleton.h"

namespace sgm::town {
namespace {

using plan::Footprint;
using plan::PlacedEdge;
using plan::Vec2;

constexpr size_t mostEdges = 400;
constexpr double sameStreet = .87;  // cosine of the bend, 30°, up to which edges are one side
constexpr double slack = 1.3;       // strips so much deeper than wished stay whole
constexpr double leastPart_m2 = .01;
constexpr double nearVertex_m = .5;  // cuts nearer to a bend go through it

/// A side of the block along one street: consecutive edges that bend little.
struct Side {
    std::vector<uint32_t> edges;
    std::vector<double> starts;                  ///< metres along the side where each edge begins, and its end
    uint32_t before = noIndex, after = noIndex;  ///< sides that begin and end at its ends
    double from = 0, to = 0;                     ///< what corners leave of it
    uint32_t ownerBefore = noIndex, ownerAfter = noIndex;  ///< edges that take what lies beyond
    uint32_t firstLot = noIndex, lots = 0;
    double length() const { return starts.back(); }
};

class StripCutter {
public:
    StripCutter(const Footprint& block, const LotParameters& parameters, uint64_t key)
        : block_(block), parameters_(parameters), key_(key), edges_(plan::edgesOf(block)), isStreet_(block) {}

    bool run(const Progress* progress, std::vector<Lot>& out) {
        if (edges_.size() > mostEdges || streetOf(block_.polygons[0], isStreet_) <= 0) return false;
        faces_ = skeletonFaces(block_.polygons[0]);
        if (faces_.empty()) return false;
        gatherSides();
        if (sides_.empty()) return false;
        gatherLand();
        clipDepth();
        std::vector<uint32_t> order(sides_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return sides_[a].length() > sides_[b].length(); });
        for (size_t i = 0; i < order.size(); ++i) rank_.push_back(0);
        for (uint32_t i = 0; i < order.size(); ++i) rank_[order[i]] = i;
        for (const uint32_t s : order) settleEnds(s), layLots(s);
        for (const Side& side : sides_) {
            if (cancelled(progress)) return true;
            cutSide(side);
        }
        for (auto& pieces : lots_) finish(pieces, out);
        for (Footprint& land : joined(behind_))
            out.push_back(lotOf(std::move(land.polygons[0]), block_.tags, isStreet_));
        return true;
    }

private:
    Vec2 along(uint32_t e) const { return unit(edges_[e].to - edges_[e].from); }
    static Vec2 inward(Vec2 along) { return {-along.z, along.x}; }
    bool isStreetEdge(uint32_t e) const { return isStreet_(edges_[e].edge); }

    /// Whether edges e and f, one behind the other, are one side.
    bool goesOn(uint32_t e, uint32_t f) const {
        return isStreetEdge(e) && isStreetEdge(f) && dot(along(e), along(f)) >= sameStreet;
    }

    void gatherSides() {
        const plan::Polygon& polygon = block_.polygons[0];
        uint32_t first = 0;
        for (size_t r = 0; r <= polygon.courts.size(); ++r) {
            const auto count = static_cast<uint32_t>((r == 0 ? polygon.outer : polygon.courts[r - 1]).size());
            uint32_t begin = 0;
            for (uint32_t i = 0; i < count; ++i)
                if (!goesOn(first + (i + count - 1) % count, first + i)) {
                    begin = i;
                    break;
                }
            const auto base = static_cast<uint32_t>(sides_.size());
            for (uint32_t i = 0; i < count; ++i) {
                const uint32_t e = first + (begin + i) % count, last = first + (begin + i + count - 1) % count;
                if (!isStreetEdge(e)) continue;
                if (i == 0 || !goesOn(last, e)) {
                    const bool meets = i > 0 && isStreetEdge(last);
                    sides_.emplace_back().starts.push_back(0);
                    if (meets) join(static_cast<uint32_t>(sides_.size()) - 2, static_cast<uint32_t>(sides_.size()) - 1);
                }
                sides_.back().edges.push_back(e);
                sides_.back().starts.push_back(sides_.back().starts.back() + edges_[e].length());
            }
            const auto end = static_cast<uint32_t>(sides_.size());
            if (end > base + 1 && isStreetEdge(first + (begin + count - 1) % count) && isStreetEdge(first + begin))
                join(end - 1, base);
            first += count;
        }
        for (Side& side : sides_) side.to = side.length();
    }

    void join(uint32_t a, uint32_t b) { sides_[a].after = b, sides_[b].before = a; }

    Footprint faceOf(uint32_t e) const {
        plan::Ring ring = plan::ringOf(faces_[e], {0, plan::EdgeSource::Cut});
        ring.edges[0] = edges_[e].edge;
        Footprint out{{}, block_.tags};
        out.polygons.push_back({std::move(ring), {}});
        return out;
    }

    /// The land of every street's edge: its face, and those of edges without street that lie along it longest.
    void gatherLand() {
        using Segment = std::pair<std::pair<double, double>, std::pair<double, double>>;
        std::map<Segment, uint32_t> faceAt;
        const auto segment = [&](uint32_t f, size_t i, bool back) {
            const Vec2 a = faces_[f][i], b = faces_[f][(i + 1) % faces_[f].size()];
            return back ? Segment{{b.x, b.z}, {a.x, a.z}} : Segment{{a.x, a.z}, {b.x, b.z}};
        };
        for (uint32_t f = 0; f < faces_.size(); ++f)
            for (size_t i = 1; i < faces_[f].size(); ++i) faceAt[segment(f, i, false)] = f;
        std::vector<uint32_t> host(faces_.size(), noIndex);
        for (uint32_t f = 0; f < faces_.size(); ++f)
            if (isStreetEdge(f)) host[f] = f;
        for (bool found = true; found;) {
            found = false;
            const std::vector<uint32_t> known = host;
            for (uint32_t f = 0; f < faces_.size(); ++f) {
                if (known[f] != noIndex) continue;
                std::map<uint32_t, double> shared;
                for (size_t i = 1; i < faces_[f].size(); ++i)
                    if (const auto other = faceAt.find(segment(f, i, true));
                        other != faceAt.end() && known[other->second] != noIndex)
                        shared[known[other->second]] +=
                            plan::length(faces_[f][(i + 1) % faces_[f].size()] - faces_[f][i]);
                const auto longest = std::max_element(shared.begin(), shared.end(),
                                                      [](auto& a, auto& b) { return a.second < b.second; });
                if (longest != shared.end()) host[f] = longest->first, found = true;
            }
        }
        land_.resize(faces_.size());
        for (uint32_t f = 0; f < faces_.size(); ++f)
            (host[f] == noIndex ? behind_ : land_[host[f]]).push_back(faceOf(f));
    }

    /// Takes off what lies deeper than strips may be, where that is much.
    void clipDepth() {
        deep_m_ = parameters_.depth_m > 0 ? parameters_.depth_m : mostDepth * std::sqrt(parameters_.area_m2);
        double deepest = 0;
        for (uint32_t e = 0; e < land_.size(); ++e)
            for (const Footprint& piece : land_[e])
                for (const Vec2 p : piece.polygons[0].outer.points)
                    deepest = std::max(deepest, dot(p - edges_[e].from, inward(along(e))));
        if (deepest <= slack * deep_m_) {
            deep_m_ = deepest;
            return;
        }
        for (uint32_t e = 0; e < land_.size(); ++e) {
            const Vec2 n = inward(along(e));
            const double at = dot(edges_[e].from, n) + deep_m_;
            std::vector<Footprint> kept;
            for (const Footprint& piece : land_[e]) {
                keep(kept, plan::clipped(piece, {n, at}));
                keep(behind_, plan::clipped(piece, {n * -1, -at}));
            }
            land_[e] = std::move(kept);
        }
    }

    static void keep(std::vector<Footprint>& into, const Footprint& part) {
        for (const plan::Polygon& polygon : part.polygons)
            if (area(polygon) > 1e-6) into.push_back({{polygon}, part.tags});
    }

    /// Metres of the loser's side that belong to the winner's strip at their corner: so far the skeleton's diagonal
    /// reaches. 0 where the corner is none.
    double cornerOf(uint32_t loser, bool atBegin) const {
        const Side& side = sides_[loser];
        const Side& winner = sides_[atBegin ? side.before : side.after];
        const uint32_t e = atBegin ? side.edges.front() : side.edges.back();
        const uint32_t w = atBegin ? winner.edges.back() : winner.edges.front();
        const Vec2 d = along(e) * (atBegin ? 1 : -1), n = inward(along(w));
        if ((atBegin ? cross(along(w), along(e)) : cross(along(e), along(w))) <= 0) return 0;  // reflex
        const Vec2 corner = atBegin ? edges_[e].from : edges_[e].to;
        const Vec2 node = atBegin ? faces_[e].back() : faces_[e][2];
        const double deep = dot(node - corner, n), share = deep > deep_m_ ? deep_m_ / deep : 1;
        return std::clamp(dot(node - corner, d) * share, 0.0, edges_[e].length());
    }

    /// Gives the corners of a side to longer ones, and all of it where a lot's front wouldn't be left.
    void settleEnds(uint32_t s) {
        Side& side = sides_[s];
        const auto edgeAt = [&](uint32_t other, bool last) -> uint32_t {
            if (other == noIndex || other == s || rank_[other] > rank_[s]) return noIndex;
            const Side& owner = sides_[other];
            if (owner.lots > 0) return last ? owner.edges.back() : owner.edges.front();
            // One that others share between them: whoever has its near end.
            const bool isWhole = last ? owner.to >= owner.length() : owner.from <= 0;
            return last != isWhole ? owner.ownerAfter : owner.ownerBefore;
        };
        side.ownerBefore = edgeAt(side.before, true), side.ownerAfter = edgeAt(side.after, false);
        const double whole = side.length();
        double first = side.ownerBefore != noIndex ? cornerOf(s, true) : 0,
               last = side.ownerAfter != noIndex ? cornerOf(s, false) : 0;
        const bool hasOwner = side.ownerBefore != noIndex || side.ownerAfter != noIndex;
        side.from = first, side.to = whole - last;
        if (hasOwner && side.to - side.from < std::max(parameters_.front_m, nearVertex_m)) {
            // Nothing is left for a lot of its own.
            if (first + last <= 0) first = side.ownerBefore != noIndex, last = side.ownerAfter != noIndex;
            const double share = side.ownerBefore == noIndex  ? 0
                                 : side.ownerAfter == noIndex ? 1
                                                              : first / (first + last);
            side.from = side.to = whole * share;
        }
        if (side.ownerBefore != noIndex) handOver(side, 0, side.from, side.ownerBefore);
        if (side.ownerAfter != noIndex) handOver(side, side.to, whole, side.ownerAfter);
    }

    /// Makes the land between two places along a side another edge's, which cuts it by its own lots.
    void handOver(const Side& side, double from, double to, uint32_t edge) {
        std::vector<Footprint> parts;
        for (size_t j = 0; j < side.edges.size(); ++j) takeLand(side, j, from, to, parts);
        std::move(parts.begin(), parts.end(), std::back_inserter(land_[edge]));
    }

    /// Of a side's strip: the deepest, where most of it is as deep, as between square corners; else rather its mean.
    double depthOf(const Side& side) const {
        double ground = 0, deepest = 0;
        for (const uint32_t e : side.edges)
            for (const Footprint& piece : land_[e]) {
                ground += area(piece);
                for (const Vec2 p : piece.polygons[0].outer.points)
                    deepest = std::max(deepest, dot(p - edges_[e].from, inward(along(e))));
            }
        return std::min(deepest, 1.4 * ground / side.length());
    }

    /// How many lots a side has, and where they begin and end.
    void layLots(uint32_t s) {
        Side& side = sides_[s];
        const double free = side.to - side.from;
        if (!(free > 0)) return;
        const double depth = std::max(1.0, depthOf(side));
        const double width = std::max({parameters_.front_m, parameters_.area_m2 / depth, 1.0});
        double count = std::max(1.0, std::floor(free / width + .5));
        if (free / count < parameters_.front_m) count = std::max(1.0, std::floor(free / parameters_.front_m));
        const double each = free / count,
                     play = std::clamp(std::min(parameters_.jitter, (1 - parameters_.front_m / each) / 2), 0.0, .45);
        side.firstLot = static_cast<uint32_t>(lots_.size());
        side.lots = static_cast<uint32_t>(count);
        lots_.resize(lots_.size() + side.lots);
        bounds_.resize(lots_.size());
        double last = side.from;
        for (uint32_t i = 0; i < side.lots; ++i) {
            const uint64_t draw = combine(combine(key_, edges_[side.edges[0]].index), i);
            double to = side.from + each * (i + 1 + (i + 1 < side.lots ? uniform(draw, -play, play) : 0));
            for (const double at : side.starts)
                if (i + 1 < side.lots && std::abs(at - to) < nearVertex_m && at - last > parameters_.front_m / 2)
                    to = at;
            bounds_[side.firstLot + i] = {last, to};
            last = to;
        }
        bounds_[side.firstLot + side.lots - 1].second = side.to;
    }

    void cutSide(const Side& side) {
        for (size_t j = 0; j < side.edges.size(); ++j)
            for (uint32_t i = 0; i < side.lots; ++i) {
                const auto [from, to] = bounds_[side.firstLot + i];
                takeLand(side, j, from, to, lots_[side.firstLot + i]);
            }
    }

    /// The land of an edge between two places along its side; what lies beyond the edge's ends goes with what is next
    /// to them.
    void takeLand(const Side& side, size_t j, double from, double to, std::vector<Footprint>& into) const {
        const double a = side.starts[j], b = side.starts[j + 1];
        if (to <= a + 1e-6 || from >= b - 1e-6 || to - from <= 1e-6) return;
        const uint32_t e = side.edges[j];
        const Vec2 d = along(e);
        const double origin = dot(edges_[e].from, d) - a;
        for (const Footprint& piece : land_[e]) {
            Footprint part = piece;
            if (from > a + 1e-6) part = plan::clipped(part, {d * -1, -(origin + from)});
            if (to < b - 1e-6 && !part.empty()) part = plan::clipped(part, {d, origin + to});
            keep(into, part);
        }
    }

    /// The pieces as polygons, each by itself.
    static std::vector<Footprint> joined(std::vector<Footprint>& pieces) {
        std::vector<Footprint> out;
        for (Footprint& land : joinedPieces(pieces))
            if (area(land) > leastPart_m2) appendSound(std::move(land), out);
        return out;
    }

    /// An outline that meets itself at a point, as pieces may that share one alone, falls apart there.
    static void appendSound(Footprint land, std::vector<Footprint>& out) {
        if (!plan::firstFault(land)) {
            out.push_back(std::move(land));
            return;
        }
        const Footprint smaller = plan::offset(land, -1e-3);
        for (const plan::Polygon& polygon : smaller.polygons)
            if (area(polygon) > leastPart_m2 && !plan::firstFault({{polygon}, smaller.tags}))
                out.push_back({{polygon}, smaller.tags});
    }

    /// A lot, and what of its strip no street joins to it.
    void finish(std::vector<Footprint>& pieces, std::vector<Lot>& out) {
        for (Footprint& land : joined(pieces)) {
            if (streetOf(land.polygons[0], isStreet_) > 0)
                out.push_back(lotOf(std::move(land.polygons[0]), block_.tags, isStreet_));
            else
                behind_.push_back(std::move(land));
        }
    }

    const Footprint& block_;
    const LotParameters& parameters_;
    const uint64_t key_;
    const std::vector<PlacedEdge> edges_;
    const StreetTags isStreet_;
    std::vector<std::vector<Vec2>> faces_;
    std::vector<std::vector<Footprint>> land_;  ///< by edge
    std::vector<Footprint> behind_;
    std::vector<Side> sides_;
    std::vector<uint32_t> rank_;  ///< of sides, the longest first
    std::vector<std::vector<Footprint>> lots_;
    std::vector<std::pair<double, double>> bounds_;  ///< of lots, along their side
    double deep_m_ = 0;
};

}  // namespace

bool cutBySkeleton(const Footprint& block, const LotParameters& parameters, uint64_t key, const Progress* progress,
                   std::vector<Lot>& out) {
    return StripCutter(block, parameters, key).run(progress, out);
}

}  // namespace sgm::town
