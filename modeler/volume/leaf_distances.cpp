#include "modeler/volume/leaf_distances.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "modeler/mesh/point_triangle.h"

namespace sgm::volume {
namespace {

constexpr int side = 8;
constexpr float infinite = std::numeric_limits<float>::infinity();

/// The least distance along an axis from a voxel to a cell `offset` further.
float gap(int offset) { return static_cast<float>(offset >= 0 ? offset : -(offset + 1)); }

/// Bits `from` … `to`, none of them where from > to.
uint64_t bits(int from, int to) {
    if (from > to) return 0;
    const uint64_t upTo = to >= 63 ? ~uint64_t{0} : (uint64_t{1} << (to + 1)) - 1;
    return upTo & ~((uint64_t{1} << from) - 1);
}

}  // namespace

LeafDistances::LeafDistances(int halfWidth)
    : halfWidth_(halfWidth), margin_(halfWidth + 1), window_(side + 2 * halfWidth + 1) {
    const auto limit = static_cast<float>(halfWidth * halfWidth);
    for (int i = -margin_; i < margin_; ++i)
        for (int j = -margin_; j < margin_; ++j) {
            const float squared = gap(i) * gap(i) + gap(j) * gap(j);
            if (squared >= limit) continue;
            int run = 0;
            while (squared + static_cast<float>((run + 1) * (run + 1)) < limit) ++run;
            rows_.push_back({i, j, squared, run});
        }
    std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.squared < b.squared; });
    for (int k = -margin_; k < margin_; ++k) gaps_.push_back(gap(k) * gap(k));
}

void LeafDistances::clear() {
    facets_.clear();
    const auto side_ = static_cast<size_t>(window_);
    occupied_.assign(side_ * side_, 0);
    cells_.resize(side_ * side_ * side_);
}

void LeafDistances::add(const LeafSurface& surface, Vec3i leaves) {
    if (surface.begin.empty()) return;
    const Vec3i shift = leaves * side;
    const auto lo = [&](int axis) { return std::max(0, -margin_ - shift[axis]); };
    const auto hi = [&](int axis) { return std::min(side, side + halfWidth_ - shift[axis]); };
    for (int i = lo(0); i < hi(0); ++i)
        for (int j = lo(1); j < hi(1); ++j)
            for (int k = lo(2); k < hi(2); ++k) {
                const auto n = static_cast<size_t>((i * side + j) * side + k);
                if (surface.begin[n] == surface.begin[n + 1]) continue;
                const size_t at = row(i + shift.x, j + shift.y);
                const int bit = k + shift.z + margin_;
                occupied_[at] |= uint64_t{1} << bit;
                Range& cell = cells_[at * static_cast<size_t>(window_) + static_cast<size_t>(bit)];
                cell.begin = static_cast<uint32_t>(facets_.size());
                for (size_t t = surface.begin[n]; t < surface.begin[n + 1]; ++t) {
                    Facet moved = surface.facets[t];
                    for (Vec3f& p : moved.corners) p += shift.as<float>();
                    facets_.push_back(moved);
                }
                cell.end = static_cast<uint32_t>(facets_.size());
            }
}

/// The voxels k of the leaf's row (i, j), at bit k, to which some cell with triangles may be near enough.
uint64_t LeafDistances::within(int i, int j) const {
    uint64_t near = 0;
    for (const Row& r : rows_) {
        const uint64_t cells = occupied_[row(i + r.i, j + r.j)];
        if (cells == 0) continue;
        // Cell k + d is near to voxel k for every d from −run − 1 to run.
        for (int d = -r.run - 1; d <= r.run; ++d) near |= cells >> (margin_ + d);
    }
    return near & bits(0, side - 1);
}

float LeafDistances::squaredAt(Vec3i voxel) const {
    const Vec3f p = voxel.as<float>();
    float best = static_cast<float>(halfWidth_ * halfWidth_);
    bool found = false;
    for (const Row& r : rows_) {
        if (r.squared >= best) break;
        const size_t at = row(voxel.x + r.i, voxel.y + r.j);
        const int first = voxel.z + margin_;  // the bit of cell k = voxel.z
        for (uint64_t cells = occupied_[at] & bits(first - r.run - 1, first + r.run); cells != 0; cells &= cells - 1) {
            const int bit = std::countr_zero(cells);
            if (r.squared + gaps_[static_cast<size_t>(bit - first + margin_)] >= best) continue;
            const Range cell = cells_[at * static_cast<size_t>(window_) + static_cast<size_t>(bit)];
            for (uint32_t t = cell.begin; t < cell.end; ++t) {
                const Facet& f = facets_[t];
                const float off = dot(f.normal, p - f.corners[0]);
                if (off * off >= best) continue;  // nothing in its plane is nearer
                const float squared = mesh::squaredDistance(p, f.corners[0], f.corners[1], f.corners[2]);
                if (squared < best) best = squared, found = true;
            }
        }
    }
    return found ? best : infinite;
}

const std::array<float, 512>& LeafDistances::distances() {
    distances_.fill(infinite);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (uint64_t near = within(i, j); near != 0; near &= near - 1) {
                const int k = std::countr_zero(near);
                distances_[static_cast<size_t>((i * side + j) * side + k)] = std::sqrt(squaredAt({i, j, k}));
            }
    return distances_;
}

}  // namespace sgm::volume
