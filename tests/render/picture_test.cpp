// What a picture must show: the silhouette where projection says, the materials, the ground's shadow; and nothing
// random.
#include <cmath>

#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/draw.h"
#include "viewer/render/scene.h"
#include "viewer/render/tracer.h"

namespace sgm::render::test {
namespace {

class Picture : public OnGpu {};

constexpr int edge = 128;
constexpr Vec3f red{0.7f, 0.05f, 0.04f}, green{0.04f, 0.5f, 0.06f};

PictureOptions optionsAt(const Camera& camera, bool ground) {
    PictureOptions options;
    options.width = options.height = edge;
    options.camera = camera;
    options.ground = ground;
    return options;
}

/// Red, green and blue of the pixel that a place projects to.
std::array<int, 3> colorAt(const Image& image, const Camera& camera, Vec3d place) {
    const View view = viewOf(camera, image.width, image.height);
    const Vec3d v = place - view.eye;
    const double depth = dot(v, view.forward);
    const double x = dot(v, view.right) / dot(view.right, view.right) / depth,
                 y = dot(v, view.up) / dot(view.up, view.up) / depth;
    const auto px = static_cast<size_t>((x + 1) / 2 * image.width),
               py = static_cast<size_t>((1 - y) / 2 * image.height);
    const size_t at = (py * size_t(image.width) + px) * 3;
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// A UV sphere with outward normals, all of one origin.
mesh::Mesh ballMesh(Vec3f centre, float radius, OriginId origin) {
    constexpr uint32_t rings = 48, around = 96;
    mesh::Mesh mesh;
    mesh::Chunk& chunk = mesh.chunks.emplace_back();
    for (uint32_t i = 0; i <= rings; ++i)
        for (uint32_t j = 0; j <= around; ++j) {
            const double a = i * 3.14159265358979 / rings, b = j * 2 * 3.14159265358979 / around;
            const Vec3f n = Vec3d{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)}.as<float>();
            chunk.positions.push_back(centre + n * radius);
            chunk.normals.push_back(n);
        }
    for (uint32_t i = 0; i < rings; ++i)
        for (uint32_t j = 0; j < around; ++j) {
            const uint32_t a = i * (around + 1) + j, b = a + around + 1;
            chunk.triangles.push_back({a, a + 1, b});
            chunk.triangles.push_back({b, a + 1, b + 1});
        }
    chunk.origins.assign(chunk.triangles.size(), origin);
    return mesh;
}

/// A red ball of radius 1 about the origin, seen from 5 m.
struct RedBall {
    Scene scene;
    field::Field field;
    Camera camera{{0, 0, 5}, {0, 0, 0}};
    RedBall() {
        scene.add("sphere", {0, 0, 0}, {1, 1, 1}, red);
        field = scene.sum();
    }
    Result<Image> draw(bool ground) {
        return drawField(scene.compile(field), field.bounds, scene.provenance, optionsAt(camera, ground), nullptr);
    }
};

/// Every pixel that lies clearly inside the ball's cone of sight is red, clearly outside it is sky.
void expectSilhouette(const Image& image) {
    // Seen from distance d, a ball of radius r covers the cone of half angle asin(r/d).
    const double radius = std::tan(std::asin(1.0 / 5)) / std::tan(0.35) * edge / 2;
    int wrong = 0;
    for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
            const double r = std::hypot(x + 0.5 - edge / 2.0, y + 0.5 - edge / 2.0);
            const uint8_t* rgb = &image.rgb[(size_t(y) * edge + size_t(x)) * 3];
            if (r < radius - 1.5 && !(rgb[0] > rgb[2])) ++wrong;
            if (r > radius + 1.5 && !(rgb[2] >= rgb[0])) ++wrong;
        }
    EXPECT_EQ(wrong, 0);
}

TEST_F(Picture, FieldSilhouetteIsWhereProjectionSays) {
    const auto image = RedBall().draw(false);
    ASSERT_TRUE(image.ok()) << image.error().message;
    expectSilhouette(*image);
}

TEST_F(Picture, MeshSilhouetteIsWhereProjectionSays) {
    RedBall ball;
    const auto image =
        drawMesh(ballMesh({0, 0, 0}, 1, 1), ball.scene.provenance, optionsAt(ball.camera, false), nullptr);
    ASSERT_TRUE(image.ok()) << image.error().message;
    expectSilhouette(*image);
}

TEST_F(Picture, MaterialsBelongToTheirParts) {
    Scene scene;
    scene.add("sphere", {-1.2, 0, 0}, {1, 1, 1}, red);
    scene.add("sphere", {1.2, 0, 0}, {1, 1, 1}, green);
    const field::Field field = scene.sum();
    const Camera camera = frame(field.bounds, 1);
    const auto image =
        drawField(scene.compile(field), field.bounds, scene.provenance, optionsAt(camera, true), nullptr);
    ASSERT_TRUE(image.ok()) << image.error().message;
    const auto left = colorAt(*image, camera, {-1.2, 0, 0}), right = colorAt(*image, camera, {1.2, 0, 0});
    EXPECT_GT(left[0], left[1] + 40);
    EXPECT_GT(right[1], right[0] + 40);
}

TEST_F(Picture, GroundTakesTheShadow) {
    RedBall ball;
    ball.camera = frame(ball.field.bounds, 1);
    const auto field = ball.draw(true);
    const auto mesh = drawMesh(ballMesh({0, 0, 0}, 1, 1), ball.scene.provenance, optionsAt(ball.camera, true), nullptr);
    const Vec3d sun = sunDirection().as<double>();
    // The middle of the shadow, and as far from the ball on the sunny side; the eye sees both beside the ball.
    const Vec3d shadow = sun * (-1 / sun.y), sunny = {-shadow.x, -1, -shadow.z};
    for (const auto& image : {field, mesh}) {
        ASSERT_TRUE(image.ok()) << image.error().message;
        const auto dark = colorAt(*image, ball.camera, shadow + Vec3d{0.75, 0, 0}),
                   light = colorAt(*image, ball.camera, sunny + Vec3d{0.9, 0, 0.6});
        EXPECT_LT(dark[1] + 25, light[1]);
    }
}

TEST_F(Picture, TheSunStandsInTheSky) {
    RedBall ball;
    const Vec3d sun = sunDirection().as<double>();
    ball.camera = {sun * 3, sun * 9};
    for (const auto& image : {ball.draw(false), ball.draw(true)}) {
        ASSERT_TRUE(image.ok()) << image.error().message;
        const auto middle = colorAt(*image, ball.camera, sun * 9),
                   corner = std::array<int, 3>{image->rgb[0], image->rgb[1], image->rgb[2]};
        EXPECT_GT(middle[0], 240);
        EXPECT_GT(middle[2], 220);
        EXPECT_LT(corner[0] + 40, middle[0]);
    }
}

TEST_F(Picture, TwoRunsGiveTheSameBytes) {
    RedBall ball;
    ball.camera = frame(ball.field.bounds, 1);
    PictureOptions options = optionsAt(ball.camera, true);
    options.threads = 1;
    const eval::Tape tape = ball.scene.compile(ball.field);
    const auto one = drawField(tape, ball.field.bounds, ball.scene.provenance, options, nullptr);
    options.threads = 3;
    const auto three = drawField(tape, ball.field.bounds, ball.scene.provenance, options, nullptr);
    ASSERT_TRUE(one.ok() && three.ok());
    EXPECT_EQ(one->rgb, three->rgb);
}

/// Pixels in which two pictures differ by more than can be seen side by side.
size_t differentPixels(const Image& a, const Image& b) {
    size_t different = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3) {
        int most = 0;
        for (size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int(a.rgb[i + c]) - int(b.rgb[i + c])));
        different += most > 6 ? 1 : 0;
    }
    return different;
}

