// A picture of the field shows the solid that the mesh is: no films where cutters touch, no shadows of cutters.
#include <cmath>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/meshing.h"
#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/section.h"
#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/scene.h"

namespace sgm::render::test {
namespace {

class Solids : public OnGpu {};

pipeline::Model modelOf(const std::string& file) {
    syntax::Diagnostics diagnostics;
    const auto grammar = pipeline::loadFile(file, diagnostics);
    EXPECT_TRUE(grammar.ok() && *grammar) << file;
    pipeline::Context context;
    auto model = pipeline::makeModel(*grammar, *pipeline::optionsFor(**grammar, {}), context);
    EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
    return std::move(*model);
}

PictureOptions optionsFor(const pipeline::Model& model, int edge) {
    PictureOptions options;
    options.width = options.height = edge;
    options.camera = frame(model.tape, model.lowered->field.bounds, 1);
    options.ground = false;
    options.samples = 1;
    return options;
}

/// Whose surface every pixel's centre sees of a mesh, plus 1; 0 for the sky. By its triangles one after the other.
std::vector<uint32_t> partsOf(const mesh::Mesh& mesh, const PictureOptions& options) {
    const View view = viewOf(options.camera, options.width, options.height);
    const size_t count = size_t(options.width) * size_t(options.height);
    std::vector<uint32_t> parts(count, 0);
    std::vector<double> nearest(count, INFINITY);
    const Vec3d across = view.right / dot(view.right, view.right), upward = view.up / dot(view.up, view.up);
    std::vector<Vec3f> positions;
    for (const mesh::Chunk& chunk : mesh.chunks)
        positions.insert(positions.end(), chunk.positions.begin(), chunk.positions.end());
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (size_t t = 0; t < chunk.triangles.size(); ++t) {
            double x[3], y[3], inverse[3];
            const mesh::Triangle triangle = chunk.inMesh(chunk.triangles[t]);
            for (size_t k = 0; k < 3; ++k) {
                const Vec3d v = positions[triangle[static_cast<int>(k)]].as<double>() - view.eye;
                const double depth = dot(v, view.forward);
                inverse[k] = 1 / depth;
                x[k] = (dot(v, across) / depth + 1) / 2 * options.width;
                y[k] = (1 - dot(v, upward) / depth) / 2 * options.height;
            }
            const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
            if (area == 0) continue;
            const auto low = [](double a, double b, double c) { return std::max(0, int(std::min({a, b, c}))); };
            for (int py = low(y[0], y[1], y[2]); py < std::min<double>(options.height, std::max({y[0], y[1], y[2]}));
                 ++py)
                for (int px = low(x[0], x[1], x[2]); px < std::min<double>(options.width, std::max({x[0], x[1], x[2]}));
                     ++px) {
                    double share[3];
                    for (size_t k = 0; k < 3; ++k) {
                        const size_t a = (k + 1) % 3, b = (k + 2) % 3;
                        share[k] = ((x[a] - px - .5) * (y[b] - py - .5) - (x[b] - px - .5) * (y[a] - py - .5)) / area;
                    }
                    if (std::min({share[0], share[1], share[2]}) < 0) continue;
                    const double depth = 1 / (share[0] * inverse[0] + share[1] * inverse[1] + share[2] * inverse[2]);
                    const size_t at = size_t(py) * size_t(options.width) + size_t(px);
                    if (depth >= nearest[at]) continue;
                    nearest[at] = depth;
                    parts[at] = chunk.origins[t] + 1;
                }
        }
    return parts;
}

Layers layersOf(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance,
                const PictureOptions& options, TracedBy by) {
    auto painter = FieldPainter::create(tape, bounds, provenance, 2, nullptr, by);
    EXPECT_TRUE(painter.ok());
    Layers layers;
    const auto image = painter->draw(options, nullptr, &layers);
    EXPECT_TRUE(image.ok());
    return layers;
}
Layers layersOf(const pipeline::Model& model, const PictureOptions& options, TracedBy by) {
    return layersOf(model.tape, model.lowered->field.bounds, model.lowered->provenance, options, by);
}

/// Shares of the pixels in which the field's picture and the mesh's differ.
struct Difference {
    double silhouette, parts;
};
Difference difference(const std::string& name, int edge, TracedBy by) {
    const pipeline::Model model = modelOf("tests/render/solids/" + name + ".sgm");
    const PictureOptions options = optionsFor(model, edge);
    pipeline::Context context;
    const auto meshed = pipeline::makeMesh(model, pipeline::gridOf(model, 320), {}, context);
    EXPECT_TRUE(meshed.ok());
    const std::vector<uint32_t> mesh = partsOf(meshed->mesh, options);
    const Layers field = layersOf(model, options, by);
    size_t silhouette = 0, parts = 0;
    for (size_t i = 0; i < mesh.size(); ++i) {
        const bool seen = field.depth[i] < Layers::farAway;
        silhouette += seen != (mesh[i] != 0);
        parts += (seen ? uint32_t(field.origin[i]) + 1 : 0) != mesh[i];
    }
    const auto all = static_cast<double>(mesh.size());
    return {static_cast<double>(silhouette) / all, static_cast<double>(parts) / all};
}

TEST_F(Solids, PictureOfTheFieldIsThatOfTheMesh) {
    for (const char* name : {"film", "band", "splitcut", "turnat", "two", "thin2"}) {
        const Difference d = difference(name, 640, TracedBy::Processor);
        EXPECT_LT(d.silhouette, .005) << name;
        EXPECT_LT(d.parts, .005) << name;
        std::printf("%s: %.4f %% by silhouette, %.4f %% by part\n", name, 100 * d.silhouette, 100 * d.parts);
    }
}

TEST_F(Solids, ShadersDrawTheSameSolids) {
    for (const char* name : {"film", "band"}) {
        // Of fewer pixels more lie on edges; the film took 1.6 %.
        const Difference d = difference(name, 160, TracedBy::Gpu);
        EXPECT_LT(d.silhouette, .01) << name;
        EXPECT_LT(d.parts, .01) << name;
    }
}

float valueOf(const eval::Tape& tape, Vec3f p) {
    eval::Workspace workspace;
    float value = 0;
    eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &value, workspace);
    return value;
}

/// Whose surface a field shows at a place near it.
OriginId ownerAt(const eval::Tape& tape, Vec3f p) {
    eval::Workspace workspace;
    OriginId owner = 0;
    eval::evaluateOrigin(tape, {&p.x, &p.y, &p.z, 1}, &owner, workspace);
    return owner;
}

TEST(Section, ShowsEachPartWhereThePlaneRunsThroughIt) {
    Scene scene;
    const OriginId rock = scene.origin({.5f, .4f, .3f}), basin = scene.origin({.2f, .9f, .2f}),
                   water = scene.origin({.1f, .2f, .8f});
    const field::Field cut = field::difference({scene.solid("cube", {0, 0, 0}, {3, 2, 3}), rock},
                                               {scene.solid("cube", {0, 1, 0}, {2, 1.5, 2}), basin});
    const field::Owned parts[] = {{cut, 0}, {scene.solid("cube", {0, 0, 0}, {2, .5, 2}), water}};
    const field::Field whole = field::sum(scene.graph, parts);
    const field::Field open = field::section(scene.graph, whole, {0, 0, 1}, .25);
    const eval::Tape tape = scene.compile(open);
    EXPECT_EQ(ownerAt(tape, {0, -1, .25f}), rock);
    EXPECT_EQ(ownerAt(tape, {-2.05f, 1, .25f}), rock) << "a wall beside what was cut is the host's";
    EXPECT_EQ(ownerAt(tape, {-2.9f, 1, .25f}), rock);
    EXPECT_EQ(ownerAt(tape, {.5f, .1f, .25f}), water);
    EXPECT_EQ(ownerAt(tape, {1.9f, 1, -2}), basin) << "the walls of a cut stay its own";
    EXPECT_EQ(open.bounds.hi.z, .25f);
    for (uint64_t i = 0; i < 500; ++i) {
        const Vec3f p{static_cast<float>(uniform(combine(1, i), -4, 4)),
                      static_cast<float>(uniform(combine(2, i), -3, 3)),
                      static_cast<float>(uniform(combine(3, i), -4, 4))};
        EXPECT_EQ(valueOf(tape, p), std::max(valueOf(scene.compile(whole), p), p.z - .25f));
    }
}

/// Light on the back of the recess, straight from the front: least and greatest along a line across the cutters'
/// overlap.
TEST_F(Solids, CuttersThatOverlapThrowNoShadow) {
    const pipeline::Model model = modelOf("tests/render/solids/band.sgm");
    PictureOptions options = optionsFor(model, 160);
    options.camera = {{0, 0, 9}, {0, 0, 0}};
    for (const TracedBy by : {TracedBy::Processor, TracedBy::Gpu}) {
        const Layers layers = layersOf(model, options, by);
        float darkest = INFINITY, lightest = 0, hidden = 0;
        for (int y = 65; y < 95; ++y) {
            const size_t at = size_t(y) * 160 + 90;
            darkest = std::min(darkest, layers.color[at].y);
            lightest = std::max(lightest, layers.color[at].y);
            hidden = std::max(hidden, 1 - layers.ao[at]);
        }
        EXPECT_LT(lightest - darkest, .02f) << (by == TracedBy::Gpu ? "shaders" : "processor");
        EXPECT_LT(hidden, .03f) << (by == TracedBy::Gpu ? "shaders" : "processor");
    }
}

/// The top edges of the walls lie in the planes of the roof.
TEST_F(Solids, EdgesThatEndInASurfaceDoNotShowThroughIt) {
    const pipeline::Model model = modelOf("tests/render/solids/eaves.sgm");
    const PictureOptions options = optionsFor(model, 640);
    for (const TracedBy by : {TracedBy::Processor, TracedBy::Gpu}) {
        const Layers layers = layersOf(model, options, by);
        size_t alone = 0;
        for (size_t y = 2; y < 638; ++y)
            for (size_t x = 2; x < 638; ++x) {
                const size_t at = y * 640 + x;
                const float around = layers.origin[at - 2];
                const bool plane = layers.origin[at + 2] == around && layers.origin[at - 1280] == around &&
                                   layers.origin[at + 1280] == around && layers.depth[at] < Layers::farAway;
                alone += plane && layers.origin[at] != around;
            }
        EXPECT_EQ(alone, 0u) << (by == TracedBy::Gpu ? "shaders" : "processor");
    }
}

/// The walls of a block with a nook: no pixel of the line where they meet is brighter than the walls beside it.
TEST_F(Solids, NooksAreEvenlyDark) {
    Scene scene;
    scene.add("cube", {-3, 0, 0}, {5, 3, 6}, {.6f, .6f, .6f});
    scene.add("cube", {5, 0, -3}, {3, 3, 3}, {.6f, .6f, .6f});
    const field::Field solid = scene.sum();
    PictureOptions options;
    options.width = options.height = 240;
    options.camera = {{17, 14, 19}, {3, -.2, .1}, .2};
    options.ground = false;
    options.samples = 1;
    const Layers layers = layersOf(scene.compile(solid), solid.bounds, scene.provenance, options, TracedBy::Processor);
    // Pixels that the walls' line crosses, at (2, 0): half of the day is hidden from either wall, and a little more by
    // this measure.
    size_t crossed = 0;
    for (size_t i = 0; i < layers.ao.size(); ++i) {
        const Vec3f p = layers.position[i];
        if (layers.depth[i] == Layers::farAway || std::abs(p.y) > 1.5f || std::hypot(p.x - 2, p.z) > .008f) continue;
        ++crossed;
        EXPECT_NEAR(layers.ao[i], 0.08f + 0.92f * (1 - 0.65f), .05f);
    }
    EXPECT_GT(crossed, 20u);
}

TEST_F(Solids, SkyIsHiddenGraduallyInFrontOfOpenings) {
    const pipeline::Model model = modelOf("examples/buildings/palace.sgm");
    PictureOptions options = optionsFor(model, 320);
    options.camera = {{30, 8, 12}, {19.5, -3.3, 0}, .5};  // the plinth beside a row of windows
    for (const TracedBy by : {TracedBy::Processor, TracedBy::Gpu}) {
        const Layers layers = layersOf(model, options, by);
        const auto onPlinth = [&](size_t i) {
            return layers.depth[i] < Layers::farAway && layers.normal[i].y > .99f && layers.position[i].x > 19.6f &&
                   layers.position[i].x < 20.2f && std::abs(layers.position[i].y + 3.3f) < .05f;
        };
        float steepest = 0;
        size_t count = 0;
        for (size_t i = 0; i + 1 < layers.ao.size(); ++i) {
            if (!onPlinth(i) || !onPlinth(i + 1)) continue;
            ++count;
            steepest = std::max(steepest, std::abs(layers.ao[i + 1] - layers.ao[i]) /
                                              length(layers.position[i + 1] - layers.position[i]));
        }
        EXPECT_GT(count, 5000u);
        EXPECT_LT(steepest, 2) << "a metre; " << (by == TracedBy::Gpu ? "shaders" : "processor");
    }
}

TEST_F(Solids, SeamsOfAWallHaveItsNormal) {
    const pipeline::Model model = modelOf("tests/render/solids/tiles.sgm");
    PictureOptions options = optionsFor(model, 320);
    options.camera = {{14, 8, 12}, {0, 0, .5}, .5};
    const Layers layers = layersOf(model, options, TracedBy::Processor);
    size_t count = 0, turned = 0;
    for (size_t i = 0; i < layers.normal.size(); ++i) {
        const Vec3f p = layers.position[i];
        if (layers.depth[i] == Layers::farAway || p.z < .49f || std::abs(p.x) > 5.8f || std::abs(p.y) > 2.8f) continue;
        ++count;
        turned += layers.normal[i].z < .99f;
    }
    EXPECT_GT(count, 10000u);
    EXPECT_EQ(turned, 0u);
}

/// A bar on a pane, seen at a slant: where they meet each has its own look.
TEST_F(Solids, NooksShowThePartOfTheirFace) {
    Scene scene;
    scene.add("cube", {1.6, 0, 0}, {2.4, 3, .1}, {.2f, .3f, .4f});
    scene.add("cube", {-1, 0, .3}, {.2, 3, .3}, {.9f, .9f, .8f});
    const OriginId bar = static_cast<OriginId>(scene.provenance.parts.size() - 1);
    const field::Field solid = scene.sum();
    PictureOptions options;
    options.width = options.height = 200;
    options.camera = {{9, 3, 9}, {0, 0, 0}, .4};
    options.ground = false;
    options.samples = 1;
    const Layers layers = layersOf(scene.compile(solid), solid.bounds, scene.provenance, options, TracedBy::Processor);
    size_t pane = 0, mixed = 0;
    for (size_t i = 0; i < layers.origin.size(); ++i) {
        const Vec3f p = layers.position[i];
        if (layers.depth[i] == Layers::farAway || layers.normal[i].z < .99f || p.z > .12f || p.x < -.8f) continue;
        ++pane;
        mixed += layers.origin[i] == static_cast<float>(bar);
    }
    EXPECT_GT(pane, 5000u);
    EXPECT_EQ(mixed, 0u);
}

/// A thin body on the way to the sky is left behind: what lies beyond it hides the rest.
TEST_F(Solids, NoDayComesIntoAClosedHollowBehindACone) {
    const pipeline::Model model = modelOf("tests/render/solids/hollow.sgm");
    PictureOptions options = optionsFor(model, 240);
    options.camera = inside(model.tape, model.lowered->field.bounds);
    for (const TracedBy by : {TracedBy::Processor, TracedBy::Gpu}) {
        const Layers layers = layersOf(model, options, by);
        float bluest = 0;
        for (const Vec3f& color : layers.color) bluest = std::max(bluest, color.z / color.x);
        EXPECT_LT(bluest, .7f) << "the lamp is warm; " << (by == TracedBy::Gpu ? "shaders" : "processor");
    }
}

}  // namespace
}  // namespace sgm::render::test
