// Every pattern of grammar/std/kifs.sgm on a box: its distances hold, rays find its surface, its mesh is one solid.
// Environment, for longer runs than the suite's: SGM_POINTS, points over all patterns (1000000); SGM_RAYS, pixels along
// a side of the traced picture, all of them (640, every eighth); SGM_CELLS, a list of cells along the box ("256 512").
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "grammar/lower/solids.h"
#include "modeler/core/parallel.h"
#include "modeler/core/random.h"
#include "modeler/field/facade.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"
#include "modeler/mesh/validate.h"
#include "tests/lower/lowered.h"
#include "tests/trace.h"

namespace sgm {
namespace {

using namespace testing_;

const std::vector<std::string>& presets() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> found;
        std::istringstream words(fileText("grammar/std/kifs.sgm"));
        for (std::string word; words >> word;)
            if (word == "terminal" && words >> word) found.push_back(word);
        return found;
    }();
    return names;
}

std::string environment(const char* name, const char* fallback) {
    const char* text = std::getenv(name);
    return text ? text : fallback;
}

class Presets : public testing::TestWithParam<std::string> {
protected:
    /// The pattern on a box of that size.
    static Lowered on(Vec3d size) {
        return Lowered(fmt::format("grammar 1\nuse \"std/kifs.sgm\"\nstart Test -> Box size ({}, {}, {}) clad {}\n",
                                   size.x, size.y, size.z, GetParam()));
    }
    static double number(const Lowered& model, field::FacadeParameter p) {
        return model.derivation.tree.extras.at(model.derivation.tree.shapes[1].extras)
            .clad.at(0)
            .ornament.args[static_cast<size_t>(p)]
            .num();
    }
    static size_t points() { return std::stoul(environment("SGM_POINTS", "1000000")) / presets().size() + 1; }
};

/// Random places of a box.
class Places {
public:
    explicit Places(Box3f box) : box_(box) {}
    float draw(float lo, float hi) { return static_cast<float>(uniform(++counter_, lo, hi)); }
    Vec3f direction() {
        for (;;) {
            const Vec3f d{draw(-1, 1), draw(-1, 1), draw(-1, 1)};
            if (const float l = length(d); l > 0.1f && l <= 1) return d * (1 / l);
        }
    }
    /// Anywhere, or within `depth` of one of the walls.
    Vec3f place(bool beside, float depth) {
        Vec3f p;
        for (int i = 0; i < 3; ++i) p[i] = draw(box_.lo[i], box_.hi[i]);
        if (beside) {
            const int axis = draw(0, 1) < 0.5f ? 0 : 2;
            const float in = draw(-0.1f, depth);
            p[axis] = draw(0, 1) < 0.5f ? box_.lo[axis] + in : box_.hi[axis] - in;
        }
        return p;
    }

private:
    Box3f box_;
    uint64_t counter_ = 0;
};

/// Values of many points.
class Batch {
public:
    void add(Vec3f p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    Vec3f at(size_t i) const { return {x[i], y[i], z[i]}; }
    std::vector<float> values(const eval::Tape& tape) const {
        std::vector<float> f(x.size());
        eval::Workspace workspace;
        eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, f.data(), workspace);
        return f;
    }

private:
    std::vector<float> x, y, z;
};

constexpr Vec3d usual{16, 12, 12};
constexpr float rounding_m = 2e-5f;  ///< of a value, where coordinates are tens of metres

TEST_P(Presets, NoStepCrossesASurface) {
    const Lowered model = on(usual);
    ASSERT_TRUE(model.model);
    const float bound = model.model->field.lipschitz;
    Places draws(model.model->field.bounds);
    Batch from;
    std::vector<Vec3f> ways;
    for (size_t i = 0; i < points(); ++i) {
        from.add(draws.place(i % 2, static_cast<float>(number(model, field::FacadeParameter::Wall))));
        ways.push_back(draws.direction());
    }
    const std::vector<float> f = from.values(model.tape());
    size_t air = 0;
    for (const float share : {0.35f, 0.7f, 0.999f}) {
        Batch there;
        for (size_t i = 0; i < ways.size(); ++i) there.add(from.at(i) + ways[i] * (share * std::abs(f[i]) / bound));
        const std::vector<float> g = there.values(model.tape());
        for (size_t i = 0; i < ways.size(); ++i) {
            if (std::abs(f[i]) * (1 - share) < rounding_m) continue;
            ASSERT_EQ(g[i] < 0, f[i] < 0) << "at " << from.at(i).x << ' ' << from.at(i).y << ' ' << from.at(i).z << ": "
                                          << f[i] << ", then " << g[i];
            air += f[i] > 0;
        }
    }
    EXPECT_GT(air, points() / 10);
}

/// Where the map jumps: planes across each axis, found along a line through the box.
std::array<std::vector<float>, 3> bordersOf(const Lowered& model) {
    const Box3f box = model.model->field.bounds;
    std::array<std::vector<float>, 3> planes;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cellAt = [&](float v) {
            Vec3f p = box.centre();
            p[axis] = v;
            const auto cell = *lower::facadeCellAt(model.derivation.tree, 1, p.as<double>());
            return axis == 0 ? cell.idX : axis == 1 ? cell.storey : cell.idZ;
        };
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            const auto step = [&](int k) {
                return box.lo[axis] + box.size()[axis] * (static_cast<float>(k) + 0.37f) / (steps + 1);
            };
            float a = step(i), b = step(i + 1);
            if (cellAt(a) == cellAt(b)) continue;
            for (int halving = 0; halving < 20; ++halving) (cellAt((a + b) / 2) == cellAt(a) ? a : b) = (a + b) / 2;
            planes[static_cast<size_t>(axis)].push_back((a + b) / 2);
        }
    }
    return planes;
}

