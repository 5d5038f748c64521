// The largest rectangle along the axes inside a footprint.
#include <algorithm>
#include <span>

#include "modeler/plan/edit.h"

namespace sgm::plan {
namespace {

struct Interval {
    double lo, hi;
};
using Intervals = std::vector<Interval>;

/// Strips of x between neighbouring places, one after the other, and what of z lies inside all over each.
class Strips {
public:
    Strips(const std::vector<PlacedEdge>& edges, const std::vector<double>& at) {
        for (size_t i = 0; i + 1 < at.size(); ++i) {
            add(edges, at[i], at[i + 1]);
            double most = 0;
            for (const Interval& z : inside(i)) most = std::max(most, z.hi - z.lo);
            tallest_.push_back(most);
        }
    }
    size_t size() const { return tallest_.size(); }
    std::span<const Interval> inside(size_t strip) const {
        return std::span(intervals_).subspan(first_[strip], first_[strip + 1] - first_[strip]);
    }
    /// The longest interval of a strip.
    double tallest(size_t strip) const { return tallest_[strip]; }

private:
    struct Crossing {
        double middle, least, most;
    };
    /// A strip in which no corner lies: edges are straight across it.
    void add(const std::vector<PlacedEdge>& edges, double lo, double hi) {
        crossings_.clear();
        const double at = (lo + hi) / 2;
        for (const PlacedEdge& e : edges) {
            if ((e.from.x <= at) == (e.to.x <= at)) continue;
            const auto z = [&](double x) {
                return e.from.z + (x - e.from.x) / (e.to.x - e.from.x) * (e.to.z - e.from.z);
            };
            crossings_.push_back({z(at), std::min(z(lo), z(hi)), std::max(z(lo), z(hi))});
        }
        std::sort(crossings_.begin(), crossings_.end(),
                  [](const Crossing& a, const Crossing& b) { return a.middle < b.middle; });
        for (size_t i = 0; i + 1 < crossings_.size(); i += 2)
            if (crossings_[i + 1].least > crossings_[i].most)
                intervals_.push_back({crossings_[i].most, crossings_[i + 1].least});
        first_.push_back(intervals_.size());
    }

    Intervals intervals_;
    std::vector<size_t> first_{0};  ///< by strip
    std::vector<double> tallest_;
    std::vector<Crossing> crossings_;
};

void common(std::span<const Interval> a, std::span<const Interval> b, Intervals& both) {
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
    const Strips strips(edges, at);
    std::optional<Box2> best;
    double most = known ? (1 - 1e-9) * areaOf(*known) : 0;
    // Past the last strip as far as which one that begins with strip i may be larger.
    const auto endFor = [&](size_t i) {
        if (strips.tallest(i) * (at.back() - at[i]) <= most) return i;
        size_t end = strips.size();
        while (end > i && std::min(strips.tallest(i), strips.tallest(end - 1)) * (at[end] - at[i]) <= most) --end;
        return end;
    };
    Intervals open, both;
    for (size_t i = 0; i < strips.size(); ++i) {
        const size_t end = endFor(i);
        for (size_t j = i; j < end && (j == i || !open.empty()); ++j) {
            const std::span<const Interval> inside = strips.inside(j);
            if (j == i)
                open.assign(inside.begin(), inside.end());
            else
                common(open, inside, both), std::swap(open, both);
            double tallest = 0;
            for (const Interval& z : open) {
                tallest = std::max(tallest, z.hi - z.lo);
                if (const double size = (z.hi - z.lo) * (at[j + 1] - at[i]); size > most)
                    most = size, best = Box2{{at[i], z.lo}, {at[j + 1], z.hi}};
            }
            if (tallest * (at[end] - at[i]) <= most) break;  // what follows is no taller
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
