// Convex parts fill what the field does: walls with holes, turned, round, and whole buildings.
#include "grammar/lower/convex_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "modeler/core/conventions.h"
#include "tests/lower/lowered.h"

namespace sgm::lower {
namespace {

using namespace testing_;

std::vector<mesh::ConvexPolyhedron> polyhedra(const ConvexParts& parts) {
    std::vector<mesh::ConvexPolyhedron> all;
    for (const ConvexPiece& piece : parts.pieces) all.push_back(piece.polyhedron);
    return all;
}

bool holds(const mesh::ConvexPolyhedron& piece, Vec3d p) {
    for (const auto& face : piece.faces())
        if (dot(face.plane.normal, p) > face.plane.offset) return false;
    return true;
}
bool hold(const std::vector<mesh::ConvexPolyhedron>& pieces, Vec3d p) {
    return std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) { return holds(piece, p); });
}

ConvexParts partsOf(const Lowered& model) {
    auto parts = convexParts(model.derivation, *model.model, nullptr);
    EXPECT_TRUE(parts.ok()) << parts.error().message;
    return std::move(parts).value();
}

/// Shares of the model's volume, counted at evenly spread points: all pieces together, and what is where the model
/// isn't.
struct Overlay {
    double pieces = 0, outside = 0;
    Overlay(const Lowered& model, const std::vector<mesh::ConvexPolyhedron>& all) {
        constexpr int points = 60'000;
        const Box3d box = model.model->field.bounds.as<double>().inflated(0.1);
        size_t solid = 0, held = 0, extra = 0;
        for (int i = 1; i <= points; ++i) {  // Roberts' sequence
            const auto share = [&](double a) { return std::fmod(0.5 + a * i, 1.0); };
            const Vec3d u{share(0.8191725133961645), share(0.6710436067037893), share(0.5497004779019703)};
            const Vec3d p = box.lo + u * box.size();
            const bool in = model.inside(p.as<float>()), covered = hold(all, p);
            solid += in, held += covered, extra += covered && !in;
        }
        pieces = static_cast<double>(held) / static_cast<double>(solid);
        outside = static_cast<double>(extra) / static_cast<double>(solid);
    }
};

Lowered example(const std::string& path) { return Lowered(fileText("examples/" + path)); }

double volume_m3(const std::vector<mesh::ConvexPolyhedron>& pieces) {
    double sum = 0;
    for (const auto& piece : pieces) sum += piece.volume_m3();
    return sum;
}

TEST(ConvexParts, AWallIsSplitAroundItsWindows) {
    for (const std::string turned : {"", " turn 30deg", " turn (20deg, 30deg, -50deg)"}) {
        const Lowered model("grammar 1\nterminal stone = cube\nstart A -> stone size (10, 3, .4)" + turned +
                            "\n  - cube size (1, 1.2, 1) at centre to centre move (-3, 0, 0)"
                            "\n  - cube size (1, 1.2, 1) at centre to centre move (2, .1, 0)\n");
        const ConvexParts parts = partsOf(model);
        const auto boxes = boxesOf(model.derivation, parts);
        EXPECT_EQ(parts.pieces.size(), 7u);
        EXPECT_EQ(boxes.size(), 7u) << "every piece is a box already";
        EXPECT_NEAR(volume_m3(polyhedra(parts)), 10 * 3 * .4 - 2 * 1.2 * .4, 1e-6);
        EXPECT_NEAR(volume_m3(boxes), 10 * 3 * .4 - 2 * 1.2 * .4, 1e-6);
        EXPECT_TRUE(parts.notes.empty());
    }
}

TEST(ConvexParts, BuildingsAreNoFatterThanTheyAre) {
    for (const std::string file : {"tower.sgm", "buildings/palace.sgm"}) {
        SCOPED_TRACE(file);
        const Lowered model = example(file);
        const ConvexParts parts = partsOf(model);
        const Overlay convex(model, polyhedra(parts)), boxes(model, boxesOf(model.derivation, parts));
        RecordProperty(
            file, fmt::format("{} parts: {:.4f}, {:.4f} outside; boxes: {:.4f}, {:.4f} outside", parts.pieces.size(),
                              convex.pieces, convex.outside, boxes.pieces, boxes.outside));
        EXPECT_NEAR(convex.pieces, 1, 0.05);
        EXPECT_LT(convex.outside, 0.03);
        EXPECT_NEAR(boxes.pieces, 1, 0.05);
        EXPECT_LT(boxes.outside, 0.05);
    }
}

