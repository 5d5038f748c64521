// Prisms and roofs over footprints through crisp meshes: volumes against closed forms, closedness, components, genus.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <numeric>
#include <set>

#include "modeler/core/conventions.h"
#include "modeler/plan/plates.h"
#include "tests/field/probe.h"
#include "tests/plan/built.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

using test::built;
using test::Built;
using test::crispMesh;

constexpr int resolution = 128;

double volumeOf(const Built& b, int at = resolution) { return mesh::measure(crispMesh(b.scene, at)).volume_m3; }

std::vector<std::pair<std::string, Footprint>> plans() {
    return {{"rectangle", *rectangle(12, 7)}, {"ell", *ell(16, 14, 6, 5)},       {"tee", *tee(18, 15, 6, 5)},
            {"yard", *yard(20, 15, 4)},       {"ring", *ring(20, 16, 4)},        {"ngon", *ngon(7, 8)},
            {"round", *round(32, 8)},         {"arc", *arc(11, 16, .2, 2.1, 12)}};
}

TEST(Solids, PrismsHaveTheirAreaTimesTheirHeight) {
    for (const auto& [name, f] : plans())
        for (const double turn : {0.0, .3}) {
            SCOPED_TRACE(name);
            const auto b = built(turned(f, turn));
            b->field() = field::prism(b->plan, b->number(-1), b->number(4), 5);
            const mesh::Mesh m = crispMesh(b->scene, resolution);
            const mesh::MeshFigures figures = mesh::measure(m);
            EXPECT_NEAR(figures.volume_m3 / (area(f) * 5), 1, 1e-5);
            EXPECT_EQ(figures.components, 1u);
            EXPECT_EQ(test::genus(figures), name == "ring" ? 1 : 0);
        }
}

TEST(Solids, PromisesOfFieldsHold) {
    uint64_t key = 0;
    for (const auto& [name, f] : plans()) {
        const auto holds = [&](const std::string& what, auto&& make) {
            const auto b = built(turned(f, .4));
            b->field() = make(*b);
            field::test::expectPromises(b->scene.graph, b->field(), b->field().bounds.as<double>(), ++key,
                                        name + " " + what);
        };
        holds("prism", [](Built& b) { return field::prism(b.plan, b.number(0), b.number(3)); });
        holds("taper", [](Built& b) { return field::taperedPrism(b.plan, b.number(0), b.number(3), b.number(.2)); });
        holds("flare", [](Built& b) { return field::taperedPrism(b.plan, b.number(0), b.number(3), b.number(-.3)); });
        holds("shell", [](Built& b) {
            return field::shell(b.plan, b.number(0), b.number(3), b.number(.3), b.number(.2), b.number(0));
        });
        holds("hip", [](Built& b) { return field::hipRoof(b.plan, b.foot(2, .5), b.number(.7)); });
        holds("gable", [](Built& b) {
            return field::gableRoof(b.plan, b.foot(2, .5, .2), b.number(.7), gableEnds(b.footprint, b.formula));
        });
        holds("half-hip", [](Built& b) {
            return field::halfHipRoof(b.plan, b.foot(2, .5), b.number(.7), gableEnds(b.footprint, b.formula),
                                      b.number(.5));
        });
        holds("mansard", [](Built& b) {
            return field::mansardRoof(b.plan, b.foot(0, .3), b.number(1.2), b.number(1), b.number(.4));
        });
        holds("pyramid", [](Built& b) { return field::pyramidRoof(b.plan, b.foot(), b.number(3)); });
        holds("shed", [](Built& b) { return field::shedRoof(b.plan, b.foot(0, .2), b.number(.3), {0, 1}); });
        holds("butterfly", [](Built& b) { return field::butterflyRoof(b.plan, b.foot(0, .2), b.number(.3), {1, .2}); });
        holds("flat",
              [](Built& b) { return field::flatRoof(b.plan, b.foot(), b.number(.3), b.number(.8), b.number(.4)); });
        holds("dome", [](Built& b) { return field::domeRoof(b.plan, b.foot(), b.number(4), b.number(0)); });
        holds("bell", [](Built& b) { return field::bellRoof(b.plan, b.foot(), b.number(4), b.number(2)); });
        holds("profile", [](Built& b) {
            return *field::profileRoof(b.plan, b.foot(), std::vector<Vec2>{{0, 0}, {.5, 2}, {2, 3}});
        });
        holds("cornice", [](Built& b) {
            return *field::moulding(b.plan, std::vector<Vec2>{{0, 0}, {.2, 0}, {.55, .35}, {.55, .5}, {0, .5}},
                                    b.number(3));
        });
    }
}

