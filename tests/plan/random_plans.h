// Random simple plans of many kinds, with courts.
// Enters: keys. Leaves: sound footprints, the same for the same key. Assumes sizes of about 20 m.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "modeler/core/conventions.h"
#include "modeler/core/random.h"
#include "modeler/plan/validate.h"

namespace sgm::plan::test {

/// A stream of draws.
class Draws {
public:
    explicit Draws(uint64_t key) : key_(key) {}
    double real(double lo, double hi) { return uniform(combine(key_, ++counter_), lo, hi); }
    int whole(int lo, int hi) {
        return lo + static_cast<int>(pick(combine(key_, ++counter_), static_cast<uint64_t>(hi - lo + 1)));
    }
    bool chance(double share) { return real(0, 1) < share; }

private:
    uint64_t key_, counter_ = 0;
};

inline std::vector<Vec2> star(Draws& draw, int n, double least, double most, Vec2 about = {}) {
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * (i + draw.real(-.3, .3)) / n, r = draw.real(least, most);
        points.push_back({about.x + r * std::cos(angle), about.z + r * std::sin(angle)});
    }
    return points;
}

/// Random points joined by the tour that 2-opt moves leave without crossings.
inline std::vector<Vec2> untangled(Draws& draw, int n) {
    std::vector<Vec2> p;
    for (int i = 0; i < n; ++i) p.push_back({draw.real(-10, 10), draw.real(-10, 10)});
    const auto crossing = [&](Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
        return (cross(b - a, c - a) > 0) != (cross(b - a, d - a) > 0) &&
               (cross(d - c, a - c) > 0) != (cross(d - c, b - c) > 0);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < p.size(); ++i)
            for (size_t j = i + 2; j < p.size(); ++j)
                if (crossing(p[i], p[i + 1], p[j], p[(j + 1) % p.size()])) {
                    std::reverse(p.begin() + static_cast<ptrdiff_t>(i) + 1, p.begin() + static_cast<ptrdiff_t>(j) + 1);
                    changed = true;
                }
    }
    return p;
}

inline std::vector<Vec2> comb(Draws& draw, int teeth) {
    std::vector<Vec2> points;
    const double depth = draw.real(2, 15), lean = draw.real(-.4, .4), back = draw.real(1, 3);
    for (int i = 0; i < teeth; ++i) {
        const double x = i * 2.0;
        points.push_back({x, 0});
        points.push_back({x + lean, -depth * draw.real(.7, 1)});
        points.push_back({x + lean + .8, -depth});
        points.push_back({x + 1, 0});
    }
    points.push_back({teeth * 2.0 - 1, back});
    points.push_back({0, back});
    return points;
}

