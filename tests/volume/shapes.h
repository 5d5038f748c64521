// Solids whose volumes are known, for tests.
#pragma once

#include "modeler/core/conventions.h"
#include "modeler/field/field.h"
#include "modeler/volume/volume.h"

namespace sgm::volume {

/// A solid, its graph and its volume in m³.
struct KnownSolid {
    std::unique_ptr<field::Graph> graph = std::make_unique<field::Graph>();
    field::Field field{};
    double volume_m3 = 0;

    eval::Tape tape() const { return eval::compile(*graph, field, graph->constants()); }
};

inline field::NodeRef ball(field::Graph& g, Vec3f c, float radius) {
    return length(field::Point{g.x() - c.x, g.y() - c.y, g.z() - c.z}) - radius;
}

/// Off the grid's lattice, so that no symmetry flatters the figures.
constexpr Vec3f somewhere{0.13f, -0.21f, 0.07f};

inline KnownSolid oneBall(float r) {
    KnownSolid s;
    s.field.value = ball(*s.graph, somewhere, r);
    s.field.bounds = {somewhere - Vec3f{r, r, r}, somewhere + Vec3f{r, r, r}};
    s.volume_m3 = 4 * pi / 3 * std::pow(r, 3);
    return s;
}

/// Two balls of radius r whose centres are d < 2r apart: both, less the lens they share.
inline KnownSolid twoBalls(float r, float d) {
    KnownSolid s;
    const Vec3f other = somewhere + Vec3f{0.6f, 0.48f, 0.64f} * d;
    s.field.value = min(ball(*s.graph, somewhere, r), ball(*s.graph, other, r));
    s.field.bounds = {somewhere - Vec3f{r, r, r}, other + Vec3f{r, r, r}};
    const double R = r, D = d;
    s.volume_m3 = 8 * pi / 3 * R * R * R - pi * (4 * R + D) * (2 * R - D) * (2 * R - D) / 12;
    return s;
}

inline KnownSolid torus(float ring, float tube) {
    KnownSolid s;
    field::Graph& g = *s.graph;
    const field::NodeRef x = g.x() - somewhere.x, y = g.y() - somewhere.y, z = g.z() - somewhere.z;
    const field::NodeRef across = sqrt(x * x + z * z) - ring;
    s.field.value = sqrt(across * across + y * y) - tube;
    const Vec3f half{ring + tube, tube, ring + tube};
    s.field.bounds = {somewhere - half, somewhere + half};
    s.volume_m3 = 2 * pi * pi * ring * tube * tube;
    return s;
}

/// The level set of a solid on voxels of `voxel_m`.
inline Result<Volume> levelSetOf(const KnownSolid& solid, float voxel_m, int halfWidth = 3) {
    const eval::Tape tape = solid.tape();
    const mesh::Grid grid = mesh::gridFor(solid.field.bounds, voxel_m);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    if (!blocks.ok()) return blocks.error();
    return sample(*blocks, tape, grid, halfWidth, 2, nullptr);
}

}  // namespace sgm::volume
