// Shadows of thin bodies and of bodies in pieces: dark in the umbra, wherever the field says little of how deep it is,
// with an edge that widens as what casts it is farther away.
#include <algorithm>
#include <cmath>

#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/scene.h"

namespace sgm::render::test {
namespace {

class Shadows : public OnGpu {};

constexpr float halfLength = 15, top = 6, ground = -6;  // metres

/// A wall of 30 × 12 × .5 m along x, of so many pieces that touch.
Layers wall(int pieces, TracedBy by) {
    Scene scene;
    const double half = halfLength / pieces;
    for (int i = 0; i < pieces; ++i)
        scene.add("cube", {-halfLength + half * (2 * i + 1), 0, 0}, {half, top, .25}, {.6f, .6f, .6f});
    const field::Field field = scene.sum();
    auto painter = FieldPainter::create(scene.compile(field), field.bounds, scene.provenance, 2, nullptr, by);
    EXPECT_TRUE(painter.ok());
    PictureOptions options;
    options.width = 320;
    options.height = 240;
    options.camera = {{4, 30, -22}, {4, ground, -5}};
    options.samples = 1;
    Layers layers;
    EXPECT_TRUE(painter->draw(options, nullptr, &layers).ok());
    return layers;
}

/// Where on the wall's plane the ray from a place on the ground into the sun comes through; metres.
struct Through {
    float x, y, distance;
};
Through throughWall(Vec3f place) {
    const Vec3f sun = sunDirection();
    const float t = -place.z / sun.z;
    return {place.x + t * sun.x, place.y + t * sun.y, t};
}

bool onGround(const Layers& layers, size_t i) {
    return layers.depth[i] < Layers::farAway && layers.normal[i].y > .99f && layers.position[i].y < ground + .01f &&
           layers.position[i].z < -1;
}

/// The whole sun lies behind the wall, and the wall's foot is far enough away to take no light of the sky.
bool inUmbra(const Layers& layers, size_t i) {
    if (!onGround(layers, i) || layers.ao[i] < .98f) return false;
    const Through at = throughWall(layers.position[i]);
    const float sun = .04f * at.distance + .5f;
    return at.y < top - sun && std::abs(at.x) < halfLength - sun;
}

/// The whole sun is seen.
bool inTheSun(const Layers& layers, size_t i) {
    if (!onGround(layers, i) || layers.ao[i] < .98f) return false;
    const Through at = throughWall(layers.position[i]);
    return at.y > top + .06f * at.distance + .5f;
}

class ShadowsBy : public Shadows, public testing::WithParamInterface<TracedBy> {};

TEST_P(ShadowsBy, UmbraOfAThinWallIsDarkInPiecesToo) {
    for (const int pieces : {1, 10}) {
        const Layers layers = wall(pieces, GetParam());
        float darkest = INFINITY, brightest = 0, sunny = INFINITY;
        size_t count = 0;
        for (size_t i = 0; i < layers.color.size(); ++i) {
            if (inTheSun(layers, i)) sunny = std::min(sunny, layers.color[i].y);
            if (!inUmbra(layers, i)) continue;
            darkest = std::min(darkest, layers.color[i].y);
            brightest = std::max(brightest, layers.color[i].y);
            ++count;
        }
        EXPECT_GT(count, 5000u);
        EXPECT_LT(brightest - darkest, .025f) << pieces << " pieces, haze over the ground included";
        EXPECT_LT(brightest * 2, sunny) << pieces << " pieces";
    }
}

/// Greens of the ground in one column of the picture's, away from the wall, beyond `nearest` metres.
std::vector<float> outward(const Layers& layers, size_t column, float nearest) {
    std::vector<std::pair<float, float>> greens;
    for (size_t y = 0; y < 240; ++y) {
        const size_t i = y * 320 + column;
        if (onGround(layers, i) && layers.position[i].z < -nearest)
            greens.push_back({-layers.position[i].z, layers.color[i].y});
    }
    std::ranges::sort(greens);
    std::vector<float> sorted;
    for (const auto& [z, green] : greens) sorted.push_back(green);
    return sorted;
}

TEST_P(ShadowsBy, PenumbraGrowsBrighterOutward) {
    const Layers layers = wall(10, GetParam());
    for (const size_t column : {size_t(130), size_t(160), size_t(190)}) {
        const std::vector<float> greens = outward(layers, column, 5);
        ASSERT_GT(greens.size(), 50u);
        const float darkest = greens.front(), brightest = *std::ranges::max_element(greens);
        EXPECT_GT(brightest, 2 * darkest);
        size_t between = 0;
        float most = 0;
        for (size_t k = 0; k + 1 < greens.size(); ++k) {
            EXPECT_LT(greens[k] - greens[k + 1], .02f * (brightest - darkest)) << "column " << column;
            most = std::max(most, greens[k + 1] - greens[k]);
            between +=
                greens[k] > darkest + .1f * (brightest - darkest) && greens[k] < darkest + .9f * (brightest - darkest);
        }
        EXPECT_GT(between, 4u) << "the edge is soft";
        EXPECT_LT(most, .4f * (brightest - darkest)) << "and has no steps";
    }
}

/// How wide the edge of the shadow is that the wall's end casts, `far` metres behind it; metres.
float edgeWidth(const Layers& layers, float far) {
    float low = INFINITY, high = -INFINITY, darkest = INFINITY, brightest = 0;
    const auto inRow = [&](size_t i) {
        return onGround(layers, i) && std::abs(layers.position[i].z + far) < .1f &&
               std::abs(throughWall(layers.position[i]).x + halfLength) < 3;
    };
    for (size_t i = 0; i < layers.color.size(); ++i) {
        if (!inRow(i)) continue;
        darkest = std::min(darkest, layers.color[i].y);
        brightest = std::max(brightest, layers.color[i].y);
    }
    for (size_t i = 0; i < layers.color.size(); ++i) {
        const float share = (layers.color[i].y - darkest) / (brightest - darkest);
        if (!inRow(i) || share < .1f || share > .9f) continue;
        low = std::min(low, throughWall(layers.position[i]).x);
        high = std::max(high, throughWall(layers.position[i]).x);
    }
    return std::max(high - low, 0.0f);
}

TEST_P(ShadowsBy, PenumbraWidensWithDistance) {
    const Layers layers = wall(1, GetParam());
    EXPECT_GT(edgeWidth(layers, 8), 2 * edgeWidth(layers, 2));
    EXPECT_GT(edgeWidth(layers, 8), .3f);
    EXPECT_LT(edgeWidth(layers, 8), 1.2f);
}

INSTANTIATE_TEST_SUITE_P(Tracers, ShadowsBy, testing::Values(TracedBy::Processor, TracedBy::Gpu),
                         [](const auto& test) { return test.param == TracedBy::Gpu ? "Shaders" : "Processor"; });

}  // namespace
}  // namespace sgm::render::test