TEST_F(Picture, ShadersAndProcessorTraceTheSame) {
    Scene scene;
    for (int i = 0; i < 27; ++i)
        scene.add(i % 2 ? "sphere" : "cube", {2.5 * (i % 3), 2.5 * (i / 3 % 3), 2.5 * (i / 9)}, {1.1, 1, 1.2},
                  i % 3 ? red : green);
    const field::Field spheres = scene.sum();
    const field::Field rock = scene.solid("cube", {0, 0, 0}, {4, 3, 3}),
                       hollow = scene.solid("sphere", {1, 0.5, 0}, {2, 2, 2}),
                       shaft = scene.solid("cube", {1, 3, 0}, {0.6, 6, 0.6});
    const field::Field cave =
        field::difference({field::difference({rock, scene.origin({0.5f, 0.4f, 0.3f})}, {hollow, 0}), 0}, {shaft, 0});
    for (const auto& [field, within] : {std::pair{spheres, false}, {cave, true}, {spheres, true}}) {
        const eval::Tape tape = scene.compile(field);
        const PictureOptions options =
            optionsAt(within ? inside(tape, field.bounds) : frame(tape, field.bounds, 1), !within);
        std::vector<Image> images;
        for (const TracedBy by : {TracedBy::Gpu, TracedBy::Processor}) {
            auto painter = FieldPainter::create(tape, field.bounds, scene.provenance, 0, nullptr, by);
            ASSERT_TRUE(painter.ok()) << painter.error().message;
            const auto image = painter->draw(options, nullptr);
            ASSERT_TRUE(image.ok()) << image.error().message;
            images.push_back(*image);
        }
        EXPECT_LT(differentPixels(images[0], images[1]), size_t(edge) * edge / 200);
    }
}

