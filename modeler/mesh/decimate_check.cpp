// Whether a collapse keeps the surface a manifold and within its tolerance.
#include <algorithm>

#include "modeler/mesh/decimate_job.h"
#include "modeler/mesh/polyline.h"

namespace sgm::mesh {

/// Whether no edge or triangle comes to be twice.
bool DecimationJob::keepsManifold(uint32_t u, size_t target) {
    const size_t n = star_.ring.size();
    const uint32_t v = star_.ring[target];
    const bool chain = patch_.vertices[u].kind == Kind::Chain;
    const size_t beyond = chain ? (target == 0 ? star_.sides[0].to : 0) : n;
    if (chain && star_.ring[beyond] == v) return false;
    if (star_.closed && n == 3) {  // the one triangle left must not lie on its own back
        const uint32_t back = patch_.opposite[LoadedPatch::ahead(star_.halves[(target + 1) % 3])];
        if (back == none || patch_.from(LoadedPatch::behind(back)) == v) return false;
    }
    const auto isBeside = [&](size_t i) {
        return i + 1 == target || i == target + 1 || (star_.closed && (i + target == n - 1) && (i == 0 || target == 0));
    };
    ++stamp_;
    bool known = patch_.traversable(v);
    for (size_t i = 0; i < n; ++i) {
        if (i == target || isBeside(i)) continue;
        const uint32_t r = star_.ring[i];
        if (i != beyond && patch_.vertices[v].kind != Kind::Inner && patch_.vertices[r].kind != Kind::Inner &&
            sharePlane(v, r))
            return false;
        if (known)
            patch_.vertices[r].stamp = stamp_;
        else if (patch_.traversable(r) ? patch_.anyNeighbour(r, [&](uint32_t w) { return w == v; })
                                       : i != beyond || !patch_.vertices[v].whole || !patch_.vertices[r].whole)
            return false;
    }
    return !known || !patch_.anyNeighbour(v, [&](uint32_t w) { return w != u && patch_.vertices[w].stamp == stamp_; });
}

/// Whether two vertices on borders are both on one planar region, where a new edge between them could double one of it.
bool DecimationJob::sharePlane(uint32_t a, uint32_t b) const {
    const auto planes = [&](uint32_t v, auto&& visit) {
        if (patch_.vertices[v].kind == Kind::Chain) {
            const uint32_t place = patch_.chainPlace(v);
            const std::vector<Chain>& chains = all_.input.chains.chains;
            const Chain& chain = *std::prev(std::upper_bound(chains.begin(), chains.end(), place,
                                                             [](uint32_t p, const Chain& c) { return p < c.begin; }));
            for (const uint32_t region : {chain.left, chain.right})
                if (all_.input.planes[region].planar() && visit(region)) return true;
            return false;
        }
        const auto& at = all_.planarAtNodes;
        for (auto i = std::lower_bound(at.begin(), at.end(), std::array{patch_.vertices[v].vertex, 0u});
             i != at.end() && (*i)[0] == patch_.vertices[v].vertex; ++i)
            if (visit((*i)[1])) return true;
        return false;
    };
    return planes(a, [&](uint32_t p) { return planes(b, [&](uint32_t q) { return p == q; }); });
}

/// Whether a chain without u is within the tolerance of all its original points.
bool DecimationJob::chainStays(uint32_t u, float tolerance) const {
    const std::vector<uint32_t>& vertices = all_.input.chains.vertices;
    const uint32_t place = patch_.chainPlace(u), previous = all_.previous[place], next = all_.next[place];
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
    for (size_t side = 0; side < star_.sideCount; ++side)
        for (size_t i = star_.sides[side].from; i < star_.sides[side].to; ++i)
            for (uint32_t p = patch_.triangles.firstPoint[star_.halves[i] / 3]; p != none; p = patch_.vertices[p].next)
                points_.push_back({p, static_cast<uint16_t>(side), 0});
}

/// Whether one side's fan about the target is within the tolerance of the original surface.
bool DecimationJob::fits(uint32_t u, size_t target, size_t which, float tolerance) {
    Side& side = star_.sides[which];
    const size_t n = star_.ring.size();
    side.corners.clear(), side.triangles.clear();
    fanCorners_.clear();
    const auto add = [&](size_t i) {
        fanCorners_.push_back(star_.ring[i % n]);
        side.corners.push_back(patch_.vertices[star_.ring[i % n]].position);
        side.triangles.push_back(star_.halves[i % star_.halves.size()]);
    };
    if (patch_.vertices[u].kind == Kind::Inner) {
        for (size_t i = 0; i < n; ++i) add(target + i);
    } else if (target == side.from) {
        for (size_t i = side.from; i <= side.to; ++i) add(i);
    } else if (target % n == side.to % n) {
        add(side.to);
        for (size_t i = side.from; i < side.to; ++i) add(i);
    } else {
        return false;
    }
    if (!fan_.set(side.corners, side.normal, side.leastFacing, tolerance)) return false;
    if (patch_.vertices[u].kind == Kind::Inner) {
        const Vec3f at = patch_.vertices[u].position;
        uOver_ = static_cast<uint16_t>(fan_.triangleOver(at));
        if (!(fan_.distance(at, uOver_) <= tolerance)) return false;
    }
    for (Point& p : points_) {
        if (p.side != which) continue;
        const Vec3f at = patch_.vertices[p.local].position;
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
    for (size_t i = star_.sides[side].from; i < star_.sides[side].to; ++i)
        if (!edgesFitOver(star_.halves[i] / 3, tolerance)) return false;
    // Those are rare, and pass not much farther off than the others: they count where nothing is to spare.
    if (3 * tolerance < static_cast<float>(all_.limits.surface_m)) return true;
    for (const uint32_t r : fanCorners_)
        if (patch_.anyTriangle(r, [&](uint32_t t) { return !edgesFitOver(t, tolerance); })) return false;
    return true;
}

bool DecimationJob::edgesFitOver(uint32_t triangle, float tolerance) {
    if (patch_.triangles.stamps[triangle] == stamp_) return true;
    patch_.triangles.stamps[triangle] = stamp_;
    for (uint32_t p = patch_.triangles.firstPoint[triangle]; p != none; p = patch_.vertices[p].next)
        if (!edgesFitFrom(p, tolerance)) return false;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
        const PatchVertex& corner = patch_.vertices[patch_.corners[h]];
        // All original edges of a vertex whose star never changed are edges still.
        if (corner.stamp == stamp_ || !(corner.changed || patch_.corners[h] == gone_)) continue;
        if (!edgesFitFrom(patch_.corners[h], tolerance)) return false;
    }
    return true;
}

bool DecimationJob::edgesFitFrom(uint32_t v, float tolerance) {
    PatchVertex& from = patch_.vertices[v];
    from.stamp = stamp_;
    if (fan_.isFar(from.position, all_.longestEdge_m)) return true;
    const uint32_t sides = fan_.sidesOf(from.position);
    const uint32_t end = v + 1 < patch_.pointCount ? patch_.vertices[v + 1].neighbours : patch_.lastNeighbours;
    for (uint32_t i = from.neighbours; i < end; ++i) {
        const PatchVertex& to = patch_.vertices[patch_.neighbours[i]];
        if (to.stamp == stamp_ || fan_.isBeside(from.position, to.position)) continue;
        const uint32_t between = sides ^ fan_.sidesOf(to.position);
        if (between != 0 && !fan_.crossesWithin(from.position, to.position, between, tolerance)) return false;
    }
    return true;
}

}  // namespace sgm::mesh
