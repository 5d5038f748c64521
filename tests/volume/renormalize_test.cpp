// A renormalised band holds distances, leaves the isosurface where it is, and is the same at any thread count.
#include "modeler/volume/renormalize.h"

#include <gtest/gtest.h>

#include <cmath>

#include "modeler/mesh/validate.h"
#include "modeler/volume/keep.h"
#include "tests/scratch.h"
#include "tests/volume/shapes.h"

namespace sgm::volume {
namespace {

Volume renormalized(const Volume& level, int threads = 2) {
    auto result = renormalize(level, threads, nullptr);
    EXPECT_TRUE(result.ok());
    return std::move(result).value();
}

/// The values of a volume by voxel, in voxels.
struct Samples {
    const Volume& volume;
    mesh::Grid grid;
    explicit Samples(const Volume& v) : volume(v) {
        grid.cell_m = v.voxel_m();
        const Box3f box = v.bounds();
        grid.origin = box.lo + Vec3f{1, 1, 1} * (grid.cell_m / 2);
        const Vec3f size = box.size() / grid.cell_m;
        grid.cells = {static_cast<int>(std::lround(size.x)), static_cast<int>(std::lround(size.y)),
                      static_cast<int>(std::lround(size.z))};
    }
    float at(Vec3i v) const { return volume.at(grid.corner(v.x, v.y, v.z)) / grid.cell_m; }
    template <class F>
    void forAll(const F& f) const {
        for (int i = 0; i < grid.cells.x; ++i)
            for (int j = 0; j < grid.cells.y; ++j)
                for (int k = 0; k < grid.cells.z; ++k) f(Vec3i{i, j, k});
    }
};

constexpr Vec3i axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// How far |∇f| is from 1 by central differences, over voxels within two of the isosurface. Left out is where the
/// gradient jumps, at the medial axis and in the fan of directions next to a crease: there the differences to both
/// sides of a voxel disagree by more than a tenth along some axis.
struct Slopes {
    size_t voxels = 0, smooth = 0, off = 0;  ///< `off` counts smooth ones with |∇f| off 1 by more than .02
    double mean = 0, worst = 0;