TEST_F(Picture, RaysStartWhereTheConeBesideAnotherIsFree) {
    Scene scene;
    for (int i = 0; i < 9; ++i)
        scene.add(i % 2 ? "sphere" : "cube", {2.5 * (i % 3), 2.5 * (i / 3), 0}, {1.1, 1, 1.2}, red);
    for (int i = 0; i < 6; ++i)
        scene.add("cube", {1.2 * i, 2.5, 3.0}, {0.03, 4, 0.03}, green);  // posts, narrower than a pixel
    const field::Field solid = scene.sum();
    const eval::Tape tape = scene.compile(solid);
    auto field = prepareField(tape, solid.bounds, scene.provenance, 1, nullptr);
    ASSERT_TRUE(field.ok()) << field.error().message;
    const auto tracer = processorTracer(std::make_shared<const PreparedField>(std::move(*field)), 1);
    const PictureOptions options = optionsAt(frame(tape, solid.bounds, 1), true);
    tracer->look(options, 1);
    const View view = viewOf(options.camera, edge, edge);
    std::vector<Ray> first, whole, started;
    for (const Job& job : firstSamples(edge, edge))
        first.push_back({job, 0, 0, static_cast<float>(0.75 * view.pixelAngle)});
    const auto met = tracer->trace(first, nullptr);
    ASSERT_TRUE(met.ok());
    for (size_t i = 0; i < first.size(); ++i) {
        const Job second{first[i].job.pixel, 1};
        whole.push_back({second});
        started.push_back({second, met->free[i]});
    }
    const uint64_t before = tracer->cost().hits;
    const auto all = tracer->trace(whole, nullptr);
    const uint64_t between = tracer->cost().hits;
    const auto rest = tracer->trace(started, nullptr);
    ASSERT_TRUE(all.ok() && rest.ok());
    EXPECT_LT((tracer->cost().hits - between) * 10, (between - before) * 9);
    size_t different = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
        const Hit &a = all->hits[i], &b = rest->hits[i];
        const double pixel = view.pixelAngle * length(a.position.as<double>() - view.eye);
        different +=
            a.kind() != b.kind() || (a.kind() == HitKind::Object && length(a.position - b.position) > 3 * pixel) ? 1
                                                                                                                 : 0;
    }
    EXPECT_LT(different, size_t(edge) * edge / 500);
}

TEST_F(Picture, SharedLightLooksLikeEverySamplesOwn) {
    Scene scene;
    for (int i = 0; i < 5; ++i)
        scene.add(i % 2 ? "sphere" : "cube", {2.5 * i, 0.3 * i, 0.7 * i}, {1.1, 1, 1.2}, i % 3 ? red : green);
    const field::Field field = scene.sum();
    const eval::Tape tape = scene.compile(field);
    auto painter = FieldPainter::create(tape, field.bounds, scene.provenance, 0, nullptr);
    ASSERT_TRUE(painter.ok()) << painter.error().message;
    const PictureOptions options = optionsAt(frame(tape, field.bounds, 1), true);
    const auto shared = painter->draw(options, nullptr);
    const uint64_t evaluations = painter->cost().lightEvaluations;
    Layers layers;  // which hold what each sample asked for itself
    const auto own = painter->draw(options, nullptr, &layers);
    ASSERT_TRUE(shared.ok() && own.ok());
    EXPECT_LT(evaluations * 4, painter->cost().lightEvaluations * 3);
    EXPECT_LT(differentPixels(*shared, *own), size_t(edge) * edge / 40);  // creases, a pixel wide
}

