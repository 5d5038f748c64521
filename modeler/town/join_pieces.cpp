#include "modeler/town/join_pieces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "modeler/plan/validate.h"

namespace sgm::town {
namespace {

using plan::Footprint;
using plan::Ring;
using plan::Vec2;

constexpr double same_m = 1e-3;    // points nearer than this are one
constexpr double onEdge_m = 1e-4;  // points nearer to an edge than this divide it

using Key = std::pair<double, double>;
Key keyOf(Vec2 p) { return {p.x, p.z}; }

/// Makes points of all rings that lie on one another equal.
void snap(std::vector<Ring>& rings) {
    std::vector<Vec2> known;
    for (Ring& ring : rings) {
        for (Vec2& p : ring.points) {
            const auto same = std::find_if(known.begin(), known.end(), [&](Vec2 q) { return length(p - q) < same_m; });
            if (same == known.end())
                known.push_back(p);
            else
                p = *same;
        }
        for (size_t i = ring.size(); i-- > 0 && ring.size() > 2;)
            if (ring.from(i) == ring.to(i)) {
                ring.points.erase(ring.points.begin() + static_cast<ptrdiff_t>(i));
                ring.edges.erase(ring.edges.begin() + static_cast<ptrdiff_t>(i));
            }
    }
}

/// Points of one ring that lie in an edge of another become points of both.
void divide(std::vector<Ring>& rings) {
    for (Ring& ring : rings)
        for (const Ring& other : rings) {
            if (&other == &ring) continue;
            for (const Vec2 p : other.points)
                for (size_t i = 0; i < ring.size(); ++i) {
                    const Vec2 a = ring.from(i), ab = ring.to(i) - a;
                    const double whole = length(ab), t = dot(p - a, ab) / whole;
                    if (t <= same_m / 2 || t >= whole - same_m / 2 || std::abs(cross(ab, p - a)) > onEdge_m * whole)
                        continue;
                    ring.points.insert(ring.points.begin() + static_cast<ptrdiff_t>(i) + 1, p);
                    ring.edges.insert(ring.edges.begin() + static_cast<ptrdiff_t>(i) + 1, ring.edges[i]);
                    break;
                }
        }
}

/// Directed edges with the inside on their left.
class Boundary {
public:
    explicit Boundary(const std::vector<Ring>& rings) {
        for (const Ring& ring : rings)
            for (size_t i = 0; i < ring.size(); ++i) {
                const Key from = keyOf(ring.from(i)), to = keyOf(ring.to(i));
                auto& back = leaving_[to];
                const auto twin = std::find_if(back.begin(), back.end(), [&](auto& e) { return e.first == from; });
                if (twin != back.end())
                    back.erase(twin);  // both sides are inside
                else
                    leaving_[from].emplace_back(to, ring.edges[i]);
            }
    }

    /// Loops that meet no point twice.
    std::vector<Ring> loops() {
        std::vector<Ring> out;
        for (auto& [start, list] : leaving_)
            while (!list.empty()) follow(start, out);
        return out;
    }

private:
    /// Walks from a point until it comes back; whatever comes back to a point earlier is a loop of its own.
    void follow(Key at, std::vector<Ring>& out) {
        Ring path;
        std::map<Key, size_t> seen{{at, 0}};
        while (true) {
            auto& list = leaving_[at];
            if (list.empty()) return;  // what is left is no loop
            const auto next = sharpestLeft(path, at, list);
            const auto [to, edge] = *next;
            list.erase(next);
            path.points.push_back({at.first, at.second});
            path.edges.push_back(edge);
            at = to;
            const auto known = seen.find(at);
            if (known == seen.end()) {
                seen.emplace(at, path.size());
                continue;
            }
            Ring loop;
            const auto begin = static_cast<ptrdiff_t>(known->second);
            loop.points.assign(path.points.begin() + begin, path.points.end());
            loop.edges.assign(path.edges.begin() + begin, path.edges.end());
            for (size_t i = known->second + 1; i < path.size(); ++i) seen.erase(keyOf(path.points[i]));
            path.points.resize(known->second), path.edges.resize(known->second);
            if (loop.size() >= 3) out.push_back(std::move(loop));
            if (path.size() == 0) return;
        }
    }

    using Leaving = std::vector<std::pair<Key, plan::Edge>>;
    static Leaving::iterator sharpestLeft(const Ring& path, Key at, Leaving& list) {
        if (list.size() == 1 || path.size() == 0) return list.begin();
        const Vec2 here{at.first, at.second}, back = path.points.back() - here;
        // Clockwise from the way back: the first edge bounds the inside that lies left of the way here.
        const auto angle = [&](const std::pair<Key, plan::Edge>& e) {
            const Vec2 d = Vec2{e.first.first, e.first.second} - here;
            const double turn = std::atan2(-cross(back, d), dot(back, d));
            return turn > 0 ? turn : turn + 6.283185307179586;
        };
        return std::min_element(list.begin(), list.end(), [&](auto& a, auto& b) { return angle(a) < angle(b); });
    }

    std::map<Key, Leaving> leaving_;
};

}  // namespace

std::vector<Footprint> joinedPieces(std::vector<Footprint> pieces) {
    if (pieces.size() < 2) return pieces;
    std::vector<Ring> rings;
    for (Footprint& piece : pieces)
        for (plan::Polygon& polygon : piece.polygons) rings.push_back(std::move(polygon.outer));
    snap(rings);
    divide(rings);
    std::vector<Footprint> out;
    std::vector<Ring> courts;
    for (Ring& loop : Boundary(rings).loops()) {
        if (signedArea(loop) > 0)
            out.push_back({{{std::move(loop), {}}}, pieces[0].tags});
        else
            courts.push_back(std::move(loop));
    }
    for (Ring& court : courts) {
        const Vec2 inside = (court.from(0) + court.to(0)) * .5;
        const auto around = std::find_if(out.begin(), out.end(), [&](const Footprint& f) {
            return contains({{{f.polygons[0].outer, {}}}, f.tags}, inside);
        });
        if (around != out.end()) around->polygons[0].courts.push_back(std::move(court));
    }
    for (Footprint& land : out) land = plan::cleaned(land);
    std::erase_if(out, [](const Footprint& land) { return land.empty(); });
    return out;
}

}  // namespace sgm::town