    explicit Slopes(const Volume& volume) {
        const Samples f(volume);
        f.forAll([&](Vec3i v) {
            const float own = f.at(v);
            if (std::abs(own) > 2) return;
            ++voxels;
            double squared = 0;
            for (const Vec3i& axis : axes) {
                const double up = f.at(v + axis) - own, down = own - f.at(v - axis);
                if (std::abs(up - down) > 0.1) return;
                squared += (up + down) * (up + down) / 4;
            }
            ++smooth;
            const double error = std::abs(std::sqrt(squared) - 1);
            mean += error;
            worst = std::max(worst, error);
            off += error > 0.02;
        });
        mean /= static_cast<double>(smooth);
    }
    double shareOff() const { return static_cast<double>(off) / static_cast<double>(smooth); }
};

/// How far the isosurface of `moved` is from where that of `still` crosses the grid's edges, in voxels, on average.
double movement(const Volume& still, const Volume& moved) {
    const Samples a(still), b(moved);
    double sum = 0;
    size_t crossings = 0;
    a.forAll([&](Vec3i v) {
        for (const Vec3i& axis : axes) {
            const float from = a.at(v), to = a.at(v + axis);
            if ((from < 0) == (to < 0)) continue;
            const Vec3f p = a.grid.corner(v.x, v.y, v.z), q = p + axis.as<float>() * a.grid.cell_m;
            const float lo = moved.at(p) / b.grid.cell_m, hi = moved.at(q) / b.grid.cell_m, t = from / (from - to);
            EXPECT_EQ(lo < 0, from < 0);
            EXPECT_EQ(hi < 0, to < 0);
            sum += std::abs(lo + (hi - lo) * t);
            ++crossings;
        }
    });
    return sum / static_cast<double>(crossings);
}

/// Fields that are no distance: steeper, flatter, and bent by noise.
KnownSolid steep() {
    KnownSolid s = twoBalls(1, 1.2f);
    s.field.value = s.field.value * 2.5f;
    return s;
}
KnownSolid flat() {
    KnownSolid s = torus(1, 0.4f);
    s.field.value = s.field.value * 0.4f;
    return s;
}
KnownSolid bent() {
    KnownSolid s = oneBall(1);
    field::Graph& g = *s.graph;
    s.field.value = s.field.value * 0.7f + sin(g.x() * 5.0f) * sin(g.y() * 4.0f + 1.0f) * sin(g.z() * 6.0f) * 0.08f;
    s.field.bounds = s.field.bounds.inflated(0.15f);
    return s;
}

TEST(Renormalize, SlopesAreOne) {
    for (KnownSolid (*make)() : {steep, flat, bent}) {
        const Volume raw = *levelSetOf(make(), 0.02f), exact = renormalized(raw);
        const Slopes before(raw), after(exact);
        EXPECT_GT(before.shareOff(), 0.9) << "else there is nothing to show";
        EXPECT_GT(after.smooth, after.voxels * 9 / 10);
        EXPECT_LT(after.shareOff(), 0.005) << after.worst;
        EXPECT_LT(after.mean, 0.005);
        EXPECT_LT(movement(raw, exact), 0.005);
    }
}

TEST(Renormalize, ADistanceStaysAsItIs) {
    const Volume raw = *levelSetOf(oneBall(1), 0.04f), exact = renormalized(raw);
    EXPECT_NEAR(static_cast<double>(exact.activeVoxels()), static_cast<double>(raw.activeVoxels()),
                2e-3 * static_cast<double>(raw.activeVoxels()));
    EXPECT_NEAR(exact.enclosed_m3(), raw.enclosed_m3(), 2e-3 * raw.enclosed_m3());
    const Samples a(raw), b(exact);
    a.forAll([&](Vec3i v) {
        const Vec3f p = a.grid.corner(v.x, v.y, v.z);
        ASSERT_NEAR(exact.at(p), raw.at(p), 0.02f * raw.voxel_m());
    });
}

/// The values of a box's field are no distances outside its edges; its faces stay where they are.
TEST(Renormalize, CreasesKeepTheirPlaces) {
    KnownSolid box;
    field::Graph& g = *box.graph;
    const field::NodeRef x = abs(g.x() - 0.013f), y = abs(g.y() + 0.021f), z = abs(g.z() - 0.008f);
    box.field.value = max(max(x - 0.5f, y - 0.4f), z - 0.3f);
    box.field.bounds = {{-0.6f, -0.5f, -0.4f}, {0.6f, 0.5f, 0.4f}};
    const Volume raw = *levelSetOf(box, 0.02f), exact = renormalized(raw);
    EXPECT_LT(movement(raw, exact), 0.01);
    EXPECT_LT(Slopes(exact).shareOff(), 0.02);
    EXPECT_NEAR(exact.enclosed_m3(), 8 * 0.5 * 0.4 * 0.3, 2e-3);
    // Two voxels off an edge to both sides: a distance says √8 where the field says 2.
    const float h = raw.voxel_m();
    const Vec3f p{0.513f + 2 * h, 0.379f + 2 * h, 0};
    EXPECT_NEAR(exact.at(p) / h, std::sqrt(8.0), 0.75);
    EXPECT_GT(exact.at(p), raw.at(p) + 0.2f * h);
}

/// A field that jumps has no values near zero: the isosurface goes half-way between the voxels.
TEST(Renormalize, AJumpBecomesABand) {
    KnownSolid jump = oneBall(1);
    jump.field.value = max(min(jump.field.value * 1e5f, 5.0f), -5.0f);
    const Volume raw = *levelSetOf(jump, 0.04f), exact = renormalized(raw);
    EXPECT_EQ(raw.activeVoxels(), 0u);
    EXPECT_NEAR(static_cast<double>(exact.activeVoxels()) * std::pow(0.04, 3), 4 * pi * 6 * 0.04, 0.25);
    EXPECT_NEAR(exact.enclosed_m3(), jump.volume_m3, 0.02 * jump.volume_m3);
}

TEST(Renormalize, IsTheSameAtAnyThreadCountAndInWiderBands) {
    const Scratch folder;
    for (const int halfWidth : {1, 3, 9}) {
        const float voxel_m = halfWidth > 3 ? 0.08f : 0.03f;
        const Volume raw = *levelSetOf(bent(), voxel_m, halfWidth);
        std::string first;
        for (const int threads : {1, 2, 5}) {
            const Volume exact = renormalized(raw, threads);
            ASSERT_TRUE(writeVdb(exact, folder / "a.vdb", "level_set").ok());
            const std::string bytes = contentOf(folder / "a.vdb");
            if (first.empty()) first = bytes;
            EXPECT_EQ(bytes == first, true) << threads << " threads";
        }
        const Volume exact = renormalized(raw);
        EXPECT_FLOAT_EQ(exact.at({9, 9, 9}), static_cast<float>(halfWidth) * voxel_m);
        EXPECT_FLOAT_EQ(exact.at(somewhere), -static_cast<float>(halfWidth) * voxel_m);
        if (halfWidth > 1) {
            EXPECT_LT(Slopes(exact).shareOff(), 0.05);
        }
    }
}

TEST(Renormalize, TakesWhatKeepLeaves) {
    KnownSolid two = oneBall(1);
    two.field.value = min(two.field.value, ball(*two.graph, {0, 2.5f, 0}, 0.5f)) * 0.5f;
    two.field.bounds = {{-1.3f, -1.5f, -1.3f}, {1.3f, 3.1f, 1.3f}};
    Volume level = *levelSetOf(two, 0.05f);
    ASSERT_TRUE(keepOnly(level, mesh::Keep::Largest, level.voxel_m(), nullptr).ok());
    const Volume exact = renormalized(level);
    EXPECT_EQ(mesh::measure(*toMesh(exact)).components, 1u);
    EXPECT_NEAR(exact.enclosed_m3(), 4 * pi / 3, 0.03);
    EXPECT_LT(Slopes(exact).shareOff(), 0.01);
}

TEST(Renormalize, NothingStaysNothingAndCancelStops) {
    const Volume raw = *levelSetOf(bent(), 0.05f);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(renormalize(raw, 2, &progress).error().kind, Error::Kind::Cancelled);
    KnownSolid none = oneBall(1);
    none.field.value = none.field.value + 5.0f;
    EXPECT_EQ(renormalized(*levelSetOf(none, 0.1f)).activeVoxels(), 0u);
}

}  // namespace
}  // namespace sgm::volume
