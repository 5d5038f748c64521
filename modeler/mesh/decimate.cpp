#include "modeler/mesh/decimate.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/mesh/decimate_job.h"

namespace sgm::mesh {
namespace {

/// Triangles that a patch has about.
constexpr double patchTriangles = 8000;
/// Rounds go on while one leaves less than this share: borders of patches are much of what is left then.
constexpr double worthARound = 0.3;
constexpr int mostRounds = 6;

/// Triangles by cubes of space.
struct Patches {
    std::vector<uint32_t> triangles, begin;
    size_t count() const { return begin.size() - 1; }
    std::span<const uint32_t> operator[](size_t i) const {
        return {triangles.data() + begin[i], triangles.data() + begin[i + 1]};
    }
};

double sideOfPatch(const Decimation& d) {
    double area = 0;
    for (const SimpleTriangle& t : d.triangles) {
        const Vec3f p = d.input.mesh.positions[t.corners.x];
        area += static_cast<double>(
            length(cross(d.input.mesh.positions[t.corners.y] - p, d.input.mesh.positions[t.corners.z] - p)));
    }
    return std::sqrt(area / 2 * patchTriangles / (1.5 * static_cast<double>(d.triangles.size())));
}

/// Cubes of `side` metres whose lattice is shifted by a share of it.
Patches cluster(const Decimation& d, double side, double shift) {
    Box3f box;
    const auto position = [&](uint32_t v) { return d.input.mesh.positions[v]; };
    for (const SimpleTriangle& t : d.triangles) box = hull(box, position(t.corners.x));
    const double longest = static_cast<double>(maxComponent(box.size()));
    side = std::max(side, longest / 500);  // so that there are few cubes
    const Vec3d low = box.lo.as<double>() - Vec3d{1, 1, 1} * (side * (1 + shift));
    const auto along = [&](int axis) {
        return static_cast<uint32_t>((static_cast<double>(box.hi[axis]) - low[axis]) / side) + 2;
    };
    const uint32_t nx = along(0), ny = along(1);
    Patches patches;
    patches.begin.assign(static_cast<size_t>(nx) * ny * along(2) + 1, 0);
    std::vector<uint32_t> cubes(d.triangles.size());
    for (size_t i = 0; i < cubes.size(); ++i) {
        const Vec3d at = (position(d.triangles[i].corners.x).as<double>() - low) / side;
        cubes[i] = (static_cast<uint32_t>(at.z) * ny + static_cast<uint32_t>(at.y)) * nx + static_cast<uint32_t>(at.x);
        ++patches.begin[cubes[i] + 1];
    }
    for (size_t i = 1; i < patches.begin.size(); ++i) patches.begin[i] += patches.begin[i - 1];
    std::vector<uint32_t> next(patches.begin.begin(), patches.begin.end() - 1);
    patches.triangles.resize(cubes.size());
    for (uint32_t i = 0; i < cubes.size(); ++i) patches.triangles[next[cubes[i]]++] = i;
    patches.begin.erase(std::unique(patches.begin.begin(), patches.begin.end()), patches.begin.end());
    return patches;
}

void decimatePatches(Decimation& d, const Patches& patches, std::span<uint8_t> settled, bool original, int threads,
                     Progress* progress) {
    PageVector<uint32_t> incident(d.input.mesh.positions.size());
    std::fill(incident.begin(), incident.end(), 0);
    for (const SimpleTriangle& t : d.triangles)
        for (int i = 0; i < 3; ++i) ++incident[t.corners[i]];
    std::vector<DecimationJob> jobs(static_cast<size_t>(threadCount(threads)),
                                    DecimationJob(d, incident, settled, original));
    std::vector<DecimatedPatch> done(patches.count());
    parallelFor(patches.count(), threads, progress, [&](size_t i, int worker) {
        done[i] = jobs[static_cast<size_t>(worker)].run(patches[i], progress);
        tick(progress, patches[i].size());
    });
    if (cancelled(progress)) return;
    d.triangles.clear(), d.firstPoint.clear();
    for (const DecimatedPatch& p : done) {
        d.triangles.insert(d.triangles.end(), p.triangles.begin(), p.triangles.end());
        d.firstPoint.insert(d.firstPoint.end(), p.firstPoint.begin(), p.firstPoint.end());
    }
}

}  // namespace

Decimation::Decimation(const DecimationInput& in, const DecimationLimits& within) : input(in), limits(within) {
    const size_t vertices = input.mesh.positions.size();
    neighboursBegin.resize(vertices + 1);
    std::fill(neighboursBegin.begin(), neighboursBegin.end(), 0);
    for (uint32_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const uint32_t region = input.regions.ofTriangle[t];
        if (input.planes[region].planar()) continue;
        for (int i = 0; i < 3; ++i) ++neighboursBegin[input.mesh.triangles[t][i] + 1];
    }
    for (size_t v = 1; v <= vertices; ++v) neighboursBegin[v] += neighboursBegin[v - 1];
    neighbours.resize(neighboursBegin[vertices]);
    reset();
    PageVector<uint32_t> fill(neighboursBegin.begin(), neighboursBegin.end() - 1);
    for (const SimpleTriangle& t : triangles)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = t.corners[i], b = t.corners[(i + 1) % 3];
            const Vec3f edge = input.mesh.positions[b] - input.mesh.positions[a];
            longestEdge_m = std::max(longestEdge_m, dot(edge, edge));  // squared for now
            neighbours[fill[a]++] = b;
        }
    longestEdge_m = 1.0001f * std::sqrt(longestEdge_m);
    nextPoint.resize(vertices);
    kept.resize(vertices);
    std::fill(kept.begin(), kept.end(), uint8_t{0});

