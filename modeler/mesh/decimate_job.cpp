#include "modeler/mesh/decimate_job.h"

#include <algorithm>

namespace sgm::mesh {
namespace {

/// Of the tolerance, in turn: what costs little goes first.
constexpr float steps[] = {0.1f, 0.33f, 1.0f};
constexpr int mostSweeps = 12;        ///< a step
constexpr int mostTargets = 3;        ///< neighbours that a vertex is tried to move into
constexpr float worthASweep = 0.01f;  ///< share of the vertices that the last sweep removed
constexpr float bent = 0.5f;          ///< least cosine between a star's normal and its triangles'
constexpr float even = 0.8f;          ///< the same of triangles that come, where those that go have it too
constexpr float sliver = 1e-3f;       ///< doubled area by squared length below which a normal is rounding

}  // namespace

DecimatedPatch DecimationJob::run(std::span<const uint32_t> triangles, const Progress* progress) {
    patch_.load(triangles);
    unlinked_.clear(), stamp_ = 0;
    for (const float step : steps) {
        const float tolerance = step * static_cast<float>(all_.limits.surface_m);
        for (size_t v = 0; v < patch_.vertexCount; ++v)
            patch_.vertices[v].dirty |= !patch_.isSettled(patch_.vertices[v].vertex);
        for (int i = 0; i < mostSweeps && !cancelled(progress); ++i)
            if (static_cast<float>(sweep(tolerance)) < worthASweep * static_cast<float>(patch_.vertexCount)) break;
    }
    DecimatedPatch stored = patch_.store();
    stored.unlinked = unlinked_;
    return stored;
}

/// Collapses where no other collapse of this sweep has changed the star; the number of collapses.
size_t DecimationJob::sweep(float tolerance) {
    ++sweep_;
    size_t collapses = 0;
    for (uint32_t v = 0; v < patch_.vertexCount; ++v) {
        PatchVertex& local = patch_.vertices[v];
        if (!local.dirty || local.touched == sweep_ || !isFree(v)) continue;
        local.dirty = false;
        collapses += tryCollapse(v, tolerance);
    }
    return collapses;
}

bool DecimationJob::isFree(uint32_t v) const {
    const PatchVertex& local = patch_.vertices[v];
    return local.whole && local.kind != Kind::Node && local.half != none && !all_.kept[local.vertex];
}

/// False where too many triangles meet.
bool DecimationJob::gatherStar(uint32_t u) {
    star_.ring.clear(), star_.halves.clear();
    uint32_t first = patch_.vertices[u].half;
    const auto walk = [&] {
        for (uint32_t h = first;;) {
            if (star_.halves.size() == mostAround - 1) return none;
            star_.halves.push_back(h), star_.ring.push_back(patch_.to(h));
            const uint32_t last = LoadedPatch::behind(h), next = patch_.opposite[last];
            if (next == first) return first;
            if (next == none) {
                star_.ring.push_back(patch_.from(last));
                return last;
            }
            h = next;
        }
    };
    uint32_t end = walk();
    if (end == none) return false;
    star_.closed = end == first;
    if (star_.closed || patch_.opposite[first] == none) return true;
    while (patch_.opposite[first] != none) first = LoadedPatch::ahead(patch_.opposite[first]);
    star_.ring.clear(), star_.halves.clear();
    return walk() != none;
}

/// The sides of a star; false where a side is a single triangle or the chain isn't on the ring.
bool DecimationJob::splitAtChain(uint32_t u) {
    star_.sideCount = 1;
    star_.sides[0].from = 0, star_.sides[0].to = star_.closed ? star_.halves.size() : star_.ring.size() - 1;
    if (patch_.vertices[u].kind == Kind::Inner) return star_.closed && star_.halves.size() >= 3;
    if (!star_.closed) return star_.sides[0].to >= 2;
    const std::vector<uint32_t>& vertices = all_.input.chains.vertices;
    const uint32_t place = patch_.chainPlace(u), next = vertices[all_.next[place]],
                   previous = vertices[all_.previous[place]];
    const auto find = [&](uint32_t vertex) {
        return std::find_if(star_.ring.begin(), star_.ring.end(),
                            [&](uint32_t r) { return patch_.vertices[r].vertex == vertex; }) -
               star_.ring.begin();
    };
    const auto shift = find(next);
    if (static_cast<size_t>(shift) == star_.ring.size()) return false;
    std::rotate(star_.ring.begin(), star_.ring.begin() + shift, star_.ring.end());
    std::rotate(star_.halves.begin(), star_.halves.begin() + shift, star_.halves.end());
    const auto middle = static_cast<size_t>(find(previous));
    if (middle == star_.ring.size() || middle < 2 || star_.ring.size() - middle < 2) return false;
    star_.sideCount = 2;
    star_.sides[0].to = star_.sides[1].from = middle;
    star_.sides[1].to = star_.ring.size();
    return true;
}

/// The mean normals of the sides and the quadric of the star's planes; false where a side is bent too much.
bool DecimationJob::findNormals() {
    std::array<Vec3f, mostAround> across;
    const auto position = [&](uint32_t v) { return patch_.vertices[v].position; };
    star_.quadric = {}, star_.area = 0;
    for (size_t s = 0; s < star_.sideCount; ++s) {
        Side& side = star_.sides[s];
        side.normal = {};
        for (size_t i = side.from; i < side.to; ++i) {
            const uint32_t h = star_.halves[i];
            const Vec3f p = position(patch_.from(h));
            across[i] = cross(position(patch_.to(h)) - p, position(patch_.from(LoadedPatch::behind(h))) - p);
            side.normal += across[i];
        }
        side.normal = normalized(side.normal);
        side.leastFacing = even;
        for (size_t i = side.from; i < side.to; ++i) {
            const Vec3f n = across[i];
            const float twice = length(n);
            if (dot(n, side.normal) < bent * twice) {
                const Vec3f edge = position(patch_.to(star_.halves[i])) - position(patch_.from(star_.halves[i]));
                if (twice > sliver * dot(edge, edge)) return false;
            }
            if (!(twice > 0)) continue;
            side.leastFacing = std::max(bent, std::min(side.leastFacing, dot(n, side.normal) / twice));
            const float w = 1 / twice;  // n n^T / |n|: the plane's quadric by its area
            star_.quadric[0] += n.x * n.x * w, star_.quadric[1] += n.y * n.y * w, star_.quadric[2] += n.z * n.z * w;
            star_.quadric[3] += n.x * n.y * w, star_.quadric[4] += n.y * n.z * w, star_.quadric[5] += n.z * n.x * w;
            star_.area += twice;
        }
    }
    return star_.area > 0;
}

/// Mean squared distance of the neighbour from the star's planes, and a little for its own distance.
float DecimationJob::cost(size_t target) const {
    const Vec3f d =
        patch_.vertices[star_.ring[target]].position - patch_.vertices[patch_.from(star_.halves[0])].position;
    const auto& q = star_.quadric;
    const float planes = d.x * d.x * q[0] + d.y * d.y * q[1] + d.z * d.z * q[2] +
                         2 * (d.x * d.y * q[3] + d.y * d.z * q[4] + d.z * d.x * q[5]);
    return planes / star_.area + 1e-5f * dot(d, d);
}

bool DecimationJob::tryCollapse(uint32_t u, float tolerance) {
    if (!gatherStar(u) || !splitAtChain(u) || !findNormals()) return false;
    std::array<std::pair<float, size_t>, mostAround + 1> targets;
    size_t count = 0;
    const float most = 9 * tolerance * tolerance;
    const auto add = [&](size_t target) {
        const float c = cost(target);
        const Vec3f d = patch_.vertices[star_.ring[target]].position - patch_.vertices[u].position;
        if (c <= most + 1e-5f * dot(d, d)) targets[count++] = {c, target};
    };
    if (patch_.vertices[u].kind == Kind::Inner) {
        for (size_t i = 0; i < star_.ring.size(); ++i) add(i);
    } else {
        if (!chainStays(u, tolerance)) return false;
        add(0), add(star_.sides[0].to);
    }
    if (count == 0) return false;
    gatherPoints();
    const size_t tried = std::min<size_t>(count, mostTargets);
    std::partial_sort(targets.begin(), targets.begin() + static_cast<ptrdiff_t>(tried),
                      targets.begin() + static_cast<ptrdiff_t>(count));
    for (size_t i = 0; i < tried; ++i)
        if (tryInto(u, targets[i].second, tolerance)) return true;
    return false;
}

bool DecimationJob::tryInto(uint32_t u, size_t target, float tolerance) {
    if (!keepsManifold(u, target)) return false;
    for (size_t side = 0; side < star_.sideCount; ++side)
        if (!fits(u, target, side, tolerance)) return false;
    collapse(u, target);
    return true;
}

/// Moves u into star_.ring[target]: two triangles go, the others turn about the target.
void DecimationJob::collapse(uint32_t u, size_t target) {
    const uint32_t v = star_.ring[target];
    if (patch_.vertices[u].kind == Kind::Chain) {
        unlinked_.push_back(patch_.chainPlace(u));
        all_.unlink(unlinked_.back());
    }
    for (const uint32_t h : star_.halves) patch_.triangles.firstPoint[h / 3] = none;
    if (patch_.vertices[u].kind == Kind::Inner) points_.push_back({u, 0, uOver_});
    for (const Point& p : points_) {
        uint32_t& first = patch_.triangles.firstPoint[star_.sides[p.side].triangles[p.over] / 3];
        patch_.vertices[p.local].next = first;
        first = p.local;
    }
    for (const uint32_t h : star_.halves)
        if (patch_.to(h) == v || patch_.from(LoadedPatch::behind(h)) == v) glue(h / 3, u, v);
    for (const uint32_t h : star_.halves) {
        if (patch_.triangles.dead[h / 3]) continue;
        patch_.corners[h] = v;
        patch_.vertices[v].half = h;
    }
    for (const uint32_t r : star_.ring)
        patch_.vertices[r].dirty = patch_.vertices[r].changed = true, patch_.vertices[r].touched = sweep_;
    patch_.vertices[u].half = none;
}

/// Joins what is on the two other sides of a triangle that holds u and v, and takes it away.
void DecimationJob::glue(uint32_t triangle, uint32_t u, uint32_t v) {
    uint32_t acrossU = none, acrossV = none, other = none;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        const uint32_t a = patch_.from(h), b = patch_.to(h);
        if (a != u && b != u) acrossV = patch_.opposite[h];
        if (a != v && b != v) acrossU = patch_.opposite[h];
        if (a != u && a != v) other = a;
    }
    if (acrossU != none) patch_.opposite[acrossU] = acrossV;
    if (acrossV != none) patch_.opposite[acrossV] = acrossU;
    patch_.triangles.dead[triangle] = true;
    if (patch_.vertices[other].half / 3 != triangle) return;
    for (const uint32_t h : {acrossU, acrossV})
        if (h != none) patch_.vertices[other].half = patch_.from(h) == other ? h : LoadedPatch::ahead(h);
}

}  // namespace sgm::mesh
