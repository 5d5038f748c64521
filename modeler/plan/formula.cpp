#include "modeler/plan/formula.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <queue>

#include "modeler/plan/lattice.h"
#include "modeler/plan/validate.h"

namespace sgm::plan {
namespace {

using Kind = FormulaNode::Kind;

/// A ring as a counter-clockwise chain on the lattice; `edges` are the formula's numbers, by the chain's order.
struct Chain {
    std::vector<LatticePoint> points;
    std::vector<uint32_t> edges;
    LatticePoint direction(size_t i) const { return points[i + 1 == points.size() ? 0 : i + 1] - points[i]; }
};

/// Makes the formula of one ring, iteratively: chains may nest as deep as they have edges.
class RingFormula {
public:
    /// `isCourt` swaps maxima and minima: the negation of the hole's formula.
    RingFormula(const Chain& chain, bool isCourt, Formula& into)
        : chain_(chain), max_(isCourt ? Kind::Min : Kind::Max), min_(isCourt ? Kind::Max : Kind::Min), into_(into) {}

    /// The root's number.
    uint32_t build() {
        const size_t n = chain_.points.size();
        const auto [low, high] = std::minmax_element(chain_.points.begin(), chain_.points.end());
        const auto first = static_cast<size_t>(low - chain_.points.begin()),
                   other = static_cast<size_t>(high - chain_.points.begin());
        const uint32_t a = chainFrom(first, (other + n - first) % n), b = chainFrom(other, (first + n - other) % n);
        return node(max_, a, b);
    }

private:
    /// Edges begin … begin + count − 1 of the ring; the first and the last go on as rays.
    struct Piece {
        size_t begin, count;
    };
    /// What is left to do: a piece, or to join the last two results.
    struct Task {
        Piece piece;
        std::optional<Kind> join;
    };

    uint32_t node(Kind kind, uint32_t first, uint32_t second = 0) {
        into_.nodes.push_back({kind, first, second});
        return static_cast<uint32_t>(into_.nodes.size() - 1);
    }

    size_t wrapped(size_t i) const { return i % chain_.points.size(); }
    LatticePoint point(size_t i) const { return chain_.points[wrapped(i)]; }
    LatticePoint direction(size_t i) const { return chain_.direction(wrapped(i)); }

    uint32_t chainFrom(size_t begin, size_t count) {
        std::vector<Task> tasks{{{begin, count}, {}}};
        std::vector<uint32_t> done;
        while (!tasks.empty()) {
            const Task task = tasks.back();
            tasks.pop_back();
            if (task.join) {
                const uint32_t second = done.back();
                done.pop_back();
                done.back() = node(*task.join, done.back(), second);
            } else if (task.piece.count == 1) {
                done.push_back(node(Kind::Edge, chain_.edges[wrapped(task.piece.begin)]));
            } else {
                const size_t at = cornerOf(task.piece);
                const bool convex = signOf(wideCross(direction(at - 1), direction(at))) >= 0;
                tasks.push_back({{}, convex ? max_ : min_});
                tasks.push_back({{at, task.piece.begin + task.piece.count - at}, {}});
                tasks.push_back({{task.piece.begin, at - task.piece.begin}, {}});
            }
        }
        return done.back();
    }

    /// A corner inside the piece that lies on the convex hull of the piece with its rays: the one of those found that
    /// is nearest to the middle. The hull's support lies in directions that neither ray goes to; where the two that are
    /// square to a ray, and their sum, look for it, some corner is found unless all is straight.
    size_t cornerOf(const Piece& piece) const {
        const size_t last = piece.begin + piece.count - 1;
        const LatticePoint back = -direction(piece.begin), on = direction(last);
        const LatticePoint across{-back.z, back.x}, acrossOn{-on.z, on.x};
        const int side = signOf(wideDot(across, on)), sideOn = signOf(wideDot(acrossOn, back));
        std::vector<LatticePoint> ways;
        if (side == 0 && signOf(wideDot(back, on)) < 0) {
            ways = {across, -across};
        } else {
            const LatticePoint a = side > 0 ? -across : across, b = sideOn > 0 ? -acrossOn : acrossOn;
            ways = {a, b};
            if (side == 0)
                ways.insert(ways.end(), {-a, -back});
            else
                ways.push_back({a.x / 2 + b.x / 2, a.z / 2 + b.z / 2});
        }
        size_t best = piece.begin + piece.count / 2, bestOff = piece.count;  // all is straight
        for (const LatticePoint way : ways)
            if (const auto corner = extreme(piece, way, back, on)) {
                const size_t middle = piece.begin + piece.count / 2;
                const size_t off = *corner > middle ? *corner - middle : middle - *corner;
                if (off < bestOff) best = *corner, bestOff = off;
            }
        return best;
    }

