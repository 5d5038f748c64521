// Rims of round buildings, feet of turned ones and ledges: creases and corners there leave faces and cells.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grammar/lower/off_surface.h"
#include "modeler/core/conventions.h"
#include "modeler/mesh/corners.h"
#include "modeler/mesh/validate.h"
#include "tests/pipeline/crisp_model.h"
#include "tests/pipeline/faces_of.h"

namespace sgm::pipeline {
namespace {

/// The usual mesh of a grammar 2 text.
mesh::Mesh usualMesh(const std::string& text, int resolution) {
    Context context{nullptr, 2};
    CrispModel made = crispModel(acrossGrid(modelOf("grammar 2\n" + text, context)), resolution, context);
    return made.edit({}, context).value();
}

/// Calls `visit` with each triangle and the normal of each of its corners, but for slivers.
template <class Visit>
void eachCorner(const mesh::Mesh& mesh, const Visit& visit) {
    for (const Face& face : facesOf(mesh)) {
        const auto& [a, b, c] = face.places;
        const float longest = std::max({length(b - a), length(c - b), length(a - c)});
        if (length(face.across()) < .02f * longest * longest) continue;
        for (const Vec3f& normal : face.normals) visit(face, normal);
    }
}

TEST(Rims, OfDrumsLeaveNormalsOfTheWalls) {
    const mesh::Mesh mesh = usualMesh(
        "start A -> cylinder size (4.2, 3, 4.2) + cylinder size (7m, .4m, 7m) at +y + cylinder size (9, 15, 9) at -y\n",
        96);
    eachCorner(mesh, [](const Face& face, Vec3f normal) {
        const Vec3f at = face.middle();
        EXPECT_GT(dot(normalized(face.across()), normal), .6f) << at.x << ' ' << at.y << ' ' << at.z;
    });
}

TEST(Rims, OfDomesKeepTheNormalsOfTheirSegments) {
    const mesh::Mesh mesh =
        usualMesh("start A -> footprint round(48, 6m) extrude 4m B\nrule B -> domeRoof size (100%, 5m, 100%)\n", 128);
    // Of a vertex on a crease whose block has no other part of it the piece isn't asked for.
    double all_m2 = 0, others_m2 = 0;
    eachCorner(mesh, [&](const Face& face, Vec3f normal) {
        const Vec3f own = normalized(face.across());
        if (std::abs(own.y) > .9f) return;
        const double apart = std::atan2(own.x, own.z) - std::atan2(normal.x, normal.z), area_m2 = length(face.across());
        all_m2 += area_m2 / 2;
        if (std::abs(std::remainder(apart, 2 * pi)) > radians(3)) others_m2 += area_m2 / 2;  // a segment spans 7.5
    });
    EXPECT_GT(all_m2, 100);
    EXPECT_LT(others_m2, 1e-4 * all_m2);
}

TEST(Rims, OfPrismsHaveNoChamfers) {
    const mesh::Mesh mesh =
        usualMesh("terminal solid\nstart A -> size (40m, 12m, 40m) solid footprint ngon(64, 20m)\n", 512);
    const double apothem_m = 20 * std::cos(pi / 64);
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const Vec3f p : chunk.positions)
            EXPECT_GT(std::hypot(p.x, p.z), apothem_m - 1e-4) << p.x << ' ' << p.y << ' ' << p.z;
}

/// Two creases in one layer of cells: corners were chamfered, by up to a fifth of a cell, where the grid lay badly.
TEST(Ledges, AreExactInCellsOfAnySize) {
    const std::pair<const char*, size_t> piers[] = {
        {"cube size (2.46m, .35m, 4.3m) move (0, 1m, 0)", 44},
        {"cube size (1.23m, .35m, 4.3m) move (.615m, 1m, 0) + cube size (1.23m, .35m, 4.3m) move (-.615m, 1m, 0)", 76}};
    for (const auto& [belt, most] : piers)
        for (const int resolution : {17, 20, 24, 28, 31, 40}) {
            const mesh::Mesh mesh =
                usualMesh(fmt::format("start A -> cube size (2.16m, 10m, 4m) + {}\n", belt), resolution);
            EXPECT_LE(mesh.triangleCount(), most) << belt << ' ' << resolution;
            EXPECT_NEAR(mesh::measure(mesh).volume_m3, 86.4 + .35 * (2.46 * 4.3 - 2.16 * 4), 1e-4)
                << belt << ' ' << resolution;
        }
}

/// One of the tiers lies in one layer of cells, with both of its creases: chips stood out of it where its faces meet.
TEST(Ledges, OfTiersHaveNoChips) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nlet tiers = 14\nstart A -> size (96m, 10.1m, 74m) move (0, 5.05m, 0) Seats\n"
        "rule Seats -> for k in 1..tiers { Tier with k = k }\n"
        "rule Tier -> footprint round(72) offset (-.4m - (tiers - k) * .9m) Ring\n"
        "rule Ring -> court 1.2m extrude (1.6m + k * .5m) block\n",
        context);
    const auto partsOff = [&](int halvings) {
        const MeshedModel made = meshed(model, 177, halvings);
        return lower::findOffSurface(model.derivation, *model.lowered, model.tape, made.mesh, made.grid.cell_m, 2,
                                     nullptr)
            ->size();
    };
    EXPECT_GE(partsOff(0), 1u);
    EXPECT_EQ(partsOff(3), 0u);
}