TEST(ConvexParts, SolidsOverFootprintsAreExact) {
    for (const char* plan : {"ell(16, 12, 6, 5)", "ring(20, 16, 5)", "ngon(7, 6m)",
                             "outline((0, 0), (12, -1), (17, 4), (13, 10), (8, 7), (2, 9))"})
        for (const char* solid : {"block", "hipRoof(35deg, overhang: .5m)",
                                  "gableRoof(40deg, overhang: .4m, fascia: .2m, cover: .3m)", "flatRoof(.3m, 1m, .5m)",
                                  "mansardRoof(65deg, 1.5m, 20deg)", "gambrelRoof(60deg, 1.4m, 25deg, ends: x)"}) {
            SCOPED_TRACE(std::string(plan) + " " + solid);
            const Lowered model("grammar 1\nstart A -> footprint " + std::string(plan) +
                                " extrude 4m turn 20deg B\nrule B -> " + solid + "\n");
            const ConvexParts parts = partsOf(model);
            const Overlay convex(model, polyhedra(parts));
            EXPECT_NEAR(convex.pieces, 1, 0.005);
            EXPECT_LT(convex.outside, 0.005);
            EXPECT_TRUE(parts.notes.empty());
        }
}

TEST(ConvexParts, RoundRoofsOverFootprintsAreNoMoreThanATwentiethFatter) {
    for (const char* plan : {"rect(12, 8)", "ngon(7, 6m)", "round(24, 5m)", "ell(16, 12, 6, 5)", "ring(20, 16, 5)"})
        for (const char* solid :
             {"domeRoof", "domeRoof(overhang: .4m, fascia: .3m)", "bellRoof", "bellRoof(fascia: .3m)", "pyramidRoof",
              "pyramidRoof(overhang: .5m)", "pyramidRoof(overhang: .5m, fascia: .2m)"}) {
            SCOPED_TRACE(std::string(plan) + " " + solid);
            const Lowered model("grammar 1\nstart A -> footprint " + std::string(plan) +
                                " extrude 4m turn 20deg B\nrule B -> " + solid + "\n");
            const ConvexParts parts = partsOf(model);
            const Overlay convex(model, polyhedra(parts));
            EXPECT_NEAR(convex.pieces, 1.02, 0.03);
            EXPECT_LT(convex.outside, 0.05);
            EXPECT_TRUE(parts.notes.empty());
        }
}

TEST(ConvexParts, RoofsWithoutAFootprintStandOverTheirRectangle) {
    for (const char* solid : {"hipRoof", "domeRoof", "bellRoof", "pyramidRoof"}) {
        SCOPED_TRACE(solid);
        const Lowered model(std::string("grammar 1\nstart A -> cube size (9, 2, 6) + ") + solid +
                            " size (9, 4, 6) at +y\n");
        const ConvexParts parts = partsOf(model);
        const Overlay convex(model, polyhedra(parts));
        EXPECT_NEAR(convex.pieces, 1.02, 0.03);
        EXPECT_LT(convex.outside, 0.05);
        EXPECT_TRUE(parts.notes.empty());
    }
}

TEST(ConvexParts, RoundSolidsKeepTheirVolume) {
    for (const char* solid : {"sphere", "ellipsoid", "cylinder", "cone", "capsule", "torus(.3)", "pyramid", "prism",
                              "wedge", "roof(0)", "roof(.4)", "roof(1)", "morph(cube, sphere, .5)"}) {
        SCOPED_TRACE(solid);
        const Lowered model(std::string("grammar 1\nstart A -> ") + solid +
                            " size (3, 5, 4) turn (20deg, 0deg, 10deg)\n");
        const ConvexParts parts = partsOf(model);
        const Overlay convex(model, polyhedra(parts)), boxes(model, boxesOf(model.derivation, parts));
        EXPECT_NEAR(convex.pieces, 1, 0.03);
        EXPECT_LT(convex.outside, 0.03);
        EXPECT_LT(boxes.pieces, 1.05);
        EXPECT_GT(boxes.pieces, 0.85) << "boxes side by side at an angle overlap";
        EXPECT_TRUE(parts.notes.empty());
    }
}

