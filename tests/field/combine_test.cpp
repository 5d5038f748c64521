#include "modeler/field/combine.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "modeler/core/conventions.h"
#include "modeler/eval/values_interval.h"
#include "modeler/field/domain.h"
#include "modeler/field/ops.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

/// A random bounded primitive in a random frame inside about [−2, 2]³.
Field someSolid(Graph& graph, Draws& draw) {
    constexpr const char* names[] = {"cube", "sphere", "ellipsoid", "torus", "cylinder", "cone", "pyramid", "capsule"};
    Frame frame{draw.in({{-2, -2, -2}, {2, 2, 2}}), draw.uniform(0, 1) < 0.5 ? Mat3{} : draw.rotation()};
    Field f = build(graph, names[static_cast<size_t>(draw.uniform(0, 8))],
                    {draw.uniform(0.3, 1), draw.uniform(0.3, 1), draw.uniform(0.3, 1)},
                    toLocal(graph.position(), frame, static_cast<uint64_t>(draw.uniform(0, 1e15))));
    f.bounds = toWorld(f.bounds, frame);
    return f;
}

std::vector<Owned> someSolids(Graph& graph, Draws& draw, int count) {
    std::vector<Owned> parts;
    for (int i = 0; i < count; ++i) parts.push_back({someSolid(graph, draw), static_cast<OriginId>(i + 1)});
    return parts;
}

struct Combination {
    const char* name;
    bool solid;  ///< surely not empty
    std::function<Field(Graph&, Draws&)> make;
};

const Combination combinations[] = {
    {"framed", true, [](Graph& g, Draws& d) { return someSolid(g, d); }},
    {"sum", true, [](Graph& g, Draws& d) { return sum(g, someSolids(g, d, 1 + static_cast<int>(d.uniform(0, 12)))); }},
    {"difference", false,
     [](Graph& g, Draws& d) {
         const Field a = someSolid(g, d);
         return difference({a, 1}, {someSolid(g, d), 2});
     }},
    {"intersection", false,
     [](Graph& g, Draws& d) {
         const Field a = someSolid(g, d);
         return intersection({a, 1}, {someSolid(g, d), 2});
     }},
    {"cut by a half-space", false,
     [](Graph& g, Draws& d) {
         const Field a = someSolid(g, d);
         return difference({a, 1}, {build(g, "halfspace", {1, 1, 1}), 2});
     }},
    {"blend", true,
     [](Graph& g, Draws& d) {
         const double k = d.uniform(0.01, 1);
         return blend(g, someSolids(g, d, 2 + static_cast<int>(d.uniform(0, 9))), g.slot(static_cast<float>(k)), k);
     }},
    {"morph", false,
     [](Graph& g, Draws& d) {
         const double t = d.uniform(0, 1);
         const Field a = someSolid(g, d);
         return morph(a, someSolid(g, d), g.slot(static_cast<float>(t)), t, 3);
     }},
    {"displace", true,
     [](Graph& g, Draws& d) {
         const double amplitude = d.uniform(-0.3, 0.3),
                      frequency = d.uniform(0.5, 6) * (d.uniform(0, 1) < 0.5 ? 1 : -1);
         const Noise noise = d.uniform(0, 1) < 0.5 ? Noise::Billow : Noise::Fbm;
         Field f = build(g, "sphere", {1, 1, 1});
         return displace(f, g.position(), noise, g.slot(static_cast<float>(amplitude)), amplitude,
                         g.slot(static_cast<float>(frequency)), frequency, 1 + static_cast<int>(d.uniform(0, 5)),
                         static_cast<uint32_t>(d.uniform(0, 1e9)));
     }},
    {"mirror", false,
     [](Graph& g, Draws& d) {
         const bool x = d.uniform(0, 1) < 0.5, y = d.uniform(0, 1) < 0.5;
         const Frame frame{d.in({{0, -1, -1}, {2, 1, 1}}), d.rotation()};
         Field f = build(g, "cube", {0.8, 0.5, 0.3}, toLocal(mirror(g.position(), x, y, true), frame, 5));
         f.bounds = mirrored(toWorld(f.bounds, frame), x, y, true);
         return f;
     }},
    {"repeated", true,
     [](Graph& g, Draws& d) {
         const int axis = static_cast<int>(d.uniform(0, 3));
         const double period = d.uniform(0.8, 3);
         Frame frame{{}, d.rotation()};
         frame.centre[axis] = d.uniform(-0.6, 0.6) * period;  // also near and over the cell's ends
         return repeated(g.position(), axis, g.slot(static_cast<float>(period)), period,
                         1 + static_cast<int>(d.uniform(0, 5)), [&](Point p) {
                             Field f = build(g, "ellipsoid", {0.2, 0.3, 0.1}, toLocal(p, frame, 6));
                             f.bounds = toWorld(f.bounds, frame);
                             return f;
                         });
     }},
    {"repeat of a symmetric solid, mirrored", true,
     [](Graph& g, Draws& d) {
         Field f =
             build(g, "torus", {0.5, 0.2, 0.5},
                   mirror(repeat(g.position(), 0, g.slot(static_cast<float>(d.uniform(1.1, 2)))), true, false, false));
         f.bounds.lo.x = -Box3f::limit();
         f.bounds.hi.x = Box3f::limit();
         return f;
     }},
    {"all together", false,
     [](Graph& g, Draws& d) {
         const std::vector<Owned> parts = someSolids(g, d, 5);
         const Field melted = blend(g, parts, g.slot(0.3f), 0.3);
         const Field morphed = morph(melted, someSolid(g, d), g.slot(0.4f), 0.4, 1);
         const Field rough = displace(morphed, g.position(), Noise::Fbm, g.slot(0.1f), 0.1, g.slot(3.0f), 3, 3, 9);
         return difference({rough, 0}, {sum(g, someSolids(g, d, 3)), 2});
     }},
};