TEST(Solids, HipRoofsOfClosedForms) {
    const double pitch = radians(40), t = std::tan(pitch);
    for (const double turn : {0.0, .5}) {
        const auto rect = built(turned(*rectangle(12, 8), turn));
        rect->field() = field::hipRoof(rect->plan, rect->foot(3), rect->number(pitch));
        EXPECT_NEAR(volumeOf(*rect) / (t * (8 * 8 * 12 / 4.0 - 8 * 8 * 8 / 12.0)), 1, 1e-5);

        const auto six = built(turned(*ngon(6, 5), turn));
        six->field() = field::hipRoof(six->plan, six->foot(0), six->number(pitch));
        EXPECT_NEAR(volumeOf(*six) / (area(*ngon(6, 5)) * t * 5 * std::sqrt(.75) / 3), 1, 1e-5);
    }
}

TEST(Solids, GableRoofsOfClosedForms) {
    const double pitch = radians(45);
    const auto b = built(turned(*rectangle(12, 8), .3));
    b->field() = field::gableRoof(b->plan, b->foot(), b->number(pitch), gableEnds(b->footprint, b->formula));
    EXPECT_NEAR(volumeOf(*b) / (8 * 4 / 2.0 * 12), 1, 1e-5);
    // With an overhang of .5: the section grows by the strip below, the length by 1.
    const auto wide = built(turned(*rectangle(12, 8), .3));
    wide->field() =
        field::gableRoof(wide->plan, wide->foot(0, .5), wide->number(pitch), gableEnds(b->footprint, b->formula));
    EXPECT_NEAR(volumeOf(*wide) / (9 * 4.5 / 2.0 * 13), 1, 1e-5);
}