TEST_F(Picture, EdgesAreSmooth) {
    RedBall ball;
    PictureOptions options = optionsAt(ball.camera, false);
    const eval::Tape tape = ball.scene.compile(ball.field);
    const auto levels = [&](int samples) {
        options.samples = samples;
        const auto image = drawField(tape, ball.field.bounds, ball.scene.provenance, options, nullptr);
        // Blue changes most from the ball to the sky: count values between the two along the silhouette.
        size_t between = 0;
        for (size_t i = 0; image.ok() && i < image->rgb.size(); i += 3)
            between += image->rgb[i + 2] > 150 && image->rgb[i + 2] < 195 ? 1 : 0;
        return between;
    };
    EXPECT_GT(levels(8), levels(1) + 40);
}

TEST_F(Picture, InsideStandsInTheHollow) {
    Scene scene;
    const field::Field rock = scene.solid("cube", {0, 0, 0}, {4, 3, 3}),
                       cave = scene.solid("sphere", {1, 0.5, 0}, {2, 2, 2});
    const field::Field field = field::difference({rock, scene.origin({0.5f, 0.4f, 0.3f})}, {cave, 0});
    const eval::Tape tape = scene.compile(field);
    const Camera camera = inside(tape, field.bounds);
    EXPECT_LT(length(camera.eye - Vec3d{1, 0.5, 0}), 2.0);
    EXPECT_GT(camera.lamp_m, 1.0);
    const auto image = drawField(tape, field.bounds, scene.provenance, optionsAt(camera, true), nullptr);
    ASSERT_TRUE(image.ok()) << image.error().message;
    // No sky comes in, and the lamp lights what there is.
    for (size_t i = 0; i < image->rgb.size(); i += 3) {
        ASSERT_GE(image->rgb[i], image->rgb[i + 2]);
        ASSERT_GT(image->rgb[i], 30);
    }
}

TEST_F(Picture, AnEyeInAHollowHasALampAndOneInTheOpenHasNone) {
    Scene scene;
    const field::Field rock = scene.solid("cube", {0, 0, 0}, {4, 3, 3}),
                       cave = scene.solid("sphere", {1, 0.5, 0}, {2, 2, 2}),
                       pit = scene.solid("cube", {-3, 2, 0}, {1, 2, 1});
    const field::Field field = field::difference({field::difference({rock, 0}, {cave, 0}), 0}, {pit, 0});
    const eval::Tape tape = scene.compile(field);
    EXPECT_GT(lampFor(tape, field.bounds, {1, 0.5, 0}), 1.9);
    EXPECT_LT(lampFor(tape, field.bounds, {1, 0.5, 0}), 8);
    EXPECT_EQ(lampFor(tape, field.bounds, {-3, 2.5, 0}), 0) << "in a pit";
    EXPECT_EQ(lampFor(tape, field.bounds, {-1.5, 2.5, 2.5}), 0) << "in the rock";
    EXPECT_EQ(lampFor(tape, field.bounds, {9, 0, 0}), 0);
    EXPECT_EQ(lampFor(tape, field.bounds, {-3.99, 2.5, 0}), 0) << "a centimetre from the pit's wall";
    EXPECT_GT(lampFor(tape, field.bounds, {1, 0.5, -1.99}), 1.9) << "a centimetre from the cave's";
}

TEST_F(Picture, InsidePrefersAnOpenPitToTheSolid) {
    Scene scene;
    const field::Field rock = scene.solid("cube", {0, 0, 0}, {6, 3, 4}),
                       pit = scene.solid("cube", {1, 2, 0}, {3, 3, 1.5});
    const field::Field field = field::difference({rock, scene.origin({0.5f, 0.4f, 0.3f})}, {pit, 0});
    const Camera camera = inside(scene.compile(field), field.bounds);
    EXPECT_LT(length(Vec3d{(camera.eye.x - 1) / 3, 0, camera.eye.z / 1.5}), 1.5);
    EXPECT_GT(camera.eye.y, -1);
    EXPECT_LT(camera.eye.y, 3);
}

