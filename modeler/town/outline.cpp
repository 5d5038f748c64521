#include "modeler/town/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "modeler/plan/edit.h"
#include "modeler/plan/validate.h"

namespace sgm::town {
namespace {

using plan::Vec2;

/// A cell edge: from lattice point (x, z) along +x (axis 0) or +z (axis 1).
struct CellEdge {
    int x = 0, z = 0, axis = 0;
    friend auto operator<=>(const CellEdge&, const CellEdge&) = default;
};

class Squares {
public:
    Squares(const std::function<bool(Vec2)>& holds, Vec2 lo, Vec2 hi, double cell_m)
        : holds_(holds),
          cell_m_(cell_m),
          x0_(begin(lo.x)),
          z0_(begin(lo.z)),
          nx_(end(hi.x) - x0_),
          nz_(end(hi.z) - z0_) {
        inside_.assign(static_cast<size_t>(nx_ + 3) * static_cast<size_t>(nz_ + 3), false);
        for (int i = 0; i <= nx_; ++i)
            for (int k = 0; k <= nz_; ++k) inside_[index(i, k)] = holds_(at(i, k));
    }

    bool any() const { return std::find(inside_.begin(), inside_.end(), true) != inside_.end(); }

    /// Rings with the inside on their left: outlines counter-clockwise, courts clockwise.
    std::vector<std::vector<Vec2>> rings() {
        for (int i = -1; i <= nx_; ++i)
            for (int k = -1; k <= nz_; ++k) march(i, k);
        std::vector<std::vector<Vec2>> out;
        while (!next_.empty()) {
            std::vector<Vec2> ring;
            for (auto step = next_.begin(); step != next_.end();) {
                ring.push_back(crossingOf(step->first));
                const CellEdge to = step->second;
                next_.erase(step);
                step = next_.find(to);
            }
            out.push_back(std::move(ring));
        }
        return out;
    }

private:
    int begin(double m) const { return static_cast<int>(std::floor(m / cell_m_)); }
    int end(double m) const { return static_cast<int>(std::ceil(m / cell_m_)); }
    Vec2 at(int i, int k) const { return {(x0_ + i) * cell_m_, (z0_ + k) * cell_m_}; }
    size_t index(int i, int k) const {
        return static_cast<size_t>(k + 1) * static_cast<size_t>(nx_ + 3) + static_cast<size_t>(i + 1);
    }
    bool inside(int i, int k) const { return inside_[index(i, k)]; }

    /// Between a point inside and one outside. The margin around the rectangle counts as outside.
    Vec2 crossingOf(const CellEdge& e) const {
        Vec2 a = at(e.x, e.z), b = e.axis == 0 ? at(e.x + 1, e.z) : at(e.x, e.z + 1);
        if (!inside(e.x, e.z)) std::swap(a, b);
        for (int i = 0; i < 7; ++i) {
            const Vec2 middle = (a + b) * .5;
            (holds_(middle) ? a : b) = middle;
        }
        return (a + b) * .5;
    }

    /// The pieces of outline in one cell; with the inside on the left they run from one cell edge to another.
    void march(int i, int k) {
        const bool in[4] = {inside(i, k), inside(i + 1, k), inside(i + 1, k + 1), inside(i, k + 1)};
        if (in[0] == in[1] && in[0] == in[2] && in[0] == in[3]) return;
        const CellEdge edges[4] = {{i, k, 0}, {i + 1, k, 1}, {i, k + 1, 0}, {i, k, 1}};  // counter-clockwise
        std::vector<int> leaves, enters;  // going round: edges where the inside ends, where it begins
        for (int s = 0; s < 4; ++s) {
            if (in[s] && !in[(s + 1) % 4]) leaves.push_back(s);
            if (!in[s] && in[(s + 1) % 4]) enters.push_back(s);
        }
        if (leaves.size() == 1) next_[edges[leaves[0]]] = edges[enters[0]];
        if (leaves.size() < 2) return;
        // Opposite corners: the middle says whether they hang together.
        const bool joined = holds_((at(i, k) + at(i + 1, k + 1)) * .5);
        for (const int leave : leaves) {
            const int after = (leave + 1) % 4, before = (leave + 3) % 4;
            next_[edges[leave]] = edges[joined ? after : before];
        }
    }