TEST(Combine, PromisesHold) {
    for (const Combination& c : combinations)
        for (uint64_t trial = 0; trial < 30; ++trial) {
            const uint64_t key = combine(hashText(c.name), trial);
            Draws draw(key);
            Graph graph;
            const Field field = c.make(graph, draw);
            const Box3d region =
                field.bounds.finite() ? field.bounds.as<double>() : Box3d{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};
            expectPromises(graph, field, region, key, std::string(c.name) + " " + std::to_string(trial), c.solid);
        }
}

/// Points around the solids of the tests above.
std::vector<Vec3f> cloud(Draws& draw, int count) {
    std::vector<Vec3f> points;
    for (int i = 0; i < count; ++i) points.push_back(draw.in({{-4, -4, -4}, {4, 4, 4}}).as<float>());
    return points;
}

TEST(Combine, BooleansAreMinAndMax) {
    Graph graph;
    Draws draw(1);
    const std::vector<Owned> parts = someSolids(graph, draw, 40);
    const std::vector<Vec3f> points = cloud(draw, 500);
    const std::vector<float> least = Probe(graph, sum(graph, parts))(points);
    const std::vector<float> a = Probe(graph, parts[0].field)(points), b = Probe(graph, parts[1].field)(points);
    const std::vector<float> cut = Probe(graph, difference(parts[0], parts[1]))(points),
                             common = Probe(graph, intersection(parts[0], parts[1]))(points);
    std::vector<float> expected(points.size(), Box3f::limit());
    for (const Owned& part : parts) {
        const std::vector<float> f = Probe(graph, part.field)(points);
        for (size_t i = 0; i < points.size(); ++i) expected[i] = std::min(expected[i], f[i]);
    }
    for (size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(least[i], expected[i]);
        EXPECT_EQ(cut[i], std::max(a[i], -b[i]));
        EXPECT_EQ(common[i], std::max(a[i], b[i]));
    }
}

TEST(Combine, NothingIsNeutral) {
    Graph graph;
    Draws draw(2);
    const Field solid = someSolid(graph, draw), none = nothing(graph);
    EXPECT_TRUE(none.bounds.empty());
    EXPECT_TRUE(sum(graph, {}).bounds.empty());
    EXPECT_TRUE(intersection({solid, 0}, {none, 0}).bounds.empty());
    const Owned both[] = {{solid, 1}, {none, 2}};
    const std::vector<Vec3f> points = cloud(draw, 200);
    const std::vector<float> f = Probe(graph, solid)(points);
    EXPECT_EQ(Probe(graph, sum(graph, both))(points), f);
    EXPECT_EQ(sum(graph, both).bounds, solid.bounds);
    EXPECT_EQ(Probe(graph, difference({solid, 1}, {none, 2}))(points), f);
    EXPECT_EQ(Probe(graph, blend(graph, both, graph.slot(0.5f), 0.5))(points), f);
    for (const float v : Probe(graph, intersection({solid, 0}, {none, 0}))(points)) EXPECT_GT(v, 1e20f);
}

