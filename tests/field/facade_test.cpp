// Facades against the paper's formulas (McGraw, eqs. 4–6, algorithms 1 and 2; errata in docs/papers.md), and their
// promises.
#include "modeler/field/facade.h"

#include <gtest/gtest.h>

#include "modeler/core/conventions.h"
#include "tests/field/probe.h"
#include "tests/trace.h"

namespace sgm::field::test {
namespace {

using P = FacadeParameter;

const Primitive& row() { return *findPrimitive("ornament"); }

/// An ornament of fixed numbers; `put` changes them.
struct Ornament {
    Graph graph;
    std::vector<Argument> arguments = defaults(graph, row());
    Ornament() {
        put(P::Center, {0.93, 0.93, 0.33});
        put(P::Bay, {4});
        put(P::Mirror, {0.25, 0.125, 0.4});
        put(P::Zoom, {2.26, 1.8, 1.3, 1.1});
        put(P::Pan, {0.15, 0.25, 0.35, 0.5});
        put(P::Rise, {0.9});
        arguments[size_t(P::Fold)] = argument(graph, Mat3::rotation({0, 0, 1}, 0.38));
    }
    void put(P p, std::initializer_list<double> numbers) { arguments[size_t(p)] = argument(graph, numbers); }
    double value(P p, int i = 0) const { return arguments[size_t(p)].value[i]; }
    PrimitiveInput over(Vec3d half) {
        const Vec3f h = half.as<float>();
        return {graph.position(), {graph.slot(h.x), graph.slot(h.y), graph.slot(h.z)}, half, arguments};
    }
    /// A solid of the primitive table, clad.
    Field clad(std::string_view solid, Vec3d half) {
        const Field outer = build(graph, solid, half, graph.position());
        return field::clad(over(half), {outer, 0, 0}, {0, 1, 0});
    }
};

/// d_KIFS of algorithm 1 in double, continuous, the ball at its end.
double fractal(const Ornament& o, Vec3d p) {
    const Mat3& f = [&] {
        const double* v = o.arguments[size_t(P::Fold)].value;
        return Mat3{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
    }();
    const double s = o.value(P::Scale), h = o.value(P::Center, 2) * (s - 1) / 2;
    double scales = 1;
    for (int i = 0; i < int(o.value(P::Passes)); ++i) {
        p = {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
        if (p.x < p.y) std::swap(p.x, p.y);
        if (p.x < p.z) std::swap(p.x, p.z);
        if (p.y < p.z) std::swap(p.y, p.z);
        p = f * p;
        p = {s * (p.x - o.value(P::Center)) + o.value(P::Center),
             s * (p.y - o.value(P::Center, 1)) + o.value(P::Center, 1), s * p.z};
        p.z = h - std::abs(p.z - h);
        scales *= s;
    }
    return (length(p) - 2) / scales;
}

/// Algorithm 2 for one axis: the folded coordinate, scaled and shifted by its facade id.
double mapped(const Ornament& o, double x, double w, double& toSeam) {
    double u = std::abs(2 * (x / w - std::floor(x / w)) - 1);
    int id = 0;
    for (int i = 0; i < 3; ++i) {
        u = std::abs(u - o.value(P::Mirror, i)) - o.value(P::Mirror, i);
        id += u > 0;
        u = std::abs(u);
    }
    toSeam = u * w / 2;
    return o.value(P::Zoom, id) * u + o.value(P::Pan, id);
}

TEST(Facade, BaysFollowTheFoldsOfAlgorithm2) {
    const double figure6[] = {0.25, 0.125, 0.4};
    const std::vector<FacadeBay> bays = baysOf(figure6);
    ASSERT_EQ(bays.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(bays[size_t(i)].id, i);
        EXPECT_NEAR(bays[size_t(i)].from, i == 0 ? 0 : i == 1 ? 0.5 : 0.75, 1e-12);
    }
    Draws draw(1);
    Ornament o;
    o.put(P::Fit, {1});
    for (int trial = 0; trial < 300; ++trial) {
        const double r[] = {draw.uniform(0, 0.6), draw.uniform(0, 0.4), draw.uniform(0, 0.3)};
        o.put(P::Mirror, {r[0], r[1], r[2]});
        const std::vector<FacadeBay> found = baysOf(r);
        EXPECT_LE(found.size(), 14u);
        int wrong = 0;
        for (int i = 0; i < 500; ++i) {
            const double u = (i + 0.5) / 500;  // a place whose triangle wave is u
            size_t bay = 0;
            while (bay + 1 < found.size() && found[bay + 1].from <= u) ++bay;
            wrong += found[bay].id != facadeCell(o.arguments, {8, 8, 8}, {(1 + u) / 2 * o.value(P::Bay), 0, 0}).idX;
        }
        EXPECT_LE(wrong, 3) << r[0] << ' ' << r[1] << ' ' << r[2];  // slivers
    }
}

/// min(inner, max(outer, d_KIFS)) over a box as the paper has it, the map's jumps and all.
double paperValue(const Ornament& o, Vec3d half, Vec3d p, double* toSeam = nullptr) {
    const double h = o.value(P::Storey), w = o.value(P::Bay), up = (p.y + half.y) / h, v = up - std::floor(up);
    double seamX, seamZ;
    const Vec3d q{mapped(o, p.x, w, seamX), o.value(P::Rise) * v, mapped(o, p.z, w, seamZ)};
    if (toSeam) *toSeam = std::min({seamX, seamZ, v * h, (1 - v) * h});
    const double outer = std::max({std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z});
    const double inner = std::max({std::abs(p.x) - half.x + 0.4, std::abs(p.z) - half.z + 0.4, p.y - half.y + 0.1});
    return std::min(inner, std::max(outer, fractal(o, q)));
}

/// The sign is that of g(f₁, f₂, f₃) as the paper has it, except within the slack beside a seam.
TEST(Facade, IsThePapersSolid) {
    Ornament o;
    const Vec3d half{6, 4.5, 4};
    o.put(P::Fit, {1});
    Probe probe(o.graph, o.clad("cube", half));
    Draws draw(2);
    int compared = 0, full = 0;
    for (int i = 0; i < 40000; ++i) {
        Vec3d p = draw.in(Box3d{-half, half});
        if (i % 2) p[(i / 2) % 2 * 2] = (i % 4 < 2 ? -1 : 1) * (half[(i / 2) % 2 * 2] - draw.uniform(0, 0.45));
        double toSeam;
        const double paper = paperValue(o, half, p, &toSeam);
        if (std::abs(paper) < 1e-4 || toSeam < 2e-3 || std::abs(p.y + half.y) < 0.01) continue;
        ++compared;
        full += paper < 0;
        ASSERT_EQ(probe(p.as<float>()) < 0, paper < 0) << p.x << ' ' << p.y << ' ' << p.z << ": " << paper;
    }
    EXPECT_GT(compared, 30000);
    EXPECT_LT(full, compared);
}

/// What the least over the cells is for: with the paper's own formulas steps go through walls.
TEST(Facade, RaysFindItsSurfaceAndMissThePapers) {
    Ornament o;
    const Vec3d half{6, 4.5, 4};
    o.put(P::Fit, {1}), o.put(P::Bay, {1});  // as the paper has it: the map stretches four times
    const sgm::test::Picture picture(Box3d{-half, half}.as<float>(), 640, 8);
    Probe ours(o.graph, o.clad("cube", half));
    const size_t missed =
        sgm::test::wrongRays(picture, 1, [&](const float* x, const float* y, const float* z, size_t n, float* out) {
            eval::Workspace workspace;
            eval::evaluate(ours.tape(), {x, y, z, n}, out, workspace);
        });
    const size_t papers =
        sgm::test::wrongRays(picture, 1, [&](const float* x, const float* y, const float* z, size_t n, float* out) {
            for (size_t i = 0; i < n; ++i) out[i] = static_cast<float>(paperValue(o, half, {x[i], y[i], z[i]}));
        });
    EXPECT_LE(double(missed), 1e-3 * double(picture.ways.size()));
    EXPECT_GT(double(papers), 0.02 * double(picture.ways.size()));
}

/// Pairs of points on both sides of bays' and storeys' borders.
void expectContinuous(Ornament& o, const Field& field, Vec3d half, uint64_t key) {
    Probe probe(o.graph, field);
    Draws draw(key);
    std::vector<Vec3f> a, b;
    const auto cell = [&](Vec3d p) {
        const FacadeCell c = facadeCell(o.arguments, half, p);
        return std::tuple(c.idX, c.idZ, c.storey);
    };
    const double w = 2 * half.x / std::max(1.0, std::round(2 * half.x / o.value(P::Bay))), h = o.value(P::Storey);
    const std::vector<FacadeBay> bays = baysOf(o.arguments[size_t(P::Mirror)].value);
    int astride = 0;
    for (int i = 0; i < 40000; ++i) {
        const double apart = draw.size(1e-4, 1e-1);
        Vec3d p = draw.in(Box3d{-half, half}.inflated(0.05)), way = draw.direction();
        if (i % 8 < 4) p[i % 2 * 2] = half[i % 2 * 2] - draw.uniform(0, 0.4);  // in a wall
        const auto straddle = [&](int axis, double plane) { p[axis] = plane - way[axis] * apart * draw.uniform(0, 1); };
        if (i % 4 == 1) straddle(1, -half.y + h * std::floor(draw.uniform(1, 2.99)));
        if (i % 4 == 3 && bays.size() > 1)
            straddle(0, -half.x + w * ((1 + bays[1 + size_t(draw.uniform(0, double(bays.size()) - 1.001))].from) / 2 +
                                       std::floor(draw.uniform(0, 3))));
        const Vec3d q = p + way * apart;
        astride += cell(p) != cell(q);
        a.push_back(p.as<float>()), b.push_back(q.as<float>());
    }
    const std::vector<float> fa = probe(a), fb = probe(b);
    double steepest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double apart = length(a[i].as<double>() - b[i].as<double>());
        steepest = std::max(steepest, (std::abs(double(fa[i]) - fb[i]) - 1e-5) / apart);
    }
    EXPECT_LE(steepest, 1.0001 * field.lipschitz);
    EXPECT_GT(steepest, 0.5);
    EXPECT_GT(astride, int(a.size() / 4));
}

TEST(Facade, IsContinuousAcrossCells) {
    const Vec3d half{6, 4.5, 4};
    for (const bool cube : {false, true}) {
        Ornament o;
        o.put(P::Terminal, {cube ? 1.0 : 0.0});
        expectContinuous(o, o.clad("cube", half), half, 3);
        o.put(P::Zoom, {1.6}), o.put(P::Pan, {-0.4});  // one bay only
        expectContinuous(o, o.clad("cube", half), half, 4);
        o.put(P::Pan, {0.9, -0.4, 0.3, 0});
        o.put(P::Mirror, {0.1, 0.14, 0.06});
        expectContinuous(o, o.clad("ellipsoid", half), half, 5);
        o.put(P::Round, {4}), o.put(P::Core, {2.5});
        expectContinuous(o, o.clad("cylinder", {4, 4.5, 4}), {4, 4.5, 4}, 6);
        o.put(P::Swing, {0.4}), o.put(P::Along, {5}), o.put(P::Across, {1.5});
        expectContinuous(o, o.clad("cylinder", {4, 4.5, 4}), {4, 4.5, 4}, 7);
    }
}

/// inner ⊆ clad ⊆ solid, whatever the solid; the foot is not eroded.
TEST(Facade, CladdingStaysBetweenItsShells) {
    for (const char* solid : {"cube", "cylinder", "cone", "torus", "ellipsoid", "roof"}) {
        SCOPED_TRACE(solid);
        Ornament o;
        const Vec3d half{5, 6, 4};
        const double wall = o.value(P::Wall);
        const Field outer = build(o.graph, solid, half, o.graph.position());
        Probe whole(o.graph, outer), clad(o.graph, o.clad(solid, half));
        Draws draw(8);
        size_t carved = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3f p = draw.in(Box3d{-half, half}.inflated(0.5)).as<float>();
            const float f = whole(p), g = clad(p);
            ASSERT_GE(g, f - 1e-5f);
            if (f < -2 * wall) {
                ASSERT_LT(g, 1e-5f);
            }
            carved += f < -0.01f && g > 0;
        }
        EXPECT_GT(carved, 0u);
        expectPromises(o.graph, o.clad(solid, half), {-half, half}, 9, solid);
    }
}

TEST(Facade, BaysAndStoreysFitTheirScope) {
    Ornament o;
    o.put(P::Bay, {3.7}), o.put(P::Storey, {3.3});
    const Vec3d half{6, 4.5, 4};  // 12 / 3 = 4, 9 / 3, 8 / 4
    const auto cell = [&](double x, double y, double z) { return facadeCell(o.arguments, half, {x, y, z}); };
    EXPECT_EQ(cell(0, -4.4, 0).storey, 0);
    EXPECT_EQ(cell(0, -1.4, 0).storey, 1);
    EXPECT_EQ(cell(0, 4.4, 0).storey, 2);
    EXPECT_EQ(cell(0, 40, 0).storey, 2) << "no storey above the last one";
    EXPECT_EQ(cell(5.99, 0, 0).idX, 2) << "walls are at the ends of bays";
    EXPECT_EQ(cell(0, 0, -3.99).idZ, 2);
    EXPECT_EQ(cell(5.99 - 12.0 / 3 / 2, 0, 0).idX, 0);
}

}  // namespace
}  // namespace sgm::field::test
