#include "modeler/mesh/decimate.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/parallel.h"
#include "modeler/core/random.h"
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
    std::vector<uint32_t> triangles, begin, cubes;
    size_t count() const { return cubes.size(); }
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

/// Cubes of `side` metres about a box, shifted by a share of it.
PatchLattice latticeOf(const Box3f& box, double side, double shift) {
    PatchLattice lattice;
    const double longest = static_cast<double>(maxComponent(box.size()));
    lattice.side_m = std::max(side, longest / 500);  // so that there are few cubes
    lattice.low = box.lo.as<double>() - Vec3d{1, 1, 1} * (lattice.side_m * (1 + shift));
    for (int axis = 0; axis < 3; ++axis)
        lattice.size[axis] =
            static_cast<uint32_t>((static_cast<double>(box.hi[axis]) - lattice.low[axis]) / lattice.side_m) + 2;
    return lattice;
}

Patches cluster(const Decimation& d, const PatchLattice& lattice) {
    Patches patches;
    std::vector<uint32_t> ends(lattice.cubes() + 1), cubes(d.triangles.size());
    for (size_t i = 0; i < cubes.size(); ++i) {
        cubes[i] = lattice.cubeOf(d.input.mesh.positions[d.triangles[i].corners.x]);
        ++ends[cubes[i] + 1];
    }
    patches.begin.push_back(0);
    for (uint32_t cube = 0; cube + 1 < ends.size(); ++cube) {
        const uint32_t count = ends[cube + 1];
        ends[cube + 1] += ends[cube];
        if (count == 0) continue;
        patches.cubes.push_back(cube);
        patches.begin.push_back(ends[cube + 1]);
    }
    patches.triangles.resize(cubes.size());
    for (uint32_t i = 0; i < cubes.size(); ++i) patches.triangles[ends[cubes[i]]++] = i;
    return patches;
}

/// What tells a triangle of a result with its points from another, as a rule.
uint64_t fingerprint(const DecimatedPatch& patch, size_t triangle) {
    const SimpleTriangle& t = patch.triangles[triangle];
    uint64_t h = t.region;
    for (int i = 0; i < 3; ++i) h = combine(h, t.corners[i]);
    for (uint32_t i = triangle == 0 ? 0 : patch.pointsEnd[triangle - 1]; i < patch.pointsEnd[triangle]; ++i)
        h = combine(h, patch.points[i]);
    return h;
}

std::vector<uint64_t> fingerprints(const DecimatedPatch& patch) {
    std::vector<uint64_t> all(patch.triangles.size());
    for (size_t t = 0; t < all.size(); ++t) all[t] = fingerprint(patch, t);
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace

uint32_t PatchLattice::cubeOf(Vec3f p) const {
    const Vec3d at = (p.as<double>() - low) / side_m;
    const auto along = [&](int axis) {
        return static_cast<uint32_t>(std::clamp(at[axis], 0.0, static_cast<double>(size[axis] - 1)));
    };
    return (along(2) * size.y + along(1)) * size.x + along(0);
}

Decimation::Decimation(const DecimationInput& in, const DecimationLimits& within) : input(in), limits(within) {
    const size_t vertices = input.mesh.positions.size();
    neighbours.begin.resize(vertices + 1);
    std::fill(neighbours.begin.begin(), neighbours.begin.end(), 0);
    for (uint32_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const uint32_t region = input.regions.ofTriangle[t];
        if (input.planes[region].planar()) continue;
        for (int i = 0; i < 3; ++i) ++neighbours.begin[input.mesh.triangles[t][i] + 1];
    }
    for (size_t v = 1; v <= vertices; ++v) neighbours.begin[v] += neighbours.begin[v - 1];
    neighbours.list.resize(neighbours.begin[vertices]);
    reset();
    PageVector<uint32_t> fill(neighbours.begin.begin(), neighbours.begin.end() - 1);
    for (const SimpleTriangle& t : triangles)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = t.corners[i], b = t.corners[(i + 1) % 3];
            const Vec3f edge = input.mesh.positions[b] - input.mesh.positions[a];
            longestEdge_m = std::max(longestEdge_m, dot(edge, edge));  // squared for now
            neighbours.list[fill[a]++] = b;
        }
    longestEdge_m = 1.0001f * std::sqrt(longestEdge_m);
    for (PageVector<uint8_t>* const flags : {&kept, &settled, &changed_}) {
        flags->resize(vertices);
        std::fill(flags->begin(), flags->end(), uint8_t{0});
    }

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
    triangles.reserve(neighbours.list.size() / 3);
    for (uint32_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const uint32_t region = input.regions.ofTriangle[t];
        if (!input.planes[region].planar()) triangles.push_back({input.mesh.triangles[t], region});
    }
    pointsEnd.assign(triangles.size(), 0);
    points.clear();
    previous.resize(input.chains.vertices.size()), next.resize(input.chains.vertices.size());
    for (const Chain& c : input.chains.chains) {
        for (uint32_t i = c.begin; i < c.end; ++i) previous[i] = i - 1, next[i] = i + 1;
        previous[c.begin] = c.closed ? c.end - 1 : none;
        next[c.end - 1] = c.closed ? c.begin : none;
    }
}

bool Decimation::keepAround(uint32_t triangle) {
    bool fresh = false;
    for (const uint32_t p : pointsOver(triangle)) fresh |= keep(p);
    for (int i = 0; i < 3; ++i) {
        const uint32_t v = triangles[triangle].corners[i];
        fresh |= keep(v);
        for (uint32_t n = neighbours.begin[v]; n < neighbours.begin[v + 1]; ++n) fresh |= keep(neighbours.list[n]);
    }
    return fresh;
}