TEST(Combine, SumIsABalancedTreeInTheOrderOfItsParts) {
    constexpr int n = 100000;
    Graph graph;
    std::vector<Owned> parts, moved;
    Draws draw(3);
    const auto boxAt = [](float at) { return Box3f{{at, 0, 0}, {at + 1, 1, 1}}; };
    for (int i = 0; i < n; ++i) {
        const NodeRef x = graph.slot(static_cast<float>(i));
        parts.push_back({Field{x, boxAt(static_cast<float>(draw.uniform(0, 1000)))}, 0});
        moved.push_back({Field{x, boxAt(static_cast<float>(draw.uniform(0, 1000)))}, 0});
    }
    const Field all = sum(graph, parts);
    // Depth, and which parts each subtree holds: those of a node's first half come before those of its second.
    std::vector<int> depth(graph.nodeCount(), 0), first(graph.nodeCount()), last(graph.nodeCount());
    for (int i = 0; i < n; ++i) first[parts[i].field.value.id()] = last[parts[i].field.value.id()] = i;
    size_t joins = 0;
    for (NodeId i = 0; i < graph.nodeCount(); ++i) {
        if (graph.node(i).op != codeOf<ops::Min>) continue;
        const NodeId a = graph.operands(i)[0].node, b = graph.operands(i)[1].node;
        ASSERT_EQ(last[a] + 1, first[b]);
        depth[i] = 1 + std::max(depth[a], depth[b]);
        first[i] = first[a];
        last[i] = last[b];
        ++joins;
    }
    EXPECT_EQ(joins, n - 1u);
    EXPECT_EQ(depth[all.value.id()], 17);  // ⌈log₂ 100,000⌉

    const size_t nodes = graph.nodeCount();
    EXPECT_EQ(sum(graph, moved).value.id(), all.value.id()) << "moving parts changes numbers alone";
    EXPECT_EQ(graph.nodeCount(), nodes);
    const Field again = summed(all.value, moved), whole = sum(graph, moved);
    EXPECT_EQ(again.bounds, whole.bounds);
    EXPECT_EQ(again.lipschitz, whole.lipschitz);
    EXPECT_EQ(again.growth, whole.growth);
}

/// Σ max(0, c − fᵢ)² = k² by bisection in double.
double melted(std::vector<double> f, double k) {
    double lo = *std::min_element(f.begin(), f.end()), hi = lo + k;
    for (int step = 0; step < 200; ++step) {
        const double c = (lo + hi) / 2;
        double squares = 0;
        for (const double v : f) squares += std::pow(std::max(0.0, c - v), 2);
        (squares < k * k ? lo : hi) = c;
    }
    return lo - k;
}

TEST(Blend, SolvesItsEquation) {
    Draws draw(4);
    for (int trial = 0; trial < 2000; ++trial) {
        const double k = trial % 20 == 0 ? 0 : draw.size(0.01, 2);
        std::vector<float> args{static_cast<float>(k)};
        const int n = 1 + static_cast<int>(draw.size(1, trial % 100 == 1 ? 3000 : 30));
        const double spread = draw.uniform(0, 3);
        for (int i = 0; i < n; ++i) args.push_back(static_cast<float>(draw.uniform(-spread, spread)));
        const float f = ops::Blend::apply<float>(std::span<const float>(args), 0);
        EXPECT_NEAR(f, melted({args.begin() + 1, args.end()}, args[0]), 2e-6 * (1 + k) * std::sqrt(n));
    }
}

TEST(Blend, IsExactlyTheMinimumWhenOneIsNear) {
    Draws draw(5);
    for (int trial = 0; trial < 5000; ++trial) {
        const auto k = static_cast<float>(draw.uniform(0, 1));
        const auto least = static_cast<float>(trial == 0 ? -0.0 : draw.uniform(-3, 3));
        const float args[] = {k, least + k + static_cast<float>(draw.uniform(1e-5, 2)), least,
                              least + k * 1.01f + 1e-5f};
        const float f = ops::Blend::apply<float>(std::span<const float>(args), 0);
        ASSERT_EQ(std::bit_cast<uint32_t>(f), std::bit_cast<uint32_t>(least));
    }
}

TEST(Blend, DroppingFarFieldsChangesNoBit) {
    Draws draw(6);
    for (int trial = 0; trial < 3000; ++trial) {
        const auto k = static_cast<float>(draw.uniform(0.1, 1));
        std::vector<float> all{k}, near{k};
        for (int i = 0; i < 12; ++i) all.push_back(static_cast<float>(draw.uniform(-1, 2)));
        const float least = *std::min_element(all.begin() + 1, all.end());
        for (size_t i = 1; i < all.size(); ++i)
            if (all[i] - least < k) near.push_back(all[i]);
        const float f = ops::Blend::apply<float>(std::span<const float>(all), 0),
                    g = ops::Blend::apply<float>(std::span<const float>(near), 0);
        ASSERT_EQ(std::bit_cast<uint32_t>(f), std::bit_cast<uint32_t>(g));
    }
}