/// Pairs 10⁻⁵ … 10⁻¹ m apart, half of them astride the border of a bay or a storey.
TEST_P(Presets, ChangeNoFasterThanTheirBound) {
    const Lowered model = on(usual);
    ASSERT_TRUE(model.model);
    const float bound = model.model->field.lipschitz;
    const auto planes = bordersOf(model);
    ASSERT_FALSE(planes[1].empty());
    Places draws(model.model->field.bounds);
    Batch a, b;
    for (size_t i = 0; i < points(); ++i) {
        Vec3f p = draws.place(i % 4 < 2, static_cast<float>(number(model, field::FacadeParameter::Wall)));
        const Vec3f way = draws.direction();
        const float apart = std::pow(10.0f, draws.draw(-5, -1));
        if (i % 2) {
            size_t axis = static_cast<size_t>(draws.draw(0, 2.999f));
            if (planes[axis].empty()) axis = 1;
            const float plane =
                planes[axis][static_cast<size_t>(draws.draw(0, static_cast<float>(planes[axis].size()) - 0.01f))];
            p[static_cast<int>(axis)] = plane - way[static_cast<int>(axis)] * apart * draws.draw(0, 1);
        }
        a.add(p), b.add(p + way * apart);
    }
    const std::vector<float> f = a.values(model.tape()), g = b.values(model.tape());
    double worst = 0, steepest = 0;
    for (size_t i = 0; i < f.size(); ++i) {
        const double apart = length((a.at(i) - b.at(i)).as<double>()), change = std::abs(double(f[i]) - g[i]);
        worst = std::max(worst, change - bound * apart);
        if (apart > 1e-2) steepest = std::max(steepest, change / apart);
    }
    EXPECT_LE(worst, rounding_m);
    EXPECT_GT(steepest, 0.9) << "the bound is not far off";
}

TEST_P(Presets, RaysFindWhatFineStepsFind) {
    const Lowered model = on(usual);
    ASSERT_TRUE(model.model);
    const std::string all = environment("SGM_RAYS", "");
    const test::Picture picture(model.model->field.bounds, all.empty() ? 640 : std::stoi(all), all.empty() ? 8 : 1);
    const size_t wrong = test::wrongRays(
        picture, model.model->field.lipschitz,
        [&](const float* x, const float* y, const float* z, size_t n, float* out) {
            constexpr size_t some = 4096;
            parallelFor((n + some - 1) / some, 2, nullptr, [&](size_t k, int) {
                thread_local eval::Workspace workspace;
                const size_t first = k * some;
                eval::evaluate(model.tape(), {x + first, y + first, z + first, std::min(some, n - first)}, out + first,
                               workspace);
            });
        });
    if (!all.empty()) fmt::print("{}: {} of {} rays\n", GetParam(), wrong, picture.ways.size());
    EXPECT_LE(static_cast<double>(wrong), 1e-3 * static_cast<double>(picture.ways.size()));
}

/// Closed and manifold; with `keep`, one solid, that is nearly all of it and nearly all of the ornament.
TEST_P(Presets, StandInOnePiece) {
    const std::string cells = environment("SGM_CELLS", "");
    const bool whole = !cells.empty();
    const Vec3d size = whole ? usual : Vec3d{8, 4, 6};
    const Lowered model = on(size);
    ASSERT_TRUE(model.model);
    const double wall = number(model, field::FacadeParameter::Wall), top = number(model, field::FacadeParameter::Top);
    const double inner = (size.x - 2 * wall) * (size.y - top) * (size.z - 2 * wall);
    std::istringstream list(whole ? cells : "128");  // as coarse as 256 are on the whole box
    for (int n; list >> n;) {
        SCOPED_TRACE(n);
        const mesh::Grid grid = mesh::gridFor(model.model->field.bounds, mesh::cellFor(model.model->field.bounds, n));
        mesh::Counts counts;
        const auto blocks = mesh::subdivide(model.tape(), grid, 2, nullptr, counts);
        mesh::Mesh mesh = *mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
        const double all = mesh::measure(mesh).volume_m3;
        const mesh::Dropped dropped = mesh::keepOnly(mesh, mesh::Keep::Grounded, grid.cell_m);
        const mesh::MeshFigures figures = mesh::measure(mesh);
        EXPECT_EQ(figures.boundaryEdges + figures.nonmanifoldEdges, 0u);
        EXPECT_EQ(figures.components, 1u);
        EXPECT_NEAR(figures.volume_m3, all - dropped.volume_m3 + dropped.filled_m3, 1e-3 * all);
        EXPECT_GE(figures.volume_m3, 0.95 * all);
        EXPECT_LE(dropped.volume_m3, 0.05 * (all - inner)) << "of what stands outside the inner shell";
        if (whole)
            fmt::print("{} at {}: {} triangles, {:.2f} % of the ornament left out\n", GetParam(), n, figures.triangles,
                       100 * dropped.volume_m3 / (all - inner));
    }
}

INSTANTIATE_TEST_SUITE_P(Clad, Presets, testing::ValuesIn(presets()), [](const auto& preset) { return preset.param; });

TEST(PresetList, HasAtLeastSixteen) { EXPECT_GE(presets().size(), 16u); }

}  // namespace
}  // namespace sgm