    const std::function<bool(Vec2)>& holds_;
    double cell_m_;
    int x0_, z0_, nx_, nz_;
    std::vector<bool> inside_;
    std::map<CellEdge, CellEdge> next_;
};

/// What a function has answered at the points of a lattice.
struct LatticeSamples {
    std::function<bool(Vec2)> holds;
    double cell_m = 1;
    int x0 = 0, z0 = 0, nx = 0, nz = 0;
    enum class State : uint8_t { Unknown, No, Yes };
    std::vector<State> known;

    bool at(Vec2 p) {
        const double i = std::nearbyint(p.x / cell_m), k = std::nearbyint(p.z / cell_m);
        const bool isPoint = i * cell_m == p.x && k * cell_m == p.z;
        if (!isPoint || i < x0 || k < z0 || i >= x0 + nx || k >= z0 + nz) return holds(p);
        State& state = known[static_cast<size_t>(k - z0) * static_cast<size_t>(nx) + static_cast<size_t>(i - x0)];
        if (state == State::Unknown) state = holds(p) ? State::Yes : State::No;
        return state == State::Yes;
    }
};

}  // namespace

std::function<bool(Vec2)> remembered(std::function<bool(Vec2)> holds, Vec2 lo, Vec2 hi, double cell_m) {
    if (!holds) return holds;
    const auto samples = std::make_shared<LatticeSamples>();
    samples->holds = std::move(holds), samples->cell_m = cell_m;
    samples->x0 = static_cast<int>(std::floor(lo.x / cell_m)),
    samples->z0 = static_cast<int>(std::floor(lo.z / cell_m));
    samples->nx = static_cast<int>(std::ceil(hi.x / cell_m)) - samples->x0 + 1;
    samples->nz = static_cast<int>(std::ceil(hi.z / cell_m)) - samples->z0 + 1;
    samples->known.assign(static_cast<size_t>(samples->nx) * static_cast<size_t>(samples->nz),
                          LatticeSamples::State::Unknown);
    return [samples](Vec2 p) { return samples->at(p); };
}

plan::Footprint outlineOf(const std::function<bool(Vec2)>& holds, Vec2 lo, Vec2 hi, double cell_m,
                          const std::string& tag) {
    // Land in more pieces than anybody could draw is told by a coarser lattice.
    constexpr size_t mostPoints = 20'000;
    std::vector<std::vector<Vec2>> rings;
    for (int tries = 0; tries < 12; ++tries, cell_m *= 2) {
        Squares squares(holds, lo, hi, cell_m);
        if (!squares.any()) return {};
        rings = squares.rings();
        size_t points = 0;
        for (const auto& ring : rings) points += ring.size();
        if (points <= mostPoints) break;
    }
    plan::Footprint out;
    const plan::Edge edge{out.tag(tag), plan::EdgeSource::Side};
    for (std::vector<Vec2>& ring : rings)
        if (ring.size() >= 3) out.polygons.push_back({plan::ringOf(std::move(ring), edge), {}});
    // Courts are told from outlines by their sense; `resolved` sorts them by winding.
    auto resolved = plan::resolved(out);
    if (!resolved.ok()) return {};
    plan::Footprint box = plan::footprintOf(plan::polygonOf({lo, {hi.x, lo.z}, hi, {lo.x, hi.z}}));
    return plan::boolean(plan::Boolean::Intersection, plan::cleaned(*resolved, cell_m / 20, cell_m / 40), box);
}

}  // namespace sgm::town
