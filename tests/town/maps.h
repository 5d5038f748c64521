// Maps made of formulas, for tests.
// Enters: numbers. Leaves: lands. Assumes nothing.
#pragma once

#include <cmath>

#include "modeler/town/grow.h"

namespace sgm::town::test {

/// A hill of people about (x, z).
inline double hill(Vec2 p, Vec2 at, double radius) {
    const Vec2 d = p - at;
    return std::max(0.0, 1 - dot(d, d) / (radius * radius));
}

/// Two centres, a river that winds from west to east, and a round park.
inline Land valley() {
    Land land;
    land.pull = [](Vec2 p) { return hill(p, {-200, -150}, 900) + .6 * hill(p, {500, 350}, 600); };
    land.spread = [pull = land.pull](Vec2 p) { return pull(p) > .15; };
    land.water = [](Vec2 p) { return std::abs(p.z - 120 - .25 * p.x + p.x * p.x / 8000) < 30; };
    land.park = [](Vec2 p) { return length(p - Vec2{-150, -420}) < 110; };
    return land;
}

}  // namespace sgm::town::test