/// A band that winds inward.
inline std::vector<Vec2> spiral(Draws& draw, int steps) {
    std::vector<Vec2> outside, inside;
    const double turn = draw.real(.25, .7), pitch = draw.real(.5, 1), width = draw.real(.3, .8) * 2 * pi * pitch / 2;
    for (int i = 0; i <= steps; ++i) {
        const double angle = i * turn, r = 3 + pitch * angle;
        outside.push_back({(r + width) * std::cos(angle), (r + width) * std::sin(angle)});
        inside.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    outside.insert(outside.end(), inside.rbegin(), inside.rend());
    return outside;
}

inline std::vector<Vec2> kochIsland(int passes) {
    std::vector<Vec2> p{{0, 0}, {16, 0}, {16, 16}, {0, 16}};
    for (int pass = 0; pass < passes; ++pass) {
        std::vector<Vec2> next;
        for (size_t i = 0; i < p.size(); ++i) {
            const Vec2 a = p[i], d = (p[(i + 1) % p.size()] - a) * .25, l{-d.z, d.x};
            next.insert(next.end(),
                        {a, a + d, a + d + l, a + d * 2 + l, a + d * 2, a + d * 2 - l, a + d * 3 - l, a + d * 3});
        }
        p = next;
    }
    return p;
}

/// A random set of cells that hangs together by sides, without two that touch in a corner alone, its holes as courts;
/// columns and rows are of random widths.
inline Footprint rectilinear(Draws& draw, int side, int cells, bool withCourts = true) {
    std::vector<std::vector<char>> in(side + 2, std::vector<char>(side + 2));
    const auto touches = [&](int x, int z) {  // would make a corner contact?
        for (const int dx : {-1, 1})
            for (const int dz : {-1, 1})
                if (in[x + dx][z + dz] && !in[x + dx][z] && !in[x][z + dz]) return true;
        return false;
    };
    in[side / 2][side / 2] = 1;
    for (int n = 1, tries = 0; n < cells && tries < 60 * cells; ++tries) {
        const int x = draw.whole(1, side), z = draw.whole(1, side);
        if (in[x][z] || !(in[x - 1][z] || in[x + 1][z] || in[x][z - 1] || in[x][z + 1]) || touches(x, z)) continue;
        in[x][z] = 1, ++n;
    }
    std::vector<double> at_x{0}, at_z{0};
    for (int i = 0; i < side + 2; ++i)
        at_x.push_back(at_x.back() + draw.real(.8, 4)), at_z.push_back(at_z.back() + draw.real(.8, 4));
    std::map<std::pair<int, int>, std::pair<int, int>> next;  // solid on the left
    for (int x = 1; x <= side; ++x)
        for (int z = 1; z <= side; ++z) {
            if (!in[x][z]) continue;
            if (!in[x][z - 1]) next[{x, z}] = {x + 1, z};
            if (!in[x + 1][z]) next[{x + 1, z}] = {x + 1, z + 1};
            if (!in[x][z + 1]) next[{x + 1, z + 1}] = {x, z + 1};
            if (!in[x - 1][z]) next[{x, z + 1}] = {x, z};
        }
    Footprint result;
    Polygon polygon;
    while (!next.empty()) {
        std::vector<Vec2> points;
        for (auto at = next.begin()->first; next.count(at);) {
            points.push_back({at_x[at.first], at_z[at.second]});
            const auto to = next[at];
            next.erase(at);
            at = to;
        }
        Ring ring = ringOf(points);
        if (signedArea(ring) > 0)
            polygon.outer = ring;
        else if (withCourts)
            polygon.courts.push_back(ring);
    }
    result.polygons.push_back(polygon);
    return cleaned(result);
}

/// With up to `most` courts of any form, each in its own free circle.
inline void addCourts(Draws& draw, Footprint& footprint, int most) {
    const Box2 box = bounds(footprint);
    for (int i = 0, tries = 0; i < most && tries < 40; ++tries) {
        const Vec2 at{draw.real(box.lo.x, box.hi.x), draw.real(box.lo.z, box.hi.z)};
        if (!contains(footprint, at)) continue;
        const double free = .9 * distanceToEdges(footprint, at);
        if (free < .2) continue;
        Ring court = ringOf(star(draw, draw.whole(3, 9), free * .4, free, at), {0, EdgeSource::Court});
        footprint.polygons[0].courts.push_back(signedArea(court) > 0 ? reversed(court) : court);
        ++i;
    }
}

/// Any of them; unsound drafts (a spiral may touch itself) are drawn again.
inline Footprint anyPlan(uint64_t key) {
    for (uint64_t attempt = 0;; ++attempt) {
        Draws draw(combine(key, attempt));
        Footprint f;
        switch (draw.whole(0, 6)) {
            case 0:
                f = footprintOf(polygonOf(star(draw, draw.whole(3, 40), 2, 10)));
                break;
            case 1:
                f = footprintOf(polygonOf(untangled(draw, draw.whole(5, 24))));
                break;
            case 2:
                f = rectilinear(draw, 9, draw.whole(3, 40));
                break;
            case 3:
                f = footprintOf(polygonOf(comb(draw, draw.whole(2, 12))));
                break;
            case 4:
                f = footprintOf(polygonOf(spiral(draw, draw.whole(4, 30))));
                break;
            case 5:
                f = footprintOf(polygonOf(kochIsland(draw.whole(0, 2))));
                break;
            default:
                f = footprintOf(polygonOf(star(draw, draw.whole(4, 12), 9, 10)));
        }
        f = turned(f, draw.real(0, 6.28));
        if (firstFault(f)) continue;
        addCourts(draw, f, draw.chance(.5) ? draw.whole(1, 4) : 0);
        if (!firstFault(f)) return f;
    }
}

}  // namespace sgm::plan::test
