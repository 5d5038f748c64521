#include "modeler/mesh/proxy.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/edit.h"
#include "modeler/mesh/polygonize.h"

namespace sgm::mesh {
namespace {

constexpr double sqrt3 = 1.7320508;
constexpr int mostThinnings = 5;  ///< to two fifths each, so to a hundredth
using Corners = std::array<Vec3f, 3>;

Vec3f middle(const Corners& t) { return (t[0] + t[1] + t[2]) / 3.0f; }

/// The farthest a point of the triangle is from its middle.
float reach(const Corners& t) {
    const Vec3f m = middle(t);
    return std::max({length(t[0] - m), length(t[1] - m), length(t[2] - m)});
}

/// Appends the four triangles that `t` is cut into at its edges' midpoints.
void quarter(const Corners& t, std::vector<Corners>& out) {
    const Vec3f ab = (t[0] + t[1]) * 0.5f, bc = (t[1] + t[2]) * 0.5f, ca = (t[2] + t[0]) * 0.5f;
    out.insert(out.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
}

std::vector<Corners> trianglesOf(const Mesh& mesh) {
    std::vector<Vec3f> points;
    std::vector<Corners> triangles;
    for (const Chunk& c : mesh.chunks) points.insert(points.end(), c.positions.begin(), c.positions.end());
    for (const Chunk& c : mesh.chunks)
        for (const Triangle& local : c.triangles) {
            const Triangle t = c.inMesh(local);
            triangles.push_back({points[t.x], points[t.y], points[t.z]});
        }
    return triangles;
}

/// The field at the triangles' middles.
std::vector<float> valuesAt(const std::vector<Corners>& triangles, const eval::Tape& tape, eval::Workspace& workspace) {
    std::vector<float> x, y, z, values(triangles.size());
    for (const Corners& t : triangles) {
        const Vec3f m = middle(t);
        x.push_back(m.x), y.push_back(m.y), z.push_back(m.z);
    }
    eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    return values;
}

Result<Mesh> polygonized(const eval::Tape& tape, const Box3f& bounds, double cell_m, int threads, Progress* progress) {
    Counts counts;
    const Grid grid = gridFor(bounds, static_cast<float>(cell_m));
    const auto blocks = subdivide(tape, grid, threads, progress, counts);
    if (!blocks.ok()) return blocks.error();
    return polygonize(*blocks, grid, {.threads = threads}, progress, counts);
}

}  // namespace

bool encloses(const Mesh& mesh, const eval::Tape& tape) {
    constexpr int mostCuts = 7;
    eval::Workspace workspace;
    std::vector<Corners> open = trianglesOf(mesh);
    for (int cut = 0; !open.empty(); ++cut) {
        const std::vector<float> values = valuesAt(open, tape, workspace);
        std::vector<Corners> next;
        for (size_t i = 0; i < open.size(); ++i) {
            if (!(values[i] > 0)) return false;
            if (values[i] <= tape.lipschitz() * reach(open[i]) * 1.0001f) quarter(open[i], next);
        }
        if (cut == mostCuts && !next.empty()) return false;
        open.swap(next);
    }
    return true;
}

Result<Mesh> proxy(field::Graph& graph, const field::Field& field, double tolerance_m, int threads,
                   Progress* progress) {
    if (!(tolerance_m > 0)) return Error{Error::Kind::Usage, "a proxy's tolerance is a positive length"};
    if (!(field.lipschitz > 0) || !std::isfinite(field.lipschitz) || !(field.growth > 0))
        return Error{Error::Kind::Input,
                     "no proxy: the field has no distance bound (a fractal with a jump or a bailout?)"};
    const double cell_m = tolerance_m / (2 * sqrt3);
    const auto level_m = static_cast<float>(sqrt3 * cell_m * static_cast<double>(field.lipschitz) * 1.0001);
    field::Field swollen = field;
    swollen.value = field.value - level_m;
    swollen.bounds = field.bounds.inflated(level_m / field.growth);
    const auto constants = graph.constants();
    const eval::Tape tape = eval::compile(graph, field, constants);
    auto fine = polygonized(eval::compile(graph, swollen, constants), swollen.bounds, cell_m, threads, progress);
    if (!fine.ok()) return fine;
    Result<Mesh> kept = std::move(fine);
    for (int step = 0; step < mostThinnings; ++step) {
        auto thinner = decimate(*kept, 0.4, progress);
        if (!thinner.ok()) return thinner;
        if (!encloses(*thinner, tape)) break;
        kept = std::move(thinner);
    }
    return kept;
}

}  // namespace sgm::mesh