TEST(Blend, IntervalsEnclose) {
    using I = eval::Interval<float>;
    Draws draw(10);
    for (int trial = 0; trial < 1000; ++trial) {
        std::vector<I> boxes{{static_cast<float>(draw.uniform(0, 0.5)), static_cast<float>(draw.uniform(0.5, 1))}};
        const int n = 1 + static_cast<int>(draw.size(1, trial % 50 == 0 ? 2000 : 12));
        const double far = trial % 3 == 0 ? 100 : 0, spread = draw.size(1e-4, 1);
        for (int i = 0; i < n; ++i) {
            const double lo = far + draw.uniform(-1, 1);
            boxes.push_back({static_cast<float>(lo), static_cast<float>(lo + spread)});
        }
        const I range = ops::Blend::interval(std::span<const I>(boxes), 0);
        for (int i = 0; i < 30; ++i) {
            std::vector<float> args;
            for (const I& box : boxes)
                args.push_back(i == 0 ? box.lo : i == 1 ? box.hi : static_cast<float>(draw.uniform(box.lo, box.hi)));
            if (i < 2) args[0] = i == 0 ? boxes[0].hi : boxes[0].lo;  // the extremes: f falls with k
            const float f = ops::Blend::apply<float>(std::span<const float>(args), 0);
            ASSERT_LE(range.lo, f);
            ASSERT_GE(range.hi, f);
            ASSERT_TRUE(i != 0 || f - range.lo < 1e-3f);
            ASSERT_TRUE(i != 1 || range.hi - f < 1e-3f);
        }
    }
}

TEST(Blend, GroupingCannotChangeTheShape) {
    Graph graph;
    Draws draw(7);
    const std::vector<Owned> parts = someSolids(graph, draw, 6);
    const NodeRef k = graph.slot(0.4f);
    const Field flat = blend(graph, parts, k, 0.4);
    Field chain = parts[0].field;
    OriginId owner = parts[0].origin;
    for (size_t i = 1; i < parts.size(); ++i) {
        const Owned pair[] = {{chain, owner}, parts[i]};
        chain = blend(graph, pair, k, 0.4);
        owner = 0;
    }
    EXPECT_EQ(chain.value.id(), flat.value.id());
}

TEST(Displace, StaysWithinTheAmplitude) {
    Graph graph;
    const Field ball = build(graph, "sphere", {1, 1, 1});
    const auto rough = [&](Noise noise) {
        return displace(ball, graph.position(), noise, graph.slot(0.2f), 0.2, graph.slot(4.0f), 4, 3, 11);
    };
    Draws draw(8);
    const std::vector<Vec3f> points = cloud(draw, 4000);
    const std::vector<float> d = Probe(graph, ball)(points);
    const double divisor = 1 + 0.8 * ops::Noise::lipschitz(3);
    for (const Noise noise : {Noise::Billow, Noise::Fbm}) {
        const std::vector<float> f = Probe(graph, rough(noise))(points);
        double least = 1, most = -1;
        for (size_t i = 0; i < points.size(); ++i) {
            const double height = (d[i] - f[i] * divisor) / 0.2;
            least = std::min(least, height);
            most = std::max(most, height);
        }
        EXPECT_GE(least, noise == Noise::Fbm ? -1.0001 : -1e-4);
        EXPECT_LE(most, 1.0001);
        EXPECT_GT(most, 0.5);  // and it does something
        EXPECT_LT(least, noise == Noise::Fbm ? -0.5 : 0.1);
    }
}

TEST(Morph, IsTheLineBetweenTheTwo) {
    Graph graph;
    Draws draw(9);
    const Field a = someSolid(graph, draw), b = someSolid(graph, draw);
    const std::vector<Vec3f> points = cloud(draw, 300);
    const std::vector<float> fa = Probe(graph, a)(points), fb = Probe(graph, b)(points);
    for (const double t : {0.0, 0.25, 1.0}) {
        const std::vector<float> f = Probe(graph, morph(a, b, graph.slot(static_cast<float>(t)), t, 0))(points);
        for (size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(f[i], fa[i] * (1 - t) + fb[i] * t, 1e-6);
    }
    EXPECT_EQ(morph(a, b, graph.slot(0.0f), 0, 0).bounds, a.bounds);
    EXPECT_EQ(morph(a, b, graph.slot(1.0f), 1, 0).bounds, b.bounds);
}

}  // namespace
}  // namespace sgm::field::test