    /// The corner farthest towards `way`, the end of what lies level with it that no ray runs along; nothing where rays
    /// go there or run along both ends.
    std::optional<size_t> extreme(const Piece& piece, LatticePoint way, LatticePoint back, LatticePoint on) const {
        if (way == LatticePoint{} || signOf(wideDot(way, back)) > 0 || signOf(wideDot(way, on)) > 0) return {};
        const LatticePoint from = point(piece.begin + 1);
        const LatticePoint level{-way.z, way.x};
        size_t low = piece.begin + 1, high = low;  // along `level`
        Wide most = 0, lowAt = 0, highAt = 0;
        for (size_t i = piece.begin + 2; i < piece.begin + piece.count; ++i) {
            const LatticePoint p = point(i) - from;
            const Wide far = wideDot(way, p);
            if (far < most) continue;
            const Wide along = wideDot(level, p);
            if (far > most) most = far, low = high = i, lowAt = highAt = along;
            if (along < lowAt) low = i, lowAt = along;
            if (along > highAt) high = i, highAt = along;
        }
        bool lowFree = true, highFree = true;  // does a ray run along the level line beyond that end?
        const auto look = [&](LatticePoint ray, size_t end) {
            if (signOf(wideDot(way, ray)) != 0 || wideDot(way, point(end) - from) != most) return;
            (signOf(wideDot(level, ray)) > 0 ? highFree : lowFree) = false;
        };
        look(back, piece.begin + 1);
        look(on, piece.begin + piece.count - 1);
        if (highFree) return high;
        if (lowFree) return low;
        return {};
    }

    const Chain& chain_;
    const Kind max_, min_;
    Formula& into_;
};

/// The ring as a counter-clockwise chain: a court's runs backwards.
Chain chainOf(const Ring& ring, bool isCourt, uint32_t firstEdge) {
    Chain chain;
    const size_t n = ring.size();
    for (size_t i = 0; i < n; ++i) {
        chain.points.push_back(latticePoint(ring.points[isCourt ? n - 1 - i : i]));
        chain.edges.push_back(firstEdge + static_cast<uint32_t>(isCourt ? (2 * n - 2 - i) % n : i));
    }
    return chain;
}

uint32_t joined(Kind kind, std::span<const uint32_t> roots, Formula& formula) {
    if (roots.size() == 1) return roots[0];
    const uint32_t first = joined(kind, roots.first(roots.size() / 2), formula),
                   second = joined(kind, roots.subspan(roots.size() / 2), formula);
    formula.nodes.push_back({kind, first, second});
    return static_cast<uint32_t>(formula.nodes.size() - 1);
}

double combined(Kind kind, double a, double b) { return kind == Kind::Max ? std::max(a, b) : std::min(a, b); }

}  // namespace

Result<Formula> monotoneFormula(const Footprint& footprint) {
    Limits loose;
    loose.leastEdge_m = 0, loose.leastArea_m2 = 0, loose.farthest_m = 1e6, loose.mostPoints = 10'000'000;
    if (const auto fault = firstFault(footprint, loose))
        return Error{Error::Kind::Input, sentenceOf(*fault, footprint)};
    return formulaOfSound(footprint);
}

Formula formulaOfSound(const Footprint& footprint) {
    Formula formula;
    formula.nodes.reserve(2 * footprint.edgeCount());
    uint32_t firstEdge = 0;
    std::vector<uint32_t> polygons;
    for (const Polygon& polygon : footprint.polygons) {
        std::vector<uint32_t> rings;
        const auto add = [&](const Ring& ring, bool isCourt) {
            const Chain chain = chainOf(ring, isCourt, firstEdge);
            rings.push_back(RingFormula(chain, isCourt, formula).build());
            firstEdge += static_cast<uint32_t>(ring.size());
        };
        add(polygon.outer, false);
        for (const Ring& court : polygon.courts) add(court, true);
        polygons.push_back(joined(Kind::Max, rings, formula));
    }
    joined(Kind::Min, polygons, formula);
    return formula;
}

std::vector<Linear> distancesOf(const Footprint& footprint) {
    std::vector<Linear> all;
    for (const PlacedEdge& edge : edgesOf(footprint)) {
        const Vec2 n = edge.normal();
        all.push_back({n.x, n.z, -dot(n, edge.from)});
    }
    return all;
}

double valueOf(const Formula& formula, std::span<const Linear> leaves, Vec2 p) {
    thread_local std::vector<double> values;
    values.resize(formula.nodes.size());
    for (size_t i = 0; i < formula.nodes.size(); ++i) {
        const FormulaNode& node = formula.nodes[i];
        values[i] = node.kind == Kind::Edge ? leaves[node.first].at(p)
                                            : combined(node.kind, values[node.first], values[node.second]);
    }
    return values.back();
}

}  // namespace sgm::plan
