// The largest rectangle along the axes inside a footprint.
#include <algorithm>

#include "modeler/plan/edit.h"

namespace sgm::plan {
namespace {

struct Interval {
    double lo, hi;
};
using Intervals = std::vector<Interval>;

/// What of z lies inside all over a strip of x in which no corner lies: edges are straight across it.
Intervals insideStrip(const std::vector<PlacedEdge>& edges, double lo, double hi) {
    struct Crossing {
        double middle, least, most;
    };
    std::vector<Crossing> crossings;
    const double at = (lo + hi) / 2;
    for (const PlacedEdge& e : edges) {
        if ((e.from.x <= at) == (e.to.x <= at)) continue;
        const auto z = [&](double x) { return e.from.z + (x - e.from.x) / (e.to.x - e.from.x) * (e.to.z - e.from.z); };
        crossings.push_back({z(at), std::min(z(lo), z(hi)), std::max(z(lo), z(hi))});
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.middle < b.middle; });
    Intervals inside;
    for (size_t i = 0; i + 1 < crossings.size(); i += 2)
        if (crossings[i + 1].least > crossings[i].most) inside.push_back({crossings[i].most, crossings[i + 1].least});
    return inside;
}

void common(const Intervals& a, const Intervals& b, Intervals& both) {
    both.clear();
    for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const double lo = std::max(a[i].lo, b[j].lo), hi = std::min(a[i].hi, b[j].hi);
        if (hi > lo) both.push_back({lo, hi});
        ++(a[i].hi < b[j].hi ? i : j);
    }
}

double areaOf(const Box2& box) { return box.size().x * box.size().z; }

/// The largest rectangle whose sides across x lie at two of `at` (ascending); `known` is about as large as one of them,
/// and what can't reach it isn't looked at.
std::optional<Box2> largest(const std::vector<PlacedEdge>& edges, const std::vector<double>& at,
                            const std::optional<Box2>& known = {}) {
    std::vector<Intervals> strips;
    std::vector<double> tallest;
    for (size_t i = 0; i + 1 < at.size(); ++i) {
        strips.push_back(insideStrip(edges, at[i], at[i + 1]));
        tallest.push_back(0);
        for (const Interval& z : strips.back()) tallest.back() = std::max(tallest.back(), z.hi - z.lo);
    }
    std::optional<Box2> best;
    double most = known ? (1 - 1e-9) * areaOf(*known) : 0;
    // Past the last strip as far as which one that begins with strip i may be larger.
    const auto endFor = [&](size_t i) {
        size_t end = strips.size();
        while (end > i && std::min(tallest[i], tallest[end - 1]) * (at[end] - at[i]) <= most) --end;
        return end;
    };
    Intervals open, both;
    for (size_t i = 0; i < strips.size(); ++i) {
        const size_t end = endFor(i);
        for (size_t j = i; j < end && (j == i || !open.empty()); ++j) {
            if (j == i)
                open = strips[i];
            else
                common(open, strips[j], both), std::swap(open, both);
            for (const Interval& z : open)
                if (const double size = (z.hi - z.lo) * (at[j + 1] - at[i]); size > most)
                    most = size, best = Box2{{at[i], z.lo}, {at[j + 1], z.hi}};
        }
    }
    return best ? best : known;
}

}  // namespace

std::optional<Box2> innerRectangle(const Footprint& footprint) {
    constexpr int parts = 64, finer = 16;
    const std::vector<PlacedEdge> edges = edgesOf(footprint);
    if (edges.empty()) return {};
    const Box2 box = bounds(footprint);
    std::vector<double> at;
    for (const PlacedEdge& e : edges) at.push_back(e.from.x);
    const double step = box.size().x / parts;
    const bool isRectilinear = std::all_of(edges.begin(), edges.end(), [](const PlacedEdge& e) {
        return std::abs(e.to.x - e.from.x) < 1e-9 || std::abs(e.to.z - e.from.z) < 1e-9;
    });
    const auto ordered = [](std::vector<double>& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end(), [](double a, double b) { return b - a < 1e-9; }), list.end());
    };
    ordered(at);
    if (isRectilinear) return largest(edges, at);
    // A few sides first: what they find leaves little to look at among many.
    std::optional<Box2> best;
    for (const int apart : {8, 1}) {
        for (int i = apart; i < parts; i += apart) at.push_back(box.lo.x + step * i);
        ordered(at);
        best = largest(edges, at, best);
    }
    if (!best) return best;
    // Once more, finely about the sides found.
    for (int i = -finer; i <= finer; ++i)
        for (const double side : {best->lo.x, best->hi.x})
            at.push_back(std::clamp(side + step * i / finer, box.lo.x, box.hi.x));
    ordered(at);
    return largest(edges, at, best);
}

}  // namespace sgm::plan
