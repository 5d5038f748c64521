// Whether a collapse keeps the surface a manifold and within its tolerance.
#include <algorithm>

#include "modeler/mesh/decimate_job.h"
#include "modeler/mesh/polyline.h"

namespace sgm::mesh {

/// Calls visit with the triangles around a vertex, as far as its first half-edge leads, until one returns true; whether
/// one did.
template <class Visit>
bool DecimationJob::anyTriangle(uint32_t v, Visit&& visit) const {
    const uint32_t start = locals_[v].half;
    for (uint32_t h = start;;) {
        if (visit(h / 3)) return true;
        h = opposite_[behind(h)];
        if (h == start) return false;
        if (h == none) break;
    }
    for (uint32_t h = start; opposite_[h] != none;) {
        h = ahead(opposite_[h]);
        if (visit(h / 3)) return true;
    }
    return false;
}

/// The same for neighbours.
template <class Visit>
bool DecimationJob::anyNeighbour(uint32_t v, Visit&& visit) const {
    return anyTriangle(v, [&](uint32_t t) {
        for (uint32_t h = 3 * t; h < 3 * t + 3; ++h)
            if (corners_[h] != v && visit(corners_[h])) return true;
        return false;
    });
}

/// Whether no edge or triangle comes to be twice.
bool DecimationJob::keepsManifold(uint32_t u, size_t target) {
    const size_t n = ring_.size();
    const uint32_t v = ring_[target];
    const bool chain = locals_[u].kind == Kind::Chain;
    const size_t beyond = chain ? (target == 0 ? sides_[0].to : 0) : n;
    if (chain && ring_[beyond] == v) return false;
    if (closed_ && n == 3) {  // the one triangle left must not lie on its own back
        const uint32_t back = opposite_[ahead(star_[(target + 1) % 3])];
        if (back == none || from(behind(back)) == v) return false;
    }
    const auto isBeside = [&](size_t i) {
        return i + 1 == target || i == target + 1 || (closed_ && (i + target == n - 1) && (i == 0 || target == 0));
    };
    ++stamp_;
    bool known = traversable(v);
    for (size_t i = 0; i < n; ++i) {
        if (i == target || isBeside(i)) continue;
        const uint32_t r = ring_[i];
        if (i != beyond && locals_[v].kind != Kind::Inner && locals_[r].kind != Kind::Inner && sharePlane(v, r))
            return false;
        if (known)
            locals_[r].stamp = stamp_;
        else if (traversable(r) ? anyNeighbour(r, [&](uint32_t w) { return w == v; })
                                : i != beyond || !locals_[v].whole || !locals_[r].whole)
            return false;
    }
    return !known || !anyNeighbour(v, [&](uint32_t w) { return w != u && locals_[w].stamp == stamp_; });
}

/// Whether two vertices on borders are both on one planar region, where a new edge between them could double one of it.
bool DecimationJob::sharePlane(uint32_t a, uint32_t b) const {
    const auto planes = [&](uint32_t v, auto&& visit) {
        if (locals_[v].kind == Kind::Chain) {
            const uint32_t place = chainPlace(v);
            const std::vector<Chain>& chains = all_.input.chains.chains;
            const Chain& chain = *std::prev(std::upper_bound(chains.begin(), chains.end(), place,
                                                             [](uint32_t p, const Chain& c) { return p < c.begin; }));
            for (const uint32_t region : {chain.left, chain.right})
                if (all_.input.planes[region].planar() && visit(region)) return true;
            return false;
        }
        const auto& at = all_.planarAtNodes;
        for (auto i = std::lower_bound(at.begin(), at.end(), std::array{locals_[v].vertex, 0u});
             i != at.end() && (*i)[0] == locals_[v].vertex; ++i)
            if (visit((*i)[1])) return true;
        return false;
    };
    return planes(a, [&](uint32_t p) { return planes(b, [&](uint32_t q) { return p == q; }); });
}

/// Whether a chain without u is within the tolerance of all its original points.
bool DecimationJob::chainStays(uint32_t u, float tolerance) const {
    const std::vector<uint32_t>& vertices = all_.input.chains.vertices;
    const uint32_t place = chainPlace(u), previous = all_.previous[place], next = all_.next[place];
    const auto position = [&](uint32_t p) { return all_.input.mesh.positions[vertices[p]].as<double>(); };
    const double bound = all_.limits.chain_m * static_cast<double>(tolerance) / all_.limits.surface_m;
    const std::vector<Chain>& chains = all_.input.chains.chains;
    const Chain& chain = *std::prev(
        std::upper_bound(chains.begin(), chains.end(), place, [](uint32_t p, const Chain& c) { return p < c.begin; }));
    const Vec3d a = position(previous), b = position(next);
    for (uint32_t p = previous;;) {
        p = p + 1 == chain.end ? chain.begin : p + 1;
        if (p == next) return true;
        if (squaredDistance(position(p), a, b) > bound * bound) return false;
    }
}

void DecimationJob::gatherPoints() {
    points_.clear();
    for (uint16_t side = 0; side < sideCount_; ++side)
        for (size_t i = sides_[side].from; i < sides_[side].to; ++i)
            for (uint32_t p = firstPoint_[star_[i] / 3]; p != none; p = locals_[p].next)
                points_.push_back({p, side, 0});
}

/// Whether one side's fan about the target is within the tolerance of the original surface.
bool DecimationJob::fits(uint32_t u, size_t target, size_t which, float tolerance) {
    Side& side = sides_[which];
    const size_t n = ring_.size();
    side.corners.clear(), side.triangles.clear();
    fanCorners_.clear();
    const auto add = [&](size_t i) {
        fanCorners_.push_back(ring_[i % n]);
        side.corners.push_back(locals_[ring_[i % n]].position);
        side.triangles.push_back(star_[i % star_.size()]);
    };
    if (locals_[u].kind == Kind::Inner) {
        for (size_t i = 0; i < n; ++i) add(target + i);
    } else if (target == side.from) {
        for (size_t i = side.from; i <= side.to; ++i) add(i);
    } else if (target % n == side.to % n) {
        add(side.to);
        for (size_t i = side.from; i < side.to; ++i) add(i);
    } else {
        return false;
    }
    if (!fan_.set(side.corners, side.normal, tolerance)) return false;
    if (locals_[u].kind == Kind::Inner) {
        const Vec3f at = locals_[u].position;
        uOver_ = static_cast<uint16_t>(fan_.triangleOver(at));
        if (!(fan_.distance(at, uOver_) <= tolerance)) return false;
    }
    for (Point& p : points_) {
        if (p.side != which) continue;
        const Vec3f at = locals_[p.local].position;
        p.over = static_cast<uint16_t>(fan_.triangleOver(at));
        if (!(fan_.distance(at, p.over) <= tolerance)) return false;
    }
    gone_ = u;
    return edgesFit(which, tolerance);
}

/// Whether original edges over the fan pass its sides within the tolerance. Those that only pass over a corner of it
/// end beside it, over triangles around the polygon's corners.
bool DecimationJob::edgesFit(size_t side, float tolerance) {
    ++stamp_;
    for (size_t i = sides_[side].from; i < sides_[side].to; ++i)
        if (!edgesFitOver(star_[i] / 3, tolerance)) return false;
    // Those are rare, and pass not much farther off than the others: they count where nothing is to spare.
    if (3 * tolerance < static_cast<float>(all_.limits.surface_m)) return true;
    for (const uint32_t r : fanCorners_)
        if (anyTriangle(r, [&](uint32_t t) { return !edgesFitOver(t, tolerance); })) return false;
    return true;
}

bool DecimationJob::edgesFitOver(uint32_t triangle, float tolerance) {
    if (triangleStamps_[triangle] == stamp_) return true;
    triangleStamps_[triangle] = stamp_;
    for (uint32_t p = firstPoint_[triangle]; p != none; p = locals_[p].next)
        if (!edgesFitFrom(p, tolerance)) return false;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        const Local& corner = locals_[corners_[h]];
        // All original edges of a vertex whose star never changed are edges still.
        if (corner.stamp == stamp_ || !(corner.changed || corners_[h] == gone_)) continue;
        if (!edgesFitFrom(corners_[h], tolerance)) return false;
    }
    return true;
}

bool DecimationJob::edgesFitFrom(uint32_t v, float tolerance) {
    Local& from = locals_[v];
    from.stamp = stamp_;
    if (fan_.isFar(from.position, all_.longestEdge_m)) return true;
    const uint32_t sides = fan_.sidesOf(from.position);
    const uint32_t end = v + 1 < pointCount_ ? locals_[v + 1].neighbours : lastNeighbours_;
    for (uint32_t i = from.neighbours; i < end; ++i) {
        const Local& to = locals_[neighbours_[i]];
        if (to.stamp == stamp_ || fan_.isBeside(from.position, to.position)) continue;
        const uint32_t between = sides ^ fan_.sidesOf(to.position);
        if (between != 0 && !fan_.crossesWithin(from.position, to.position, between, tolerance)) return false;
    }
    return true;
}

}  // namespace sgm::mesh
