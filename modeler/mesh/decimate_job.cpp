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
constexpr float sliver = 1e-3f;       ///< doubled area by squared length below which a normal is rounding

}  // namespace

DecimatedPatch DecimationJob::run(std::span<const uint32_t> triangles, const Progress* progress) {
    load(triangles);
    for (const float step : steps) {
        const float tolerance = step * static_cast<float>(all_.limits.surface_m);
        for (size_t v = 0; v < vertexCount_; ++v) locals_[v].dirty |= !isSettled(locals_[v].vertex);
        for (int i = 0; i < mostSweeps && !cancelled(progress); ++i)
            if (static_cast<float>(sweep(tolerance)) < worthASweep * static_cast<float>(vertexCount_)) break;
    }
    return store();
}

/// Collapses where no other collapse of this sweep has changed the star; the number of collapses.
size_t DecimationJob::sweep(float tolerance) {
    ++sweep_;
    size_t collapses = 0;
    for (uint32_t v = 0; v < vertexCount_; ++v) {
        Local& local = locals_[v];
        if (!local.dirty || local.touched == sweep_ || !isFree(v)) continue;
        local.dirty = false;
        collapses += tryCollapse(v, tolerance);
    }
    return collapses;
}

bool DecimationJob::isFree(uint32_t v) const {
    const Local& local = locals_[v];
    return local.whole && local.kind != Kind::Node && local.half != none && !all_.kept[local.vertex];
}

/// False where too many triangles meet.
bool DecimationJob::gatherStar(uint32_t u) {
    ring_.clear(), star_.clear();
    uint32_t first = locals_[u].half;
    const auto walk = [&] {
        for (uint32_t h = first;;) {
            if (star_.size() == mostAround - 1) return none;
            star_.push_back(h), ring_.push_back(to(h));
            const uint32_t last = behind(h), next = opposite_[last];
            if (next == first) return first;
            if (next == none) {
                ring_.push_back(from(last));
                return last;
            }
            h = next;
        }
    };
    uint32_t end = walk();
    if (end == none) return false;
    closed_ = end == first;
    if (closed_ || opposite_[first] == none) return true;
    while (opposite_[first] != none) first = ahead(opposite_[first]);
    ring_.clear(), star_.clear();
    return walk() != none;
}

/// The sides of a star; false where a side is a single triangle or the chain isn't on the ring.
bool DecimationJob::splitAtChain(uint32_t u) {
    sideCount_ = 1;
    sides_[0].from = 0, sides_[0].to = closed_ ? star_.size() : ring_.size() - 1;
    if (locals_[u].kind == Kind::Inner) return closed_ && star_.size() >= 3;
    if (!closed_) return sides_[0].to >= 2;
    const std::vector<uint32_t>& vertices = all_.input.chains.vertices;
    const uint32_t place = chainPlace(u), next = vertices[all_.next[place]], previous = vertices[all_.previous[place]];
    const auto find = [&](uint32_t vertex) {
        return std::find_if(ring_.begin(), ring_.end(), [&](uint32_t r) { return locals_[r].vertex == vertex; }) -
               ring_.begin();
    };
    const auto shift = find(next);
    if (static_cast<size_t>(shift) == ring_.size()) return false;
    std::rotate(ring_.begin(), ring_.begin() + shift, ring_.end());
    std::rotate(star_.begin(), star_.begin() + shift, star_.end());
    const auto middle = static_cast<size_t>(find(previous));
    if (middle == ring_.size() || middle < 2 || ring_.size() - middle < 2) return false;
    sideCount_ = 2;
    sides_[0].to = sides_[1].from = middle;
    sides_[1].to = ring_.size();
    return true;
}