bool Decimation::keepChain(const Chain& chain) {
    bool fresh = false;
    for (uint32_t i = chain.begin; i < chain.end; ++i) fresh |= keep(input.chains.vertices[i]);
    return fresh;
}

bool Decimation::keep(uint32_t vertex) {
    if (std::exchange(kept[vertex], uint8_t{1})) return false;
    mark(vertex, 0);
    return true;
}

/// Notes that the surface around a vertex differs from that of the last run once so many passes are through.
void Decimation::mark(uint32_t vertex, size_t passes) {
    if (std::exchange(changed_[vertex], uint8_t{1})) return;
    if (settled[vertex] > passes) settled[vertex] = 0;
}

void Decimation::run(int threads, Progress* progress) {
    reset();
    if (triangles.empty()) return;
    const bool again = !passes_.empty();
    size_t before = 0;
    double side = 0;
    Box3f box;
    for (const SimpleTriangle& t : triangles) box = hull(box, input.mesh.positions[t.corners.x]);
    for (size_t pass = 0; pass < (again ? passes_.size() : 2 * mostRounds); ++pass) {
        if (!again) {
            if (pass % 2 == 0) {
                if (pass > 0 && static_cast<double>(triangles.size()) > worthARound * static_cast<double>(before))
                    break;
                before = triangles.size();
                side = sideOfPatch(*this);
            }
            passes_.push_back({latticeOf(box, side, pass % 2 == 0 ? 0 : 0.5), {}});
        }
        runPass(pass, threads, progress);
        if (cancelled(progress)) return;
    }
    std::fill(changed_.begin(), changed_.end(), uint8_t{0});
}

bool Decimation::isChanged(std::span<const uint32_t> patch) const {
    return std::any_of(patch.begin(), patch.end(), [&](uint32_t t) {
        const Triangle& c = triangles[t].corners;
        return (changed_[c.x] | changed_[c.y] | changed_[c.z]) != 0;
    });
}

/// Notes the vertices of triangles that only one of two results has.
void Decimation::markDifference(const DecimatedPatch& before, const DecimatedPatch& after, size_t pass) {
    const auto markOthers = [&](const DecimatedPatch& of, const std::vector<uint64_t>& known) {
        for (size_t t = 0; t < of.triangles.size(); ++t) {
            if (std::binary_search(known.begin(), known.end(), fingerprint(of, t))) continue;
            for (int i = 0; i < 3; ++i) mark(of.triangles[t].corners[i], pass + 1);
        }
    };
    markOthers(before, fingerprints(after));
    markOthers(after, fingerprints(before));
}

void Decimation::append(const DecimatedPatch& patch) {
    const auto first = static_cast<uint32_t>(points.size());
    triangles.insert(triangles.end(), patch.triangles.begin(), patch.triangles.end());
    points.insert(points.end(), patch.points.begin(), patch.points.end());
    for (const uint32_t end : patch.pointsEnd) pointsEnd.push_back(first + end);
}

/// A patch whose triangles and kept vertices are those of the last run has the same result.
void Decimation::runPass(size_t number, int threads, Progress* progress) {
    DecimationPass& pass = passes_[number];
    const Patches patches = cluster(*this, pass.lattice);
    std::vector<DecimatedPatch> done(patches.count()), known;
    known.swap(pass.patches);
    const bool again = !known.empty();
    std::vector<size_t> open;
    std::vector<const DecimatedPatch*> before(patches.count());  // of those that are open
    const DecimatedPatch nothing;
    auto old = known.begin();
    for (size_t i = 0; i < patches.count(); ++i) {
        for (; old != known.end() && old->cube < patches.cubes[i]; ++old) markDifference(*old, nothing, number);
        before[i] = &nothing;
        if (old != known.end() && old->cube == patches.cubes[i]) {
            if (old->before == patches[i].size() && !isChanged(patches[i])) {
                for (const uint32_t place : old->unlinked) unlink(place);
                tick(progress, patches[i].size());
                done[i] = std::move(*old++);
                continue;
            }
            before[i] = &*old++;
        }
        open.push_back(i);
    }
    for (; old != known.end(); ++old) markDifference(*old, nothing, number);

    PageVector<uint32_t> incident(input.mesh.positions.size());
    std::fill(incident.begin(), incident.end(), 0);
    for (const SimpleTriangle& t : triangles)
        for (int i = 0; i < 3; ++i) ++incident[t.corners[i]];
    std::vector<DecimationJob> jobs(static_cast<size_t>(threadCount(threads)), DecimationJob(*this, incident, number));
    parallelFor(open.size(), threads, progress, [&](size_t i, int worker) {
        DecimatedPatch& patch = done[open[i]];
        patch = jobs[static_cast<size_t>(worker)].run(patches[open[i]], progress);
        patch.cube = patches.cubes[open[i]], patch.before = static_cast<uint32_t>(patches[open[i]].size());
        tick(progress, patches[open[i]].size());
    });
    if (cancelled(progress)) return;
    if (again)
        for (const size_t i : open) markDifference(*before[i], done[i], number);
    triangles.clear(), points.clear(), pointsEnd.clear();
    for (const DecimatedPatch& patch : done) append(patch);
    pass.patches = std::move(done);
}

}  // namespace sgm::mesh