TEST_F(Picture, InsideASolidDrawsItFromWithin) {
    Scene scene;
    scene.add("sphere", {0, 0, 0}, {2, 2, 2}, {0.6f, 0.5f, 0.4f});
    const field::Field field = scene.sum();
    const eval::Tape tape = scene.compile(field);
    const Camera camera = inside(tape, field.bounds);
    EXPECT_LT(length(camera.eye), 2.0);
    const auto image = drawField(tape, field.bounds, scene.provenance, optionsAt(camera, true), nullptr);
    ASSERT_TRUE(image.ok()) << image.error().message;
    for (size_t i = 0; i < image->rgb.size(); i += 3) ASSERT_GE(image->rgb[i], image->rgb[i + 2]);
}

TEST_F(Picture, NeedsFewEvaluationsOfShortTapes) {
    Scene scene;
    for (int i = 0; i < 64; ++i)
        scene.add("sphere", {3.0 * (i % 4), 3.0 * (i / 4 % 4), 3.0 * (i / 16)}, {1, 1, 1}, red);
    const field::Field field = scene.sum();
    const eval::Tape tape = scene.compile(field);
    auto painter = FieldPainter::create(tape, field.bounds, scene.provenance, 0, nullptr);
    ASSERT_TRUE(painter.ok()) << painter.error().message;
    const PictureOptions options = optionsAt(frame(field.bounds, 1), true);
    ASSERT_TRUE(painter->draw(options, nullptr).ok());
    const DrawCost& cost = painter->cost();
    EXPECT_GT(cost.samples, size_t(edge) * edge);
    EXPECT_EQ(cost.probes.size(), (cost.samples + 63) / 64);
    const double evaluations = double(cost.hitEvaluations + cost.lightEvaluations),
                 plain = plainEvaluations(tape, field.bounds, options, cost.probes);
    EXPECT_LT(evaluations, plain * double(cost.samples));
    EXPECT_LT(double(cost.instructions) * 30, plain * double(cost.samples) * double(tape.size()));
}

TEST_F(Picture, PlainSphereTracingOfABallCountsItsSteps) {
    RedBall ball;
    const eval::Tape tape = ball.scene.compile(ball.field);
    const PictureOptions options = optionsAt(ball.camera, false);
    // Straight at the ball: into the bounds, a step to the surface; 4 for the normal, 4 for occlusion; out towards the
    // sun.
    const double middle = plainEvaluations(tape, ball.field.bounds, options, {{edge / 2.0, edge / 2.0}});
    EXPECT_GE(middle, 10);
    EXPECT_LE(middle, 18);
    EXPECT_EQ(plainEvaluations(tape, ball.field.bounds, options, {{1, 1}}), 0) << "misses the bounds";
}

TEST_F(Picture, CanBeCancelled) {
    RedBall ball;
    Progress progress;
    progress.cancel();
    const auto image = drawField(ball.scene.compile(ball.field), ball.field.bounds, ball.scene.provenance,
                                 optionsAt(ball.camera, true), &progress);
    ASSERT_FALSE(image.ok());
    EXPECT_EQ(image.error().kind, Error::Kind::Cancelled);
}

TEST_F(Picture, RefusesWhatCannotBeDrawn) {
    RedBall ball;
    const eval::Tape tape = ball.scene.compile(ball.field);
    PictureOptions flat = optionsAt(ball.camera, true);
    flat.height = 0;
    EXPECT_FALSE(drawField(tape, ball.field.bounds, ball.scene.provenance, flat, nullptr).ok());
    EXPECT_FALSE(drawField(tape, Box3f{}, ball.scene.provenance, optionsAt(ball.camera, true), nullptr).ok());
    EXPECT_FALSE(
        drawField(tape, ball.field.bounds, ball.scene.provenance, optionsAt({{1, 1, 1}, {1, 1, 1}}, true), nullptr)
            .ok());
    EXPECT_FALSE(drawMesh({}, ball.scene.provenance, optionsAt(ball.camera, true), nullptr).ok());
}

}  // namespace
}  // namespace sgm::render::test
