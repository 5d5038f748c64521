#include "modeler/mesh/planes.h"

#include "modeler/core/parallel.h"

namespace sgm::mesh {
namespace {

/// Vertices that are worth a step of a parallel loop.
constexpr size_t verticesPerStep = 1 << 14;

struct Extent {
    double low = Box3d::limit(), high = -Box3d::limit();
    void add(double x) { low = std::min(low, x), high = std::max(high, x); }
};

}  // namespace

std::vector<Plane> findPlanes(const FlatMesh& mesh, const SurfaceRegions& regions, double bound_m, int threads) {
    const auto position = [&](uint32_t v) { return mesh.positions[v].as<double>(); };
    std::vector<Plane> planes(regions.count());
    std::vector<Vec3d> reference(regions.count());  // near the region, so that products of positions don't cancel
    std::vector<bool> seen(regions.count());
    const auto addSide = [&](uint32_t region, uint32_t a, uint32_t b) {
        if (!seen[region]) seen[region] = true, reference[region] = position(a);
        planes[region].normal += cross(position(a) - reference[region], position(b) - reference[region]);
    };
    for (const BorderEdge& e : regions.borders) addSide(e.left, e.a, e.b), addSide(e.right, e.b, e.a);
    for (Plane& p : planes) p.normal = normalized(p.normal);

    std::vector<Extent> extents(regions.count());
    for (const BorderEdge& e : regions.borders)
        for (const uint32_t region : {e.left, e.right})
            for (const uint32_t v : {e.a, e.b}) extents[region].add(dot(planes[region].normal, position(v)));
    for (size_t i = 0; i < planes.size(); ++i) {
        planes[i].offset = (extents[i].low + extents[i].high) / 2;
        if (!(extents[i].high - extents[i].low <= 2 * bound_m)) planes[i].normal = {};
    }

    std::vector<std::atomic<bool>> curved(planes.size());
    const size_t steps = (mesh.positions.size() + verticesPerStep - 1) / verticesPerStep;
    parallelFor(steps, threads, nullptr, [&](size_t step, int) {
        const size_t end = std::min(mesh.positions.size(), (step + 1) * verticesPerStep);
        for (size_t v = step * verticesPerStep; v < end; ++v) {
            const uint32_t region = regions.ofVertex[v];
            if (SurfaceRegions::isBorder(region)) continue;
            const Plane& p = planes[region];
            if (!(std::abs(p.distance(mesh.positions[v])) <= bound_m) && p.planar())
                curved[region].store(true, std::memory_order_relaxed);
        }
    });
    for (size_t i = 0; i < planes.size(); ++i)
        if (curved[i]) planes[i] = {};
    return planes;
}

}  // namespace sgm::mesh