/// The mean normals of the sides and the quadric of the star's planes; false where a side is bent too much.
bool DecimationJob::findNormals() {
    std::array<Vec3f, mostAround> across;
    const auto position = [&](uint32_t v) { return locals_[v].position; };
    quadric_ = {}, area_ = 0;
    for (size_t s = 0; s < sideCount_; ++s) {
        Side& side = sides_[s];
        side.normal = {};
        for (size_t i = side.from; i < side.to; ++i) {
            const uint32_t h = star_[i];
            const Vec3f p = position(from(h));
            across[i] = cross(position(to(h)) - p, position(from(behind(h))) - p);
            side.normal += across[i];
        }
        side.normal = normalized(side.normal);
        for (size_t i = side.from; i < side.to; ++i) {
            const Vec3f n = across[i];
            const float twice = length(n);
            if (dot(n, side.normal) < bent * twice) {
                const Vec3f edge = position(to(star_[i])) - position(from(star_[i]));
                if (twice > sliver * dot(edge, edge)) return false;
            }
            if (!(twice > 0)) continue;
            const float w = 1 / twice;  // n n^T / |n|: the plane's quadric by its area
            quadric_[0] += n.x * n.x * w, quadric_[1] += n.y * n.y * w, quadric_[2] += n.z * n.z * w;
            quadric_[3] += n.x * n.y * w, quadric_[4] += n.y * n.z * w, quadric_[5] += n.z * n.x * w;
            area_ += twice;
        }
    }
    return area_ > 0;
}

/// Mean squared distance of the neighbour from the star's planes, and a little for its own distance.
float DecimationJob::cost(size_t target) const {
    const Vec3f d = locals_[ring_[target]].position - locals_[from(star_[0])].position;
    const auto& q = quadric_;
    const float planes = d.x * d.x * q[0] + d.y * d.y * q[1] + d.z * d.z * q[2] +
                         2 * (d.x * d.y * q[3] + d.y * d.z * q[4] + d.z * d.x * q[5]);
    return planes / area_ + 1e-5f * dot(d, d);
}

bool DecimationJob::tryCollapse(uint32_t u, float tolerance) {
    if (!gatherStar(u) || !splitAtChain(u) || !findNormals()) return false;
    std::array<std::pair<float, size_t>, mostAround + 1> targets;
    size_t count = 0;
    const float most = 9 * tolerance * tolerance;
    const auto add = [&](size_t target) {
        const float c = cost(target);
        const Vec3f d = locals_[ring_[target]].position - locals_[u].position;
        if (c <= most + 1e-5f * dot(d, d)) targets[count++] = {c, target};
    };
    if (locals_[u].kind == Kind::Inner) {
        for (size_t i = 0; i < ring_.size(); ++i) add(i);
    } else {
        if (!chainStays(u, tolerance)) return false;
        add(0), add(sides_[0].to);
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
    for (size_t side = 0; side < sideCount_; ++side)
        if (!fits(u, target, side, tolerance)) return false;
    collapse(u, target);
    return true;
}

/// Moves u into ring_[target]: two triangles go, the others turn about the target.
void DecimationJob::collapse(uint32_t u, size_t target) {
    const uint32_t v = ring_[target];
    if (locals_[u].kind == Kind::Chain) {
        unlinked_.push_back(chainPlace(u));
        all_.unlink(unlinked_.back());
    }
    for (const uint32_t h : star_) firstPoint_[h / 3] = none;
    if (locals_[u].kind == Kind::Inner) points_.push_back({u, 0, uOver_});
    for (const Point& p : points_) {
        uint32_t& first = firstPoint_[sides_[p.side].triangles[p.over] / 3];
        locals_[p.local].next = first;
        first = p.local;
    }
    for (const uint32_t h : star_)
        if (to(h) == v || from(behind(h)) == v) glue(h / 3, u, v);
    for (const uint32_t h : star_) {
        if (dead_[h / 3]) continue;
        corners_[h] = v;
        locals_[v].half = h;
    }
    for (const uint32_t r : ring_) locals_[r].dirty = locals_[r].changed = true, locals_[r].touched = sweep_;
    locals_[u].half = none;
}

/// Joins what is on the two other sides of a triangle that holds u and v, and takes it away.
void DecimationJob::glue(uint32_t triangle, uint32_t u, uint32_t v) {
    uint32_t acrossU = none, acrossV = none, other = none;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        const uint32_t a = from(h), b = to(h);
        if (a != u && b != u) acrossV = opposite_[h];
        if (a != v && b != v) acrossU = opposite_[h];
        if (a != u && a != v) other = a;
    }
    if (acrossU != none) opposite_[acrossU] = acrossV;
    if (acrossV != none) opposite_[acrossV] = acrossU;
    dead_[triangle] = true;
    if (locals_[other].half / 3 != triangle) return;
    for (const uint32_t h : {acrossU, acrossV})
        if (h != none) locals_[other].half = from(h) == other ? h : ahead(h);
}

}  // namespace sgm::mesh
