#include <algorithm>
#include <cmath>

#include "tests/exact/quality.h"

namespace sgm::exact {
namespace {

/// Creases first … last of one chain.
struct Chain {
    std::span<const Crease> pieces;
    double length = 0;
    Vec3d begin() const { return pieces.front().segment.a; }
    Vec3d end() const { return pieces.back().segment.b; }
    bool closed() const { return begin() == end(); }
};

std::vector<Chain> chainsOf(const std::vector<Crease>& creases) {
    std::vector<Chain> chains;
    for (size_t first = 0; first < creases.size();) {
        Chain chain;
        size_t last = first;
        for (; last < creases.size() && creases[last].chain == creases[first].chain; ++last)
            chain.length += length(creases[last].segment.b - creases[last].segment.a);
        chain.pieces = std::span(creases).subspan(first, last - first);
        chains.push_back(chain);
        first = last;
    }
    return chains;
}

/// How thick the feature is at places of a chain.
class Thickness {
public:
    Thickness(const TriangleTree& surface, double cell_m)
        : surface_(surface), beside_m_(0.01 * cell_m), off_m_(0.05 * beside_m_), far_m_(2 * cell_m) {}

    /// True when nothing ends within two cells of `p`, on a piece of the chain.
    bool thick(const Chain& chain, const Crease& piece, Vec3d p) const {
        if (chain.length < far_m_) return false;
        const Vec3d along = normalized(piece.segment.b - piece.segment.a);
        const auto meets = [&](const Plane& plane) { return adjoins(chain, piece, p, plane); };
        for (int side = 0; side < 2; ++side) {
            const Vec3d n = piece.normals[side];
            Vec3d across = normalized(cross(n, along));
            // Into this face, away from the other one: against the other's normal where the crease is convex.
            if ((dot(across, piece.normals[1 - side]) < 0) != piece.convex) across = -across;
            const Vec3d beside = p + across * beside_m_, in = beside - n * off_m_, out = beside + n * off_m_;
            const double least = std::min({surface_.hit(in, -n, meets), surface_.hit(out, n, meets),
                                           surface_.hit(in, across, meets), surface_.hit(out, across, meets)});
            if (least < far_m_ - 2 * beside_m_) return false;
        }
        return true;
    }

private:
    /// Whether a face's plane holds the crease, or its chain's end where that is near.
    bool adjoins(const Chain& chain, const Crease& piece, Vec3d p, const Plane& plane) const {
        const double close = off_m_ * 0.1;
        if (plane.distance(piece.segment.a) < close && plane.distance(piece.segment.b) < close) return true;
        if (chain.closed()) return false;
        for (const Vec3d end : {chain.begin(), chain.end()})
            if (length(end - p) < 1.5 * far_m_ && plane.distance(end) < close) return true;
        return false;
    }

    const TriangleTree& surface_;
    const double beside_m_;  ///< from the crease into a face
    const double off_m_;     ///< from the face
    const double far_m_;     ///< two cells
};

}  // namespace

CreaseSamples sampleCreases(const ExactModel& model, double cell_m) {
    const TriangleTree surface(model.points, model.triangles);
    const Thickness thickness(surface, cell_m);
    CreaseSamples samples;
    for (const Chain& chain : chainsOf(model.creases)) {
        const auto count = static_cast<size_t>(std::ceil(chain.length / (0.5 * cell_m)));
        const double step = chain.length / static_cast<double>(count);
        double next = step / 2, passed = 0;
        for (const Crease& piece : chain.pieces) {
            const Vec3d way = piece.segment.b - piece.segment.a;
            const double here = length(way);
            for (; next < passed + here; next += step) {
                const Vec3d p = piece.segment.a + way * ((next - passed) / here);
                (thickness.thick(chain, piece, p) ? samples.thick : samples.thin).push_back(p);
            }
            passed += here;
        }
    }
    return samples;
}

std::vector<Vec3d> thickCorners(const ExactModel& model, const CreaseSamples& samples, double cell_m) {
    const PointTree thin(samples.thin.empty() ? std::vector<Vec3d>{{1e30, 1e30, 1e30}} : samples.thin);
    std::vector<Vec3d> corners;
    for (const Corner& c : model.corners)
        if (thin.distance(c.point) > cell_m && (c.creases > 0 || c.thickness_m >= 2 * cell_m))
            corners.push_back(c.point);
    return corners;
}

}  // namespace sgm::exact
