// Heights over the plan, and fields that are laid over them.
#include "tests/field/heights.h"

#include "modeler/field/drape.h"
#include "modeler/field/ops.h"
#include "modeler/field/primitives.h"
#include "tests/field/probe.h"

namespace sgm::field::test {
namespace {

TEST(Heights, AreBilinearWithinAndGoOnBeyond) {
    const SampledGridPtr grid = waves(20);
    Draws draw(3);
    for (int i = 0; i < 2000; ++i) {
        const double x = draw.uniform(-1.5, 1.5), z = draw.uniform(-1.2, 1.2);
        EXPECT_NEAR(heightAt(*grid, static_cast<float>(x), static_cast<float>(z)), waveAt(x, z), 2e-3);
    }
    EXPECT_EQ(heightAt(*grid, 40, .3f), heightAt(*grid, 1.5f, .3f));
    EXPECT_EQ(heightAt(*grid, -.2f, -9), heightAt(*grid, -.2f, -1.2f));
}

/// The pyramid's squares enclose what lies in a rectangle, and little else: ranges of small rectangles are small.
TEST(Heights, RangesEncloseAndShrinkWithTheRectangle) {
    for (const int perMetre : {1, 3, 7, 40}) {
        const SampledGridPtr grid = waves(perMetre);
        Draws draw(static_cast<uint64_t>(perMetre));
        for (int i = 0; i < 400; ++i) {
            const float size = static_cast<float>(std::pow(10, draw.uniform(-4, .6)));
            const float x = static_cast<float>(draw.uniform(-2.5, 2)), z = static_cast<float>(draw.uniform(-2, 2));
            const HeightRange range = heightsOver(*grid, x, z, x + size, z + size);
            for (int k = 0; k < 40; ++k) {
                const float h = heightAt(*grid, static_cast<float>(x + draw.uniform(0, 1) * size),
                                         static_cast<float>(z + draw.uniform(0, 1) * size));
                EXPECT_GE(h, range.least);
                EXPECT_LE(h, range.greatest);
            }
            EXPECT_LE(range.greatest - range.least, 2.1 * steepnessOf(*grid) * size + 1e-4) << size;
        }
    }
}

TEST(Heights, SteepnessIsThatOfTheSteepestPatch) {
    std::vector<float> ramp;
    for (int k = 0; k < 5; ++k)
        for (int i = 0; i < 4; ++i) ramp.push_back(static_cast<float>(3 * i + 4 * k) * .5f);
    EXPECT_NEAR(steepnessOf(*heightGrid(0, 0, .5f, 4, 5, ramp)), 5, 1e-2);
    EXPECT_EQ(steepnessOf(*heightGrid(0, 0, .5f, 4, 5, std::vector<float>(20, 7.0f))), 0);
}

TEST(Drape, KeepsItsPromises) {
    for (const double turn : {0.0, .7}) {
        Graph graph;
        const Field box{max(max(abs(graph.x()) - .4f, abs(graph.y() - .1f) - .3f), abs(graph.z()) - .5f),
                        Box3f{{-.4f, -.2f, -.5f}, {.4f, .4f, .5f}}, 1, .577f};
        const Field draped = drape(box, waves(), {{.2, 0, -.1}, Mat3::rotation({0, 1, 0}, turn)}, 5);
        EXPECT_LE(draped.lipschitz, 1);
        expectPromises(graph, draped, draped.bounds.as<double>(), 17, "drape");
    }
}

TEST(Drape, MovesEveryVerticalByTheHeightThere) {
    Graph graph;
    const Field slab{graph.y() - .5f, Box3f{{-9, -9, -9}, {9, .5f, 9}}, 1, 1};
    const SampledGridPtr grid = waves();
    Probe probe(graph, drape(slab, grid, {{}, {}}, 5));
    Draws draw(8);
    for (int i = 0; i < 500; ++i) {
        const Vec3f p = draw.in({{-1, -1, -1}, {1, 1, 1}}).as<float>();
        const float over = p.y - heightAt(*grid, p.x, p.z) - .5f;
        if (std::abs(over) > 1e-4f) {
            EXPECT_EQ(probe(p) > 0, over > 0);
        }
    }
}

}  // namespace
}  // namespace sgm::field::test
