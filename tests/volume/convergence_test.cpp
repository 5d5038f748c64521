// The volumes of mesh and level set go to the closed forms with the square of the voxel.
#include <gtest/gtest.h>

#include <cmath>

#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/validate.h"
#include "tests/volume/shapes.h"

namespace sgm::volume {
namespace {

struct Errors {
    double mesh = 0, levelSet = 0;  ///< shares of the true volume
};

Errors errorsAt(const KnownSolid& solid, float voxel_m) {
    const eval::Tape tape = solid.tape();
    const mesh::Grid grid = mesh::gridFor(solid.field.bounds, voxel_m);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    const auto meshed = mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
    const auto level = sample(*blocks, tape, grid, 3, 2, nullptr);
    const auto share = [&](double volume_m3) { return std::abs(volume_m3 - solid.volume_m3) / solid.volume_m3; };
    return {share(mesh::measure(*meshed).volume_m3), share(level->enclosed_m3())};
}

/// Two halvings must divide an error by 16, give or take where the lattice happens to lie.
void expectSecondOrder(const KnownSolid& solid, float voxel_m) {
    const Errors coarse = errorsAt(solid, voxel_m), fine = errorsAt(solid, voxel_m / 4);
    const auto order = [](double a, double b) { return std::log2(a / b) / 2; };
    EXPECT_LT(coarse.mesh, 0.02);
    EXPECT_LT(coarse.levelSet, 0.02);
    EXPECT_GT(order(coarse.mesh, fine.mesh), 1.8) << coarse.mesh << " to " << fine.mesh;
    EXPECT_GT(order(coarse.levelSet, fine.levelSet), 1.8) << coarse.levelSet << " to " << fine.levelSet;
}

TEST(Convergence, Sphere) { expectSecondOrder(oneBall(1), 0.08f); }
TEST(Convergence, TwoOverlappingSpheres) { expectSecondOrder(twoBalls(1, 1.2f), 0.08f); }
TEST(Convergence, Torus) { expectSecondOrder(torus(1, 0.4f), 0.06f); }

}  // namespace
}  // namespace sgm::volume
