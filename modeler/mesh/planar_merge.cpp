#include "modeler/mesh/planar_merge.h"

#include <algorithm>
#include <utility>

#include "modeler/core/parallel.h"
#include "modeler/mesh/polyline.h"
#include "modeler/mesh/triangulate.h"

namespace sgm::mesh {
namespace {

/// What a chain may take of its bound, in turn where it fails: rounding alone at last but one, nothing at last.
constexpr double shares[] = {1, 0.25, 0, -1};
constexpr uint8_t lastLevel = std::size(shares) - 1;
/// Regions that are worth a step of a parallel loop.
constexpr size_t regionsPerStep = 32;

}  // namespace

PlanarMerge::PlanarMerge(const DecimationInput& input, double chain_m, double rounding_m)
    : input_(input),
      chain_m_(chain_m),
      rounding_m_(rounding_m),
      keep_(input.chains.vertices.size()),
      given_(input.chains.vertices.size()),
      levels_(input.chains.chains.size()),
      left_(input.regions.count()),
      failed_(input.regions.count()),
      triangles_(input.regions.count()) {}

bool PlanarMerge::run(Decimation& curved, int threads, Progress* progress) {
    for (uint32_t c = 0; c < levels_.size(); ++c) simplifyChain(c, curved);
    std::vector<uint32_t> open;
    for (uint32_t r = 0; r < left_.size(); ++r)
        if (isPlanar(r) && !left_[r]) open.push_back(r);
    while (!open.empty() && !cancelled(progress)) {
        triangulate(open, threads, progress);
        std::vector<uint32_t> again;
        bool decimated = false;
        for (const uint32_t region : open) {
            if (!failed_[region]) continue;
            for (const uint32_t c : input_.chains.around(region)) {
                const Chain& chain = input_.chains.chains[c];
                if (!isPlanar(chain.left) || !isPlanar(chain.right)) decimated |= curved.keepChain(chain);
            }
            refine(region, curved);
            for (const uint32_t c : input_.chains.around(region))
                for (const uint32_t side : {input_.chains.chains[c].left, input_.chains.chains[c].right})
                    if (isPlanar(side) && !left_[side]) again.push_back(side);
        }
        if (decimated) return true;
        std::sort(again.begin(), again.end());
        again.erase(std::unique(again.begin(), again.end()), again.end());
        open.swap(again);
    }
    return false;
}

bool PlanarMerge::refine(uint32_t region, Decimation& curved) {
    if (left_[region]) return false;
    bool refined = false;
    for (const uint32_t c : input_.chains.around(region)) {
        const Chain& chain = input_.chains.chains[c];
        if (!isPlanar(chain.left) || !isPlanar(chain.right)) {
            refined |= curved.keepChain(chain);
        } else if (levels_[c] < lastLevel) {
            ++levels_[c];
            simplifyChain(c, curved);
            refined = true;
        }
    }
    if (!refined) left_[region] = 1;
    return true;
}

std::vector<uint8_t> PlanarMerge::triangulated() const {
    std::vector<uint8_t> found(left_.size());
    for (uint32_t r = 0; r < found.size(); ++r) found[r] = isPlanar(r) && !left_[r];
    return found;
}

void PlanarMerge::simplifyChain(uint32_t index, const Decimation& curved) {
    const Chain& chain = input_.chains.chains[index];
    if (!isPlanar(chain.left) || !isPlanar(chain.right)) {
        for (uint32_t i = chain.begin; i < chain.end; ++i) keep_[i] = curved.isLeft(i);
        return;
    }
    const double share = shares[levels_[index]];
    if (share < 0) {
        std::fill(keep_.begin() + chain.begin, keep_.begin() + chain.end, uint8_t{1});
        return;
    }
    std::vector<Vec3f> points;
    for (uint32_t i = chain.begin; i < chain.end; ++i)
        points.push_back(input_.mesh.positions[input_.chains.vertices[i]]);
    std::vector<bool> keep(points.size());
    simplifyPolyline(points, chain.closed, std::max(rounding_m_, share * chain_m_), keep);
    for (size_t i = 0; i < keep.size(); ++i) keep_[chain.begin + i] = keep[i] || given_[chain.begin + i];
}

bool PlanarMerge::splitEdges(uint32_t region, const Triangle& triangle) {
    const auto isCorner = [&](uint32_t v) { return v == triangle.x || v == triangle.y || v == triangle.z; };
    const auto at = [&](uint32_t place) { return input_.mesh.positions[input_.chains.vertices[place]].as<double>(); };
    bool split = false;
    for (const uint32_t c : input_.chains.around(region)) {
        const Chain& chain = input_.chains.chains[c];
        if (!isPlanar(chain.left) || !isPlanar(chain.right)) continue;
        uint32_t before = Chains::none;
        for (uint32_t i = chain.begin; i < chain.end; ++i) {
            if (!keep_[i]) continue;
            const uint32_t from = std::exchange(before, i);
            if (from == Chains::none || i - from < 2 || !isCorner(input_.chains.vertices[from]) ||
                !isCorner(input_.chains.vertices[i]))
                continue;
            uint32_t farthest = from + (i - from) / 2;
            double most = 0;
            for (uint32_t k = from + 1; k < i; ++k)
                if (const double off = squaredDistance(at(k), at(from), at(i)); off > most) most = off, farthest = k;
            keep_[farthest] = given_[farthest] = 1, split = true;
        }
    }
    return split;
}

void PlanarMerge::triangulate(std::span<const uint32_t> regions, int threads, Progress* progress) {
    parallelFor((regions.size() + regionsPerStep - 1) / regionsPerStep, threads, progress, [&](size_t step, int) {
        std::vector<DirectedEdge> boundary;
        for (size_t i = step * regionsPerStep; i < std::min(regions.size(), (step + 1) * regionsPerStep); ++i) {
            const uint32_t region = regions[i];
            findBoundary(region, boundary);
            triangles_[region].clear();
            failed_[region] =
                !triangulatePlanar(boundary, input_.mesh.positions, input_.planes[region].normal, triangles_[region]);
        }
    });
}

void PlanarMerge::findBoundary(uint32_t region, std::vector<DirectedEdge>& boundary) const {
    boundary.clear();
    for (const uint32_t c : input_.chains.around(region)) {
        const Chain& chain = input_.chains.chains[c];
        const bool forward = chain.left == region;
        const auto add = [&](uint32_t a, uint32_t b) {
            boundary.push_back(forward ? DirectedEdge{a, b} : DirectedEdge{b, a});
        };
        uint32_t before = Chains::none, first = Chains::none;
        for (uint32_t i = chain.begin; i < chain.end; ++i) {
            if (!keep_[i]) continue;
            const uint32_t v = input_.chains.vertices[i];
            if (before != Chains::none) add(before, v);
            if (first == Chains::none) first = v;
            before = v;
        }
        if (chain.closed) add(before, first);
    }
}

}  // namespace sgm::mesh