TEST(Solids, OtherRoofsOfClosedForms) {
    const Footprint f = *rectangle(12, 8);
    const auto expectVolume = [&](const char* what, double volume, auto&& make, double within = 1e-5) {
        const auto b = built(turned(f, .2));
        b->field() = make(*b);
        EXPECT_NEAR(volumeOf(*b) / volume, 1, within) << what;
    };
    const Vec2 up = turned(footprintOf({ringOf({{0, 1}}), {}}), .2).polygons[0].outer.points[0];
    const std::vector<uint32_t> ends{1, 3};
    const double d45 = radians(45);
    expectVolume("shed", 8 * 8 / 2.0 * 12,
                 [&](Built& b) { return field::shedRoof(b.plan, b.foot(), b.number(d45), up); });
    expectVolume("butterfly", 4 * 4 / 2.0 * 2 * 12 + 96 * .5, [&](Built& b) {
        return field::butterflyRoof(b.plan, b.foot(0, 0, .5), b.number(d45), {up.z, -up.x});
    });
    expectVolume("pyramid", 12 * 8 * 5 / 3.0,
                 [&](Built& b) { return field::pyramidRoof(b.plan, b.foot(), b.number(5)); });
    expectVolume("flat", 12 * 8 * .3 + (12 * 8 - 11 * 7) * .7,
                 [&](Built& b) { return field::flatRoof(b.plan, b.foot(), b.number(.3), b.number(.7), b.number(.5)); });
    // Lower part: frustum between 12 × 8 and 10 × 6 over 1.7320508 m; upper: hip over 10 × 6 at 30°.
    const double h = std::tan(radians(60)), t = std::tan(radians(30));
    const double frustum = h * (96 + 60 + 4 * (11 * 7.0)) / 6, top = t * (6 * 6 * 10 / 4.0 - 6 * 6 * 6 / 12.0);
    expectVolume("mansard", frustum + top, [&](Built& b) {
        return field::mansardRoof(b.plan, b.foot(), b.number(radians(60)), b.number(h), b.number(radians(30)));
    });
    expectVolume("gambrel", 12 * (h * 7 + 6 * 3 * t / 2), [&](Built& b) {
        return field::gambrelRoof(b.plan, b.foot(), b.number(radians(60)), b.number(h), b.number(radians(30)), ends);
    });
    // Slopes of 60° and 30° meet at x·√3 = (8 − x)/√3: x = 2, 2·√3 high.
    expectVolume("saltbox", 12 * 8 * 2 * h / 2, [&](Built& b) {
        return field::saltboxRoof(b.plan, b.foot(), b.number(radians(60)), b.number(radians(30)), up, ends);
    });
    // The gable less two tips of half its height: each a tetrahedron of base 4 × 2 / 2 and 2 m along the ridge.
    expectVolume("half-hip", 8 * 4 / 2.0 * 12 - 2 * (4 * 2 / 2.0 * 2 / 3),
                 [&](Built& b) { return field::halfHipRoof(b.plan, b.foot(), b.number(d45), ends, b.number(.5)); });
    expectVolume("profile", 96 * 1 + 60 * 2.0, [&](Built& b) {
        return *field::profileRoof(b.plan, b.foot(), std::vector<Vec2>{{0, 1}, {1, 1}, {1, 3}});
    });
    expectVolume("taper", 2 * (96 + 60 + 4 * (11 * 7.0)) / 6, [&](Built& b) {
        return field::taperedPrism(b.plan, b.number(1), b.number(3), b.number(std::atan2(1, 2)));
    });
    expectVolume("shell", 12 * 8 * 3 - 11 * 7 * 2.8, [&](Built& b) {
        return field::shell(b.plan, b.number(0), b.number(3), b.number(.5), b.number(.2), b.number(0));
    });
    // Horizontal slices of a cloister vault: rectangles moved in by 4 − √(16 − y²).
    double dome = 0;
    for (int i = 0; i < 20'000; ++i) {
        const double y = (i + .5) * 4 / 20'000, in = 4 - std::sqrt(16 - y * y);
        dome += (12 - 2 * in) * (8 - 2 * in) * 4 / 20'000;
    }
    expectVolume(
        "dome", dome, [&](Built& b) { return field::domeRoof(b.plan, b.foot(), b.number(4), b.number(4)); }, 2e-3);
    double bell = 0;
    for (int i = 0; i < 20'000; ++i) {
        const double y = (i + .5) * 4 / 20'000;
        const double in = y < 2 ? std::sqrt(4 - (2 - y) * (2 - y)) : 4 - std::sqrt(4 - (y - 2) * (y - 2));
        bell += (12 - 2 * in) * (8 - 2 * in) * 4 / 20'000;
    }
    expectVolume(
        "bell", bell, [&](Built& b) { return field::bellRoof(b.plan, b.foot(), b.number(4), b.number(4)); }, 3e-3);
}