/// The rim of the highest step had bites as long as a cell, and spikes: .12 m³ of it were missing.
TEST(Ledges, OfRoundStepsHaveNoBites) {
    for (const int resolution : {136, 156}) {
        const mesh::Mesh mesh = usualMesh(
            "start A -> size 1m Ground, Steps move (13m, .2m, 8m)\n"
            "rule Ground -> cube size (66m, .4m, 58m) move (0, -.5m, 0)\n"
            "rule Steps -> for k in 0..2 { nil,\n"
            "  cylinder size (6.8m - k * .9m, .22m, 6.8m - k * .9m) move (0, k * .22m - .4m, 0) }\n",
            resolution);
        const double exact_m3 = 66 * 58 * .4 + pi / 4 * (.21 * 6.8 * 6.8 + .22 * (5.9 * 5.9 + 5 * 5));
        EXPECT_NEAR(mesh::measure(mesh).volume_m3, exact_m3, .03) << resolution;
    }
}

/// The board along the eaves was bevelled away in places, and its corner torn.
TEST(Ledges, OfBoardsAlongEavesAreExact) {
    for (const int resolution : {160, 256})
        EXPECT_LE(usualMesh("start A -> cube size (40, 1, 30), House move (6m, 1m, 2m) turn 23deg\n"
                            "rule House -> footprint rect(9, 6) extrude 3m Mass\n"
                            "rule Mass -> cube + gableRoof(40deg, overhang: .4m, fascia: .12m) at +y\n",
                            resolution)
                      .triangleCount(),
                  90u)
            << resolution;
}

/// A corner of the foot may lie beyond an edge of the slab between two cells: 8 triangles of the slab's top, 10 around
/// it and below, 10 of the tower.
TEST(Feet, OfTurnedTowersAreExact) {
    for (const char* const turn : {"10deg", "33deg", "57deg"}) {
        const std::string turned = fmt::format(" turn {}", turn);
        for (const int resolution : {24, 37, 41})
            EXPECT_EQ(usualMesh("start A -> cube size (9, 1, 9)" + turned + " + cube size (4m, 2.6m, 4m)" + turned +
                                    " move (0, 1.8m, 0)\n",
                                resolution)
                          .triangleCount(),
                      28u)
                << turn << ' ' << resolution;
    }
}

}  // namespace
}  // namespace sgm::pipeline
