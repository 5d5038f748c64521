// The plan's field through the tape, in floats: signs, and closed meshes of plans of any form.
#include <gtest/gtest.h>

#include <cstdlib>

#include "modeler/core/conventions.h"
#include "modeler/field/bends.h"
#include "tests/field/probe.h"
#include "tests/plan/built.h"
#include "tests/plan/random_plans.h"

namespace sgm::plan {
namespace {

using test::built;
using test::Draws;

int wanted(const char* variable, int usual) {
    const char* const text = std::getenv(variable);
    return text ? std::atoi(text) : usual;
}

/// Beyond 1e-4 m of the edges; nearer to a sharp corner the distance to the outline is more than the field's own.
TEST(Tape, SignsAreRightATenthOfAMillimetreFromEdges) {
    const int plans = wanted("SGM_PLANS", 2000), points = wanted("SGM_POINTS", 200);
    for (int i = 0; i < plans; ++i) {
        const auto b = built(test::anyPlan(static_cast<uint64_t>(i)));
        b->field() = {b->plan.outside(), {}, 1, 0};
        Draws draw(combine(hashText("tape signs"), static_cast<uint64_t>(i)));
        const Box2 box = bounds(b->footprint);
        const auto edges = edgesOf(b->footprint);
        std::vector<Vec3f> at;
        while (at.size() < static_cast<size_t>(points)) {
            Vec2 p{draw.real(box.lo.x - 1, box.hi.x + 1), draw.real(box.lo.z - 1, box.hi.z + 1)};
            if (at.size() % 2) {
                const PlacedEdge& e = edges[static_cast<size_t>(draw.whole(0, static_cast<int>(edges.size()) - 1))];
                const double off = std::pow(10, draw.real(-3.9, -1));
                p = e.from + (e.to - e.from) * draw.real(0, 1) + Vec2{draw.real(-off, off), draw.real(-off, off)};
            }
            at.push_back({static_cast<float>(p.x), 0, static_cast<float>(p.z)});
        }
        const std::vector<float> values = field::test::Probe(b->scene.graph, b->field())(at);
        for (size_t k = 0; k < at.size(); ++k) {
            const Vec2 p{at[k].x, at[k].z};
            if (distanceToEdges(b->footprint, p) <= 1e-4) continue;
            ASSERT_EQ(values[k] < 0, contains(b->footprint, p))
                << "plan " << i << " at " << p.x << ' ' << p.z << ": " << values[k];
        }
    }
}

TEST(Tape, RoundWallsAreFoldedRelativeToTheirBends) {
    Footprint ringed = *round(400, 10);
    ringed.polygons[0].courts.push_back(reversed(round(300, 4)->polygons[0].outer));
    for (const Footprint& f : {*ngon(1000, 10), *round(128, 8), *arc(11, 16, .2, 2.9, 90), ringed}) {
        ASSERT_FALSE(firstFault(f));
        const auto b = built(turned(f, .3));
        ASSERT_FALSE(field::bendsOf(b->formula, b->plan.edges()).planes.empty());
        b->field() = field::prism(b->plan, b->number(-1), b->number(1));
        field::test::expectPromises(b->scene.graph, b->field(), b->field().bounds.as<double>(), f.edgeCount(), "round");
        b->field() = {b->plan.outside(), {}, 1, 0};
        const auto distances = distancesOf(b->footprint);
        Draws draw(f.edgeCount());
        field::test::Probe probe(b->scene.graph, b->field());
        for (int i = 0; i < 3000; ++i) {
            const Vec2 p{draw.real(-17, 17), draw.real(-17, 17)};
            const float x = static_cast<float>(p.x), z = static_cast<float>(p.z);
            ASSERT_NEAR(probe({x, 0, z}), valueOf(b->formula, distances, {x, z}), 1e-5);
        }
    }
}

/// The tape of a round wall's brick holds few of its edges: that is what the bends are for.
TEST(Tape, BricksOfRoundWallsKeepFewEdges) {
    const auto b = built(*ngon(1000, 10));
    b->field() = field::prism(b->plan, b->number(-3), b->number(3), 1);
    const eval::Tape tape = b->scene.tape();
    eval::Workspace w;
    const float half = 8 * 20 / 512.0f / 2;
    const Vec3f at{10 * std::cos(.7f), 0, 10 * std::sin(.7f)};
    const Box3f brick{at - Vec3f{half, half, half}, at + Vec3f{half, half, half}};
    eval::FloatInterval range;
    const eval::RangeTrace trace = eval::evaluateRanges(tape, {&brick, 1}, &range, w);
    EXPECT_LT(eval::shorten(tape, trace, 0, w).code().size(), 300u);
}

/// Outlines as nobody should draw them: points on one another, hairs, crossings, courts that touch.
Footprint broken(uint64_t key) {
    Draws draw(key);
    Footprint f = test::anyPlan(combine(key, 1));
    const auto damage = [&](Ring& ring) {
        const auto n = static_cast<int>(ring.size());
        Vec2& p = ring.points[static_cast<size_t>(draw.whole(0, n - 1))];
        const Vec2 other = ring.points[static_cast<size_t>(draw.whole(0, n - 1))];
        switch (draw.whole(0, 6)) {
            case 0:
                p = p + Vec2{draw.real(-1e-3, 1e-3), draw.real(-1e-3, 1e-3)};
                break;
            case 1:
                p = other;
                break;
            case 2:
                p = other + Vec2{draw.real(-2e-3, 2e-3), draw.real(-2e-3, 2e-3)};
                break;
            case 3:
                p = p + Vec2{draw.real(-5, 5), draw.real(-5, 5)};
                break;
            case 4:
                p = p * draw.real(-2, 3);
                break;
            case 5:
                p.x = draw.chance(.5) ? std::nan("") : 1e300;
                break;
            default: {  // a hair: out and back
                const auto at = static_cast<size_t>(draw.whole(0, n - 1));
                const Vec2 tip = ring.points[at] + Vec2{draw.real(-3, 3), draw.real(-3, 3)};
                ring.points.insert(ring.points.begin() + static_cast<ptrdiff_t>(at) + 1,
                                   {tip, ring.points[at] + Vec2{0, draw.real(0, 2e-3)}});
                ring.edges.resize(ring.points.size());
            }
        }
    };
    damage(f.polygons[0].outer);
    for (Ring& court : f.polygons[0].courts)
        if (draw.chance(.5)) damage(court);
    return f;
}

TEST(Tape, BrokenPlansAreErrorsOrClosedMeshes) {
    const int plans = wanted("SGM_BROKEN", 1000);
    int errors = 0, meshes = 0;
    for (int i = 0; i < plans; ++i) {
        SCOPED_TRACE(i);
        const Footprint f = broken(combine(hashText("broken"), static_cast<uint64_t>(i)));
        const Result<Footprint> sound = checked(f);
        if (!sound.ok()) {
            EXPECT_FALSE(sound.error().message.empty());
            ++errors;
            continue;
        }
        const auto b = built(*sound);
        b->field() = field::hipRoof(b->plan, b->foot(), b->number(radians(40)));
        const mesh::BuiltMesh m =
            mesh::meshOf(b->scene, 40, 1, {.surface = i % 2 ? mesh::Surface::Crisp : mesh::Surface::Cubes});
        if (!m.mesh.ok()) continue;
        const mesh::MeshFigures figures = mesh::measure(*m.mesh);
        EXPECT_EQ(figures.boundaryEdges + figures.nonmanifoldEdges, 0u);
        meshes += figures.triangles > 0;
    }
    EXPECT_GT(errors, plans / 4);
    EXPECT_GT(meshes, plans / 10);
}

}  // namespace
}  // namespace sgm::plan