TEST(Solids, MouldingsAreSweptWithMitres) {
    // A band of .5 × .25 m round a rectangle, and round the court of a ring.
    const std::vector<Vec2> band{{0, 0}, {.5, 0}, {.5, .25}, {0, .25}};
    const auto rect = built(turned(*rectangle(12, 8), .2));
    rect->field() = *field::moulding(rect->plan, band, rect->number(3));
    const mesh::MeshFigures figures = mesh::measure(crispMesh(rect->scene, resolution));
    EXPECT_NEAR(figures.volume_m3 / ((13 * 9 - 12 * 8) * .25), 1, 1e-5);
    EXPECT_EQ(test::genus(figures), 1);
    const auto ringed = built(*ring(12, 10, 3));
    ringed->field() = *field::moulding(ringed->plan, band, ringed->number(3));
    const mesh::MeshFigures both = mesh::measure(crispMesh(ringed->scene, resolution));
    EXPECT_NEAR(both.volume_m3 / ((13 * 11 - 12 * 10 + 6 * 4 - 5 * 3) * .25), 1, 1e-5);
    EXPECT_EQ(both.components, 2u);
    EXPECT_FALSE(field::moulding(rect->plan, std::vector<Vec2>{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, rect->number(3)).ok());
}

/// Every kind of roof, as a function of what it stands on.
std::vector<std::pair<std::string, std::function<field::Field(Built&)>>> roofs() {
    const auto ends = [](Built& b) { return gableEnds(b.footprint, b.formula); };
    return {
        {"hip", [](Built& b) { return field::hipRoof(b.plan, b.foot(0, .3), b.number(.7)); }},
        {"gable", [=](Built& b) { return field::gableRoof(b.plan, b.foot(0, .3, .2), b.number(.7), ends(b)); }},
        {"all gables",
         [](Built& b) {
             std::vector<uint32_t> all(b.footprint.edgeCount());
             std::iota(all.begin(), all.end(), 0u);
             all.pop_back();
             return field::gableRoof(b.plan, b.foot(), b.number(.7), all);
         }},
        {"half-hip",
         [=](Built& b) { return field::halfHipRoof(b.plan, b.foot(0, .2), b.number(.7), ends(b), b.number(.5)); }},
        {"mansard",
         [](Built& b) { return field::mansardRoof(b.plan, b.foot(), b.number(1.2), b.number(1), b.number(.4)); }},
        {"gambrel",
         [=](Built& b) {
             return field::gambrelRoof(b.plan, b.foot(), b.number(1.2), b.number(1), b.number(.4), ends(b));
         }},
        {"saltbox",
         [=](Built& b) {
             return field::saltboxRoof(b.plan, b.foot(), b.number(.9), b.number(.4), {1, 1}, ends(b));
         }},
        {"pyramid", [](Built& b) { return field::pyramidRoof(b.plan, b.foot(0, .2), b.number(3)); }},
        {"shed",
         [](Built& b) {
             return field::shedRoof(b.plan, b.foot(0, .2), b.number(.3), {1, 2});
         }},
        {"butterfly",
         [](Built& b) {
             return field::butterflyRoof(b.plan, b.foot(0, .2, .2), b.number(.3), {1, 2});
         }},
        {"flat", [](Built& b) { return field::flatRoof(b.plan, b.foot(), b.number(.3), b.number(.8), b.number(.3)); }},
        {"dome", [](Built& b) { return field::domeRoof(b.plan, b.foot(), b.number(3), b.number(0)); }},
        {"bell", [](Built& b) { return field::bellRoof(b.plan, b.foot(0, .2, .2), b.number(3), b.number(0)); }},
        {"profile",
         [](Built& b) {
             return *field::profileRoof(b.plan, b.foot(), std::vector<Vec2>{{0, 0}, {.5, 2}, {2, 3}});
         }},
    };
}

/// Over a square of 8 m: the board reaches to the overhang on all sides, as high as it is; without one nothing does.
TEST(Solids, CurvedRoofsStandOutByTheirBoard) {
    using Make = std::function<field::Field(Built&, double)>;
    const Make dome = [](Built& b, double fascia_m) {
        return field::domeRoof(b.plan, b.foot(0, 1, fascia_m), b.number(4), b.number(0));
    };
    const Make bell = [](Built& b, double fascia_m) {
        return field::bellRoof(b.plan, b.foot(0, 1, fascia_m), b.number(4), b.number(0));
    };
    for (const Make& make : {dome, bell})
        for (const double fascia_m : {0.0, .3}) {
            const auto b = built(*rectangle(8, 8));
            b->field() = make(*b, fascia_m);
            field::test::Probe probe(b->scene.graph, b->field());
            EXPECT_EQ(probe({4.9f, .1f, 0}) < 0, fascia_m > 0);
            EXPECT_EQ(probe({-4.9f, .25f, -4.9f}) < 0, fascia_m > 0);
            EXPECT_GT(probe({4.9f, 0, 0}), fascia_m > 0 ? -1 : .5f) << "a sheet without thickness";
            EXPECT_GT(probe({4.9f, .35f, 0}), 0);
            EXPECT_GT(probe({5.1f, .1f, 0}), 0);
            EXPECT_LT(probe({0, static_cast<float>(3.9 + fascia_m), 0}), 0);
        }
}

TEST(Solids, NoRoofOverRandomPlansFails) {
    uint64_t key = 0;
    for (const auto& [name, make] : roofs())
        for (int i = 0; i < 25; ++i) {
            SCOPED_TRACE(name + " " + std::to_string(key));
            const auto b = built(test::anyPlan(++key));
            b->field() = make(*b);
            ASSERT_TRUE(b->field().bounds.finite());
            field::test::expectPromises(b->scene.graph, b->field(), b->field().bounds.as<double>(), key, name);
            const mesh::BuiltMesh m = mesh::meshOf(b->scene, 64, 2, {.surface = mesh::Surface::Crisp});
            ASSERT_TRUE(m.mesh.ok());
            const mesh::MeshFigures figures = mesh::measure(*m.mesh);
            EXPECT_EQ(figures.boundaryEdges + figures.nonmanifoldEdges, 0u);
            EXPECT_GT(figures.volume_m3, 0);
        }
}

TEST(Solids, PlatesAndTheirCoreAreOneSolid) {
    for (const double turn : {0.0, .3})
        for (const auto& [name, plan] : plans()) {
            SCOPED_TRACE(name);
            const Footprint f = turned(plan, turn);
            const Plates plates = *platesOf(f, .5);
            mesh::Scene s;
            std::deque<Footprint> footprints;
            std::deque<Formula> formulas;
            std::vector<field::Owned> parts;
            const auto add = [&](const Footprint& part) {
                footprints.push_back(part);
                formulas.push_back(*monotoneFormula(part));
                const uint64_t path = 10 * footprints.size();
                const field::PlanField in(footprints.back(), formulas.back(), s.graph.position(), path);
                const field::Quantity bottom{s.graph.slot(0.f), 0}, top{s.graph.slot(3.f), 3};
                parts.push_back({field::prism(in, bottom, top, path + 1), static_cast<OriginId>(footprints.size())});
            };
            for (const Plate& plate : plates.plates) add(plate.footprint);
            add(plates.core);
            s.field = field::sum(s.graph, parts);
            for (const int at : {64, 100}) {
                const mesh::BuiltMesh m = mesh::meshOf(s, at, 2, {.surface = mesh::Surface::Crisp});
                ASSERT_TRUE(m.mesh.ok());
                const mesh::MeshFigures figures = mesh::measure(*m.mesh);
                EXPECT_EQ(figures.components, 1u) << at;
                EXPECT_EQ(test::genus(figures), name == "ring" ? 1 : 0) << at;
                EXPECT_NEAR(figures.volume_m3 / (area(f) * 3), 1, 1e-4) << at;
            }
        }
}

TEST(Solids, FacesAreLabelledSoThatRidgesAreSharp) {
    // 12 × 8 with a hip roof: 4 slopes and a bottom; 2 + 2 + 2·1 triangles above, 2 below at least.
    const auto b = built(*rectangle(12, 8));
    b->field() = field::hipRoof(b->plan, b->foot(), b->number(.7));
    EXPECT_EQ(crispMesh(b->scene, 48).triangleCount(), 8u);
    const auto prism = built(*ell(16, 14, 6, 5));
    prism->field() = field::prism(prism->plan, prism->number(0), prism->number(3));
    EXPECT_EQ(crispMesh(prism->scene, 48).triangleCount(), 2u * 6 + 2 * 4);
    const auto lens = built(*round(24, 8));
    lens->field() = field::domeRoof(lens->plan, lens->foot(), lens->number(5), lens->number(0));
    const mesh::Mesh dome = crispMesh(lens->scene, 64);
    std::set<mesh::Label> labels;
    for (const mesh::Chunk& c : dome.chunks) labels.insert(c.labels.begin(), c.labels.end());
    EXPECT_GE(labels.size(), 25u) << "a piece an edge, and the foot";
}

}  // namespace
}  // namespace sgm::plan