TEST(ConvexParts, CutsOfEveryKindStayOpen) {
    const Lowered model(
        "grammar 1\nstart A -> cube size 4\n  - cylinder size (1, 5, 1) at centre to centre"
        "\n  - halfspace at centre to centre turn (180deg, 0deg, 0deg) move (0, 1.5, 0)"
        "\n  - cube size (1, 1, 9) at centre to centre turn 35deg\n");
    const ConvexParts parts = partsOf(model);
    const Overlay convex(model, polyhedra(parts)), boxes(model, boxesOf(model.derivation, parts));
    EXPECT_NEAR(convex.pieces, 1, 0.01);
    EXPECT_LT(convex.outside, 0.01);
    EXPECT_LT(boxes.pieces, 1.05);
    EXPECT_GT(boxes.pieces, 0.75) << "prisms between cuts at an angle";
    EXPECT_FALSE(hold(polyhedra(parts), {0, 0, 0}));
    EXPECT_FALSE(hold(polyhedra(parts), {0, 1.8, 1.5}));
}

TEST(ConvexParts, BoxesLeaveRoundAndTurnedOpeningsOpen) {
    const Lowered model(
        "grammar 1\nstart A -> cube size (10, 4, .5)\n  - cylinder size (2.4, 9, 2.4) at centre to centre turn (90deg, "
        "0deg, 0deg) move (-2.5, 0, 0)\n  - cube size (1.6, 1.6, 9) at centre to centre turn (0deg, 0deg, 45deg) move "
        "(2.5, 0, 0)\n");
    const std::vector<mesh::ConvexPolyhedron> boxes = boxesOf(model.derivation, partsOf(model));
    const Overlay overlay(model, boxes);
    RecordProperty("boxes", fmt::format("{}: {:.4f}, {:.4f} outside", boxes.size(), overlay.pieces, overlay.outside));
    EXPECT_NEAR(overlay.pieces, 1, 0.05);
    EXPECT_LT(overlay.outside, 0.06);
    EXPECT_LT(boxes.size(), 80u);
    for (const double r : {0.0, 0.5, 0.8})
        for (int i = 0; i < 8; ++i) {
            const double a = radians(45.0 * i);
            EXPECT_FALSE(hold(boxes, {-2.5 + r * std::cos(a), r * std::sin(a), 0})) << r << " " << i;
            EXPECT_FALSE(hold(boxes, {2.5 + 0.8 * r * std::cos(a), 0.8 * r * std::sin(a), 0})) << r << " " << i;
        }
    for (const double x : {-4.9, -.5, .5, 4.9})
        for (const double y : {-1.9, 0., 1.9}) EXPECT_TRUE(hold(boxes, {x, y, 0})) << x << " " << y;
}

TEST(ConvexParts, SaysWhereTheyDiffer) {
    const auto notes = [](const std::string& body) {
        std::string all;
        for (const std::string& note : partsOf(Lowered("grammar 1\nstart A -> cube size 2 " + body + "\n")).notes)
            all += note + "\n";
        return all;
    };
    EXPECT_EQ(notes("+ sphere size 1 at +y"), "");
    const std::string uncut = notes("- kifs size 1 at centre to centre");
    EXPECT_NE(uncut.find(":2:"), std::string::npos) << uncut;
    EXPECT_NE(uncut.find("holes are closed"), std::string::npos) << uncut;
    EXPECT_NE(notes("+ kifs size 1 at +y").find("left out"), std::string::npos);
    EXPECT_NE(notes("displace billow(.1, 2)").find("noise"), std::string::npos);
    EXPECT_NE(notes("+ sphere size 1 at +y blend .2").find("sharp"), std::string::npos);
    const Lowered fractal("grammar 1\nstart A -> kifs size 2\n");
    EXPECT_EQ(convexParts(fractal.derivation, *fractal.model, nullptr).error().kind, Error::Kind::Input);
}

/// They were the level town's, 30 m below a hill's top.
TEST(ConvexParts, AreRefusedOnHills) {
    const Lowered hill(
        "grammar 2\nmap relief = 30m * bump((0m, 0m), 160m)\n"
        "roads Net { pull = bump((0m, 0m), 200m) spread = true height = relief slope = 50% step = 40m }\n"
        "start Hill -> size (160, 80, 160) network Net { ground: extrude 40m cube }\n");
    const auto parts = convexParts(hill.derivation, *hill.model, nullptr);
    ASSERT_FALSE(parts.ok());
    EXPECT_NE(parts.error().message.find(":4:"), std::string::npos) << parts.error().message;
    EXPECT_NE(parts.error().message.find("take --collider mesh"), std::string::npos) << parts.error().message;
}

}  // namespace
}  // namespace sgm::lower