    for (const Chain& c : input.chains.chains) {
        if (c.closed) continue;
        for (const uint32_t node : {input.chains.vertices[c.begin], input.chains.vertices[c.end - 1]})
            for (const uint32_t region : {c.left, c.right})
                if (input.planes[region].planar()) planarAtNodes.push_back({node, region});
    }
    std::sort(planarAtNodes.begin(), planarAtNodes.end());
    planarAtNodes.erase(std::unique(planarAtNodes.begin(), planarAtNodes.end()), planarAtNodes.end());
}

void Decimation::reset() {
    triangles.clear();
    for (uint32_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const uint32_t region = input.regions.ofTriangle[t];
        if (!input.planes[region].planar()) triangles.push_back({input.mesh.triangles[t], region});
    }
    firstPoint.assign(triangles.size(), none);
    previous.resize(input.chains.vertices.size()), next.resize(input.chains.vertices.size());
    for (const Chain& c : input.chains.chains) {
        for (uint32_t i = c.begin; i < c.end; ++i) previous[i] = i - 1, next[i] = i + 1;
        previous[c.begin] = c.closed ? c.end - 1 : none;
        next[c.end - 1] = c.closed ? c.begin : none;
    }
}

bool Decimation::keepAround(uint32_t triangle) {
    bool fresh = false;
    for (uint32_t p = firstPoint[triangle]; p != none; p = nextPoint[p]) fresh |= keep(p);
    for (int i = 0; i < 3; ++i) {
        const uint32_t v = triangles[triangle].corners[i];
        fresh |= keep(v);
        for (uint32_t n = neighboursBegin[v]; n < neighboursBegin[v + 1]; ++n) fresh |= keep(neighbours[n]);
    }
    return fresh;
}

bool Decimation::keepChain(const Chain& chain) {
    bool fresh = false;
    for (uint32_t i = chain.begin; i < chain.end; ++i) fresh |= keep(input.chains.vertices[i]);
    return fresh;
}

void Decimation::run(int threads, Progress* progress) {
    reset();
    if (triangles.empty()) return;
    PageVector<uint8_t> settled(input.mesh.positions.size());
    std::fill(settled.begin(), settled.end(), uint8_t{0});
    for (int round = 0; round < mostRounds; ++round) {
        const size_t before = triangles.size();
        const double side = sideOfPatch(*this);
        for (const double shift : {0.0, 0.5}) {
            decimatePatches(*this, cluster(*this, side, shift), settled, round == 0 && shift == 0, threads, progress);
            if (cancelled(progress)) return;
        }
        if (static_cast<double>(triangles.size()) > worthARound * static_cast<double>(before)) break;
    }
}

}  // namespace sgm::mesh
