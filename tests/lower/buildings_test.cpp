// The houses of grammar/std/house.sgm (SG-M III-D), measured: open doors, windows of their size, linear storeys, closed
// roofs.
#include <cmath>
#include <map>

#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"
#include "modeler/mesh/validate.h"
#include "tests/lower/lowered.h"

namespace sgm {
namespace {

using namespace testing_;

/// A house whose parameters are those of the standard library but for `settings`. Its ground floor is centred at 0.
std::string house(const std::string& settings) {
    return "grammar 1\nuse \"std/house.sgm\"" + (settings.empty() ? "" : " { " + settings + " }") +
           "\nstart Test -> House\n";
}

/// Metres of air around `p` along `axis`, in steps of 5 mm; 0 when p is solid.
double airAlong(const Lowered& model, Vec3f p, int axis) {
    constexpr float step_m = 0.005f;
    if (model.inside(p)) return 0;
    double length = 0;
    for (const float way : {-step_m, step_m}) {
        Vec3f q = p;
        while (std::abs(q[axis] - p[axis]) < 50 && !model.inside(q)) q[axis] += way;
        length += std::abs(q[axis] - p[axis]);
    }
    return length;
}

bool airBetween(const Lowered& model, Vec3f a, Vec3f b) {
    for (int i = 0; i <= 200; ++i)
        if (model.inside(a + (b - a) * (static_cast<float>(i) / 200))) return false;
    return true;
}

std::vector<derive::Shape> shapesCalled(const derive::Derivation& d, const std::string& label) {
    std::vector<derive::Shape> found;
    for (const derive::Shape& s : d.tree.shapes)
        if (d.tree.labels[s.label] == label) found.push_back(s);
    return found;
}

mesh::Mesh meshed(const Lowered& model, float cell_m) {
    const mesh::Grid grid = mesh::gridFor(model.model->field.bounds, cell_m);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(model.tape(), grid, 2, nullptr, counts);
    return *mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
}

TEST(House, TheDoorIsOpenAndLeadsIntoARoom) {
    const Lowered open(house("door = (2.4, 3, .5)"));
    for (const float x : {-1.1f, 0.0f, 1.1f})
        for (const float y : {-2.0f, 0.0f, 0.7f})
            EXPECT_TRUE(airBetween(open, {x, y, 14}, {0, -1, 0})) << x << ' ' << y;
    EXPECT_TRUE(open.inside({1.4f, 0, 6.2f}));                    // the portal beside it
    EXPECT_TRUE(open.inside({0, 1, 6.2f}));                       // and above
    EXPECT_FALSE(airBetween(open, {0, 3.5f, 14}, {0, 3.5f, 0}));  // the storey above has none
    const Lowered shut(house("rooms = none"));
    EXPECT_FALSE(airBetween(shut, {0, 0, 14}, {0, 0, 0}));
}

TEST(House, AWindowIsAHoleOfItsSize) {
    // Five bays of 16 m · 0.92; the second of six storeys is 4.2 m high about 2.2 + 2.1 m.
    for (const double wide : {0.3, 0.6}) {
        const Lowered d(house("widelo = " + std::to_string(wide) + " widehi = " + std::to_string(wide)));
        const Vec3f window{static_cast<float>(16 * .92 * -.2), 4.1f, 5.9f};
        EXPECT_NEAR(airAlong(d, window, 0), 16 * wide / 5, 0.011);
        EXPECT_NEAR(airAlong(d, window, 1), 4.2 * .62, 0.011);
        EXPECT_TRUE(d.inside({window.x, window.y, 5.2f}));  // glass
        EXPECT_EQ(d.owner({window.x + .4f, window.y, 5.53f}).symbol(), "glass");
    }
    const Lowered unglazed(house("glazed = false rooms = all"));
    EXPECT_TRUE(airBetween(unglazed, {-2.5f, 4.0f, 12}, {-2.5f, 4.0f, 0}));
    EXPECT_FALSE(airBetween(unglazed, {-1.5f, 4.0f, 12}, {-1.2f, 4.0f, 0}));  // wall
}

TEST(House, EveryCharacteristicOfAStoreyRunsLinearly) {
    const Lowered d(house(
        "floors = 5 lowest = (20, 5, 16) topmost = (12, 3, 8) bulgelo = -1.2m bulgehi = -.4m widelo = .6 widehi = .4 "
        "highlo = .7 highhi = .5 frame = 0m mullion = 0m bays = 1 deep = 1 jut = 0m"));
    auto storeys = shapesCalled(d.derivation, "Storey");
    ASSERT_EQ(storeys.size(), 5u);
    const mesh::Mesh mesh = meshed(d, 0.2f);
    for (size_t i = 0; i < 5; ++i) {
        const double t = static_cast<double>(i) / 4;
        const derive::Scope& scope = storeys[i].scope;
        const Vec3d size = Vec3d{20, 5, 16} + (Vec3d{12, 3, 8} - Vec3d{20, 5, 16}) * t;
        expectNear(scope.size, size);
        const Vec3f window = (scope.centre + Vec3d{0, -.2, .1 - size.z / 2}).as<float>();
        EXPECT_NEAR(airAlong(d, window, 0), size.x * (.6 - .2 * t), 0.011);
        EXPECT_NEAR(airAlong(d, window, 1), size.y * (.7 - .2 * t), 0.011);
        float deepest = window.z;
        while (deepest < 0 && !d.inside({window.x, window.y, deepest})) deepest += 0.005f;
        EXPECT_NEAR(size.z / 2 + deepest, 1.2 - .8 * t - .04, 0.011);  // the glass stands .04 m before the niche's back
        float reach = 0;
        for (const mesh::Chunk& c : mesh.chunks)
            for (const Vec3f& p : c.positions)
                if (std::abs(p.y - scope.centre.y) < size.y * .1 && p.z > size.z / 2 - .3) reach = std::max(reach, p.x);
        EXPECT_NEAR(reach, size.x / 2, 0.01) << i;
    }
}

TEST(House, ConvexFloorsAreFourSumsConcaveOnesFourDifferences) {
    // Of the second of two storeys, since none stands before the door.
    const auto sides = [](const std::string& bulge, const std::string& label, rules::Operator op) {
        const auto d = derived(house("floors = 2 bays = 1 deep = 1 bulgelo = " + bulge + " bulgehi = " + bulge));
        size_t count = 0;
        for (const derive::Shape& s : shapesCalled(d, label)) count += s.op == op && s.scope.centre.y > 2.2;
        return count;
    };
    EXPECT_EQ(sides(".8m", "Oriel", rules::Operator::Sum), 4u);
    EXPECT_EQ(sides("-.8m", "Opening", rules::Operator::Difference), 4u);
    EXPECT_EQ(sides("-.8m", "Oriel", rules::Operator::Sum), 0u);
}

TEST(House, GluedWallsDontGrow) {
    const auto d = derived(house("floors = 4"));
    for (derive::ShapeId id = 0; id < d.tree.shapes.size(); ++id) {
        if (d.tree.labels[d.tree.shapes[id].label] != "Storey") continue;
        EXPECT_TRUE(d.tree.bonds().closed(id, 2) &&
                    d.tree.bonds().closed(id, 3));  // +y, -y: floors, the roof, the plinth
        EXPECT_FALSE(d.tree.bonds().closed(id, 0) || d.tree.bonds().closed(id, 5));
    }
    // Blocks that would grow a knob on every side grow none where they are glued to another.
    const auto knobs = derived(R"(grammar 1
start Tower -> Block : Floor
rule Floor repeat 3 -> + Block at +y : Floor
rule Block -> Knobs
rule Knobs -> cube for d in axes { + sphere size .3 at d }
)");
    EXPECT_EQ(shapesCalled(knobs, "sphere").size(), 4u * 6 - 3 * 2);
    ASSERT_EQ(knobs.closed.size(), 1u);
    EXPECT_EQ(knobs.closed[0].count, 6u);
}

TEST(House, TheRoofIsClosedFromPyramidToSphere) {
    for (const std::string peak : {"0", ".25", ".5", ".75", "1"}) {
        SCOPED_TRACE(peak);
        const Lowered d("grammar 1\nstart A -> cube size (8, 2, 6) + roof(" + peak + ") size (8, 3, 6) at +y\n");
        const mesh::Mesh mesh = meshed(d, 0.12f);
        const mesh::MeshFigures f = mesh::measure(mesh);
        EXPECT_EQ(f.boundaryEdges + f.nonmanifoldEdges, 0u);
        EXPECT_EQ(mesh::connectedComponents(mesh, 0.12f).size(), 1u);
        EXPECT_NEAR(f.bounds.hi.y, 4, 0.1);
        // No gap at the foot: whatever stands over the ellipse inside the foot stands on it.
        for (double angle = 0; angle < 6.28; angle += 0.2)
            EXPECT_TRUE(d.inside(
                {static_cast<float>(3.9 * std::cos(angle)), 1.02f, static_cast<float>(2.9 * std::sin(angle))}));
    }
}

TEST(House, SetbacksTwistsAndCourtyards) {
    const auto set = derived(house("floors = 9 tier = 3 lowest = (20, 4, 20) topmost = (10, 4, 10)"));
    const auto storeys = shapesCalled(set, "Storey");
    for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(storeys[i].scope.size.x, 20 - 5.0 * static_cast<double>(i / 3), 1e-9);
    const auto twisted = derived(house("floors = 10 spin = 5deg"));
    EXPECT_NEAR(shapesCalled(twisted, "Storey").back().scope.axes.x.x, std::cos(45 * 3.14159265358979 / 180), 1e-9);
    const Lowered court(house("floors = 2 court = .5 rooms = none lowest = (30, 4, 30) topmost = (30, 4, 30)"));
    EXPECT_TRUE(airBetween(court, {0, 30, 0}, {0, -1.9f, 0}));
    EXPECT_NEAR(airAlong(court, {0, 1.8f, 0}, 0), 15, 0.02);  // above the windows
}

TEST(House, NothingFloatsWhateverTheStyle) {
    for (const char* settings : {"", "court = .4 floors = 3", "columns = 2 dormers = 3", "balcony = 1.5m arch = .5",
                                 "bulgelo = 1m bulgehi = -1m"}) {
        SCOPED_TRACE(settings);
        const Lowered d(house(settings));
        EXPECT_EQ(d.derivation.floating(), 0u);
        EXPECT_EQ(mesh::connectedComponents(meshed(d, 0.25f), 0.25f).size(), 1u);
    }
}

}  // namespace
}  // namespace sgm
