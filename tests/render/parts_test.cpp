// The viewer's parts that need no picture: cells, camera, PNG files, and shaders as a second compiler sees them.
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/eval/glsl.h"
#include "tests/render/scenes.h"
#include "viewer/render/camera.h"
#include "viewer/render/cells.h"
#include "viewer/render/picture.h"
#include "viewer/render/prepared_field.h"
#include "viewer/render/scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render::test {
namespace {

/// A folder of this test's own, gone at its end.
class Parts : public testing::Test {
protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() / ("sgm_viewer_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::filesystem::path folder;
};

float valueOf(const eval::Tape& tape, Vec3f p) {
    eval::Workspace workspace;
    float value = 0;
    eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
    return value;
}

TEST_F(Parts, ACoatThinnerThanAProbeOwnsItsSurface) {
    Scene scene;
    scene.add("cube", {0, 0, 0}, {3, 1, 3}, {1, 1, 1});
    scene.add("cube", {0, 1, 0}, {2, .002, 2}, {1, 0, 0});  // 2 mm above the other
    const field::Field field = scene.sum();
    const auto prepared = prepareField(scene.compile(field), field.bounds, scene.provenance, 2, nullptr);
    ASSERT_TRUE(prepared.ok());
    const auto probe = [](float x, float from, float to) { return PreparedField::Probe{{x, from, .5f}, {x, to, .5f}}; };
    EXPECT_EQ(
        prepared->originsOf({probe(.5f, 1.003f, .993f), probe(2.5f, 1.003f, .993f), probe(.5f, 1.0015f, .9915f)}, 2),
        (std::vector<OriginId>{2, 1, 2}))
        << "on the coat, beside it, and from within it";
}

/// Where the two touch the field is 0 again: a probe that ends there, or a little above or below, met the upper one.
TEST_F(Parts, ASlabOwnsItsSurfaceWhereAProbeEndsAtItsFoot) {
    Scene scene;
    scene.add("cube", {0, 0, 0}, {3, 1, 3}, {1, 1, 1});
    scene.add("cube", {0, 1.0625, 0}, {2, .0625, 2}, {1, 0, 0});
    const field::Field field = scene.sum();
    const auto prepared = prepareField(scene.compile(field), field.bounds, scene.provenance, 2, nullptr);
    ASSERT_TRUE(prepared.ok());
    std::vector<PreparedField::Probe> probes;
    for (const float foot : {1.0f, .999f, 1.001f, .95f, 1.05f})
        for (const float slant : {0.0f, .5f, 1.5f}) probes.push_back({{.5f, 1.14f, 0}, {.5f + slant, foot, 0}});
    EXPECT_EQ(prepared->originsOf(probes, 1), std::vector<OriginId>(probes.size(), 2));
}

/// Their fields differ by rounding alone, which changes from probe to probe.
TEST_F(Parts, FacesInOnePlaneBelongToTheFirst) {
    Scene scene;
    scene.add("cube", {0, -2, 0}, {3, 5.3, 3}, {1, 1, 1});
    scene.add("cube", {0, 2.4, 0}, {2, .9, 2}, {1, 0, 0});
    const field::Field field = scene.sum();
    const auto prepared = prepareField(scene.compile(field), field.bounds, scene.provenance, 2, nullptr);
    ASSERT_TRUE(prepared.ok());
    std::vector<PreparedField::Probe> probes;
    for (int i = 0; i < 400; ++i) {
        const float x = .004f * static_cast<float>(i), slant = .001f * static_cast<float>(i % 7);
        probes.push_back({{x, 3.303f, .5f}, {x + slant, 3.293f - slant, .5f}});
    }
    EXPECT_EQ(prepared->originsOf(probes, 1), std::vector<OriginId>(probes.size(), 1));
}

TEST_F(Parts, CellsKnowTheFieldExactly) {
    Scene scene;
    for (uint64_t i = 0; i < 40; ++i) {
        const double r = uniform(combine(4, i), 0.3, 0.9);
        scene.add("sphere",
                  {uniform(combine(1, i), -4, 4), uniform(combine(2, i), -1, 1), uniform(combine(3, i), -3, 3)},
                  {r, r, r}, {1, 1, 1});
    }
    const field::Field field = scene.sum();
    const eval::Tape tape = scene.compile(field);
    const float margin = 0.5f;
    for (const int levels : {1, 2, CellTree::surfaceDepth}) {
        const auto tree = cutIntoCells(tape, field.bounds.inflated(margin), margin, 2, nullptr, levels);
        ASSERT_TRUE(tree.ok());
        size_t near = 0, shorter = 0;
        for (uint64_t i = 0; i < 3000; ++i) {
            Vec3f p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = static_cast<float>(
                    uniform(combine(10 + uint64_t(axis), i), field.bounds.lo[axis], field.bounds.hi[axis]));
            const uint32_t word = tree->find(p);
            const float value = valueOf(tape, p);
            switch (CellTree::stateOf(word)) {
                case CellState::Outside:
                    EXPECT_GT(value, margin);
                    break;
                case CellState::Inside:
                    EXPECT_LT(value, -margin);
                    break;
                case CellState::Near: {
                    const eval::Tape& local = tree->tapes[CellTree::indexOf(word)];
                    EXPECT_EQ(valueOf(local, p), value);
                    const eval::FloatInterval range = tree->ranges[CellTree::indexOf(word)];
                    EXPECT_TRUE(range.lo <= value && value <= range.hi);
                    ++near;
                    shorter += local.size() * 4 < tape.size() ? 1 : 0;
                    break;
                }
                case CellState::Node:
                    ADD_FAILURE() << "find must end at a leaf";
            }
        }
        EXPECT_GT(near, 500u);
        if (levels <= 2) {
            EXPECT_LE(tree->nodes.size(), levels == 1 ? 64u : 64u + 64u * 64u);
            continue;
        }
        EXPECT_GT(shorter, near * 9 / 10) << "cells are there to make tapes short";
    }
}

TEST_F(Parts, FrameFitsTheBoxTightly) {
    for (const Vec3f size : {Vec3f{1, 1, 1}, Vec3f{10, 1, 2}, Vec3f{1, 30, 1}})
        for (const double aspect : {1.0, 1.6, 0.6}) {
            const Box3f box{Vec3f{5, -2, 1}, Vec3f{5, -2, 1} + size};
            const Camera camera = frame(box, aspect);
            const View view = viewOf(camera, static_cast<int>(1000 * aspect), 1000);
            double most = 0;
            for (int i = 0; i < 8; ++i) {
                const Vec3d v =
                    Vec3f{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z}
                        .as<double>() -
                    view.eye;
                const double depth = dot(v, view.forward);
                EXPECT_GT(depth, 0);
                most = std::max({most, std::abs(dot(v, view.right) / dot(view.right, view.right)) / depth,
                                 std::abs(dot(v, view.up) / dot(view.up, view.up)) / depth});
            }
            EXPECT_LT(most, 0.92);
            EXPECT_GT(most, 0.80);
            EXPECT_GT(camera.eye.y, camera.at.y);
        }
}

TEST_F(Parts, TheGroundLiesWhereTheSolidEnds) {
    Scene scene;
    scene.add("cube", {0, 0, 0}, {2, 2, 2}, {.6f, .6f, .6f});
    scene.add("cube", {2, 1, 0}, {.5, .5, .5}, {.6f, .6f, .6f});
    const field::Field solid = field::blend(scene.graph, scene.parts, scene.graph.slot(.8f), .8);
    ASSERT_LT(solid.bounds.lo.y, -2.05f) << "a blend's bounds reach below what it holds";
    const Box3f tight = tighten(scene.compile(solid), solid.bounds);
    EXPECT_LE(tight.lo.y, -2);
    EXPECT_GT(tight.lo.y, -2.01f);
}

TEST_F(Parts, PngKeepsEveryByte) {
    Image image{37, 19, {}};
    for (int i = 0; i < 37 * 19 * 3; ++i) image.rgb.push_back(static_cast<uint8_t>(mix(uint64_t(i))));
    const auto path = folder / "noise.png";
    ASSERT_TRUE(writePng(image, path).ok());
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&png, path.c_str()));
    png.format = PNG_FORMAT_RGB;
    std::vector<uint8_t> read(PNG_IMAGE_SIZE(png));
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, read.data(), 0, nullptr));
    EXPECT_EQ(png.width, 37u);
    EXPECT_EQ(png.height, 19u);
    EXPECT_EQ(read, image.rgb);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1)
        << "nothing is left beside the picture";
}

TEST_F(Parts, PngThatCannotBeWrittenLeavesTheOldOne) {
    const auto path = folder / "old.png";
    std::ofstream(path) << "old";
    EXPECT_FALSE(writePng(Image{}, path).ok());
    EXPECT_EQ(std::filesystem::file_size(path), 3u);
    EXPECT_FALSE(writePng(Image{1, 1, {0, 0, 0}}, folder / "nowhere" / "new.png").ok());
}

TEST_F(Parts, AnotherCompilerTakesEveryShader) {
    if (std::system("command -v glslangValidator >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "glslangValidator isn't installed";
    const std::string interpreter = eval::interpreterGlsl(64);
    for (const Shader& shader : shaders()) {
        const auto path = folder / (std::string(shader.name) + "." + std::string(shader.stage));
        std::ofstream(path) << shaderText(shader.name, interpreter);
        const auto log = folder / "log";
        EXPECT_EQ(std::system(("glslangValidator " + path.string() + " >" + log.string() + " 2>&1").c_str()), 0)
            << shader.name << ":\n"
            << std::ifstream(log).rdbuf();
    }
}

}  // namespace
}  // namespace sgm::render::test
