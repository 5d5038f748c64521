// Every case of marching cubes against the rule in marching_cubes.h, without using how the table was made.
#include "modeler/mesh/marching_cubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "modeler/core/random.h"
#include "tests/mesh/exact_crossing.h"

namespace sgm::mesh {
namespace {

using Segment = std::pair<int, int>;

bool inside(int mask, int corner) { return (mask >> corner & 1) != 0; }
int highCorner(int edge) { return edgeCorner(edge) | 1 << edgeAxis(edge); }

/// Bit 2·axis + side for the two faces an edge lies on.
int facesOf(int edge) {
    int faces = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (axis != edgeAxis(edge)) faces |= 1 << (2 * axis + (edgeCorner(edge) >> axis & 1));
    return faces;
}

std::vector<std::array<int, 3>> trianglesOf(int mask) {
    const CellCase& c = caseTable()[mask];
    std::vector<std::array<int, 3>> triangles;
    for (int t = 0; t < c.triangles; ++t) triangles.push_back({c.edges[3 * t], c.edges[3 * t + 1], c.edges[3 * t + 2]});
    return triangles;
}

/// Directed sides of triangles that no other triangle of the case runs back along: the rim of the patch.
std::set<Segment> rimOf(int mask) {
    std::set<Segment> rim;
    for (const auto& t : trianglesOf(mask))
        for (int i = 0; i < 3; ++i) {
            const Segment side{t[i], t[(i + 1) % 3]};
            if (rim.erase({side.second, side.first}) == 0) {
                EXPECT_TRUE(rim.insert(side).second) << "case " << mask << ": two triangles run the same way";
            }
        }
    return rim;
}

TEST(MarchingCubes, UsesExactlyTheEdgesWhoseEndsDiffer) {
    for (int mask = 0; mask < 256; ++mask) {
        std::set<int> used, expected;
        for (const auto& t : trianglesOf(mask)) used.insert(t.begin(), t.end());
        for (int e = 0; e < edgesPerCell; ++e)
            if (inside(mask, edgeCorner(e)) != inside(mask, highCorner(e))) expected.insert(e);
        EXPECT_EQ(used, expected) << "case " << mask;
    }
}

TEST(MarchingCubes, TouchesFacesOnlyAtTheRim) {
    for (int mask = 0; mask < 256; ++mask) {
        const std::set<Segment> rim = rimOf(mask);
        for (const auto& [a, b] : rim)
            EXPECT_NE(facesOf(a) & facesOf(b), 0) << "case " << mask << ": a rim leaves the faces";
        for (const auto& t : trianglesOf(mask))
            for (int i = 0; i < 3; ++i) {
                const int a = t[i], b = t[(i + 1) % 3];
                const bool chord = !rim.count({a, b}) && !rim.count({b, a});
                EXPECT_TRUE(!chord || (facesOf(a) & facesOf(b)) == 0) << "case " << mask << ": chord in a face";
            }
    }
}

TEST(MarchingCubes, CutsInsideCornersApartOnAmbiguousFaces) {
    for (int mask = 0; mask < 256; ++mask)
        for (const auto& [a, b] : rimOf(mask)) {
            // On an ambiguous face a segment's two edges must meet at an inside corner.
            for (int axis = 0; axis < 3; ++axis)
                for (int side = 0; side < 2; ++side) {
                    if (!(facesOf(a) & facesOf(b) & 1 << (2 * axis + side))) continue;
                    std::vector<int> in;
                    for (int c = 0; c < 8; ++c)
                        if ((c >> axis & 1) == side && inside(mask, c)) in.push_back(c);
                    const bool ambiguous = in.size() == 2 && ((in[0] ^ in[1]) & ~(1 << axis)) == (7 & ~(1 << axis));
                    if (!ambiguous) continue;
                    const std::set<int> ends{edgeCorner(a), highCorner(a)};
                    const int shared = ends.count(edgeCorner(b))   ? edgeCorner(b)
                                       : ends.count(highCorner(b)) ? highCorner(b)
                                                                   : -1;
                    ASSERT_GE(shared, 0) << "case " << mask;
                    EXPECT_TRUE(inside(mask, shared)) << "case " << mask;
                }
        }
}

/// The rim on one face, with edges named as seen from the low cell (side 1) or the high cell (side 0) of the shared
/// face.
std::set<Segment> rimOnFace(int mask, int axis, int side) {
    const auto lowered = [&](int edge) {  // the same edge of the other cell
        for (int e = 0; e < edgesPerCell; ++e)
            if (edgeAxis(e) == edgeAxis(edge) && edgeCorner(e) == (edgeCorner(edge) & ~(1 << axis))) return e;
        return -1;
    };
    std::set<Segment> result;
    for (const auto& [a, b] : rimOf(mask))
        if (facesOf(a) & facesOf(b) & 1 << (2 * axis + side)) result.insert({lowered(a), lowered(b)});
    return result;
}

TEST(MarchingCubes, NeighboursAgreeOnTheFaceTheyShare) {
    int pairs = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::map<int, std::set<Segment>> low;  // by the four signs on the face
        const auto signs = [&](int mask, int side) {
            int s = 0, bit = 0;
            for (int c = 0; c < 8; ++c)
                if ((c >> axis & 1) == side) s |= inside(mask, c) << bit++;
            return s;
        };
        for (int a = 0; a < 256; ++a)
            for (int b = 0; b < 256; ++b) {
                if (signs(a, 1) != signs(b, 0)) continue;
                std::set<Segment> reversed;
                for (const auto& [p, q] : rimOnFace(b, axis, 0)) reversed.insert({q, p});
                ASSERT_EQ(rimOnFace(a, axis, 1), reversed) << "cases " << a << " and " << b << " along axis " << axis;
                ++pairs;
            }
    }
    EXPECT_EQ(pairs, 3 * 256 * 16);
}

/// Outward: from an inside to an outside corner through every triangle.
TEST(MarchingCubes, OneCornerIsCutOffFacingOutwards) {
    for (int corner = 0; corner < 8; ++corner) {
        const auto triangles = trianglesOf(1 << corner);
        ASSERT_EQ(triangles.size(), 1u);
        const std::array<Point, edgesPerCell> at = pointsOnEdges([](int) { return gridUnits / 2; });
        const Point inner{(corner & 1) * gridUnits, (corner >> 1 & 1) * gridUnits, (corner >> 2) * gridUnits};
        EXPECT_LT(orient(at[triangles[0][0]], at[triangles[0][1]], at[triangles[0][2]], inner), 0);
    }
}

/// The promise that no mesh crosses itself: exact integer tests over extreme and random places on the edges.
TEST(MarchingCubes, TrianglesOfACellNeverCross) {
    uint64_t key = 1;
    for (int mask = 1; mask < 255; ++mask) {
        const auto triangles = trianglesOf(mask);
        if (triangles.size() < 2) continue;
        for (int trial = 0; trial < 2000; ++trial) {
            const std::array<Point, edgesPerCell> at = pointsOnEdges([&](int) -> int64_t {
                const auto place = static_cast<int64_t>(1 + pick(++key, gridUnits - 1));
                const uint64_t kind = pick(++key, 4);
                if (trial % 3 == 0 || kind == 3) return place;
                return kind == 0 ? 1 : kind == 1 ? gridUnits - 1 : trial % 3 == 1 ? place : gridUnits / 2;
            });
            for (size_t i = 0; i < triangles.size(); ++i)
                for (size_t j = i + 1; j < triangles.size(); ++j)
                    ASSERT_FALSE(cross(triangles[i], triangles[j], at)) << "case " << mask;
        }
    }
}

/// The check above can fail: 4 of the 16 triangulations of this loop of seven cross themselves.
TEST(MarchingCubes, TheCrossingCheckSeesABadTriangulation) {
    const std::array<std::array<int, 3>, 2> bad{{{0, 5, 11}, {0, 11, 10}}};
    const std::array<std::array<int, 3>, 3> rest{{{6, 7, 9}, {10, 6, 9}, {0, 10, 9}}};
    bool seen = false;
    uint64_t key = 7;
    for (int trial = 0; trial < 20000 && !seen; ++trial) {
        const auto at = pointsOnEdges([&](int) -> int64_t { return pick(++key, 2) ? 1 : gridUnits - 1; });
        for (const auto& a : bad)
            for (const auto& b : rest) seen |= cross(a, b, at);
    }
    EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace sgm::mesh
