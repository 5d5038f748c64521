#include "modeler/mesh/border_corners.h"

#include <algorithm>
#include <cmath>

#include "modeler/mesh/cell_pieces.h"

namespace sgm::mesh {
namespace {

constexpr float sameCosine = 0.9999f;     ///< between the normals of two pieces in one plane
constexpr float leastSine = 0.1f;         ///< between the planes that make a crease
constexpr float acrossCosine = 0.01f;     ///< between the crease and the normals: more tells where along it
constexpr float besideShare = 0x1.0p-7f;  ///< of a cell: how far beside the crease the pieces are looked at
constexpr size_t linePoints = 9;          ///< looked at along the crease in a round
constexpr int lineRounds = 5;

/// The part of a line p + t d, d a unit vector, that lies in a box, as [from, to]; empty where from > to.
std::array<float, 2> withinBox(Vec3f p, Vec3f d, Vec3f low, Vec3f high) {
    std::array<float, 2> span{-1e30f, 1e30f};
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(d[axis]) < 1e-6f) continue;
        const float a = (low[axis] - p[axis]) / d[axis], b = (high[axis] - p[axis]) / d[axis];
        span = {std::max(span[0], std::min(a, b)), std::min(span[1], std::max(a, b))};
    }
    return span;
}

/// The part of a line p + t d, d a unit vector, across which a box lies.
std::array<float, 2> besideBox(Vec3f p, Vec3f d, const Box3f& box) {
    const Vec3f middle = (box.lo + box.hi) * 0.5f, half = (box.hi - box.lo) * 0.5f;
    const float at = dot(middle - p, d),
                reach = std::abs(d.x) * half.x + std::abs(d.y) * half.y + std::abs(d.z) * half.z;
    return {at - reach, at + reach};
}

}  // namespace

/// The crease on which a corner lies, which may leave its cell, and the two pieces beside it whose border ends there;
/// nothing where the planes tell the corner's place.
std::optional<BorderCorners::OnCrease> BorderCorners::creaseOf(CellCorner& corner, const Grid& grid) {
    const size_t n = corner.labels.size();
    if (n < 3 || corner.isSmooth || length(corner.meeting - corner.at) > CellCorner::reach * grid.cell_m)
        return std::nullopt;
    std::vector<Vec3f> normals(n);
    for (size_t k = 0; k < n; ++k)
        for (const PiecePoint& plane : corner.planes)
            if (plane.label == corner.labels[k]) normals[k] = normalized(plane.gradient);
    for (size_t k = 0; k < n; ++k) {
        const size_t next = (k + 1) % n;
        if (!(dot(normals[k], normals[next]) > sameCosine)) continue;
        Vec3f along{};
        for (const Vec3f& other : normals)
            if (const Vec3f c = cross(normals[k], other); dot(c, c) > dot(along, along)) along = c;
        if (!(length(along) > leastSine)) return std::nullopt;
        along = normalized(along);
        if (std::any_of(normals.begin(), normals.end(),
                        [&](Vec3f normal) { return std::abs(dot(normal, along)) > acrossCosine; }))
            return std::nullopt;
        Vec3f beside = cross(normals[k], along);
        if (dot(beside, (corner.means[k] + corner.means[next]) * 0.5f - corner.meeting) < 0) beside = -beside;
        const Vec3i cell = corner.cell;
        const Box3f box{grid.corner(cell.x, cell.y, cell.z), grid.corner(cell.x + 1, cell.y + 1, cell.z + 1)};
        const auto [from, to] = corner.meeting == corner.at ? withinBox(corner.at, along, box.lo, box.hi)
                                                            : besideBox(corner.meeting, along, box);
        if (!(from < to)) return std::nullopt;
        return OnCrease{&corner, corner.meeting, along, beside * (besideShare * grid.cell_m), {k, next}, {from, to}};
    }
    return std::nullopt;
}

uint64_t BorderCorners::place(std::span<CellCorner> corners, const BlockTapes& tapes, const Grid& grid,
                              eval::Workspace& workspace) {
    std::vector<OnCrease> open;
    for (CellCorner& corner : corners)
        if (const auto found = creaseOf(corner, grid)) open.push_back(*found);
    uint64_t evaluations = 0;
    for (int round = 0; round < lineRounds && !open.empty(); ++round) {
        probes_.clear();
        for (const OnCrease& crease : open)
            for (size_t i = 0; i < linePoints; ++i)
                probes_.add(tapes, crease.corner->brick,
                            crease.at(static_cast<float>(i) / (linePoints - 1)) + crease.beside);
        probes_.evaluate(workspace);
        evaluations += probes_.size();
        size_t kept = 0;
        for (size_t c = 0; c < open.size(); ++c) {
            if (!narrow(open[c], c * linePoints)) continue;  // within the margin of ties the wall shows instead
            CellCorner& corner = *open[c].corner;
            const bool leaves = corner.meeting != corner.at;
            corner.meeting = open[c].at(0.5f);
            corner.at = inCell(grid, corner.cell, corner.meeting);
            if (!leaves) corner.meeting = corner.at;
            corner.settled = false;
            open[kept++] = open[c];
        }
        open.resize(kept);
    }
    return evaluations;
}

/// Puts the part of the crease on which the pieces change in the place of all of it; false where they don't.
bool BorderCorners::narrow(OnCrease& crease, size_t sample) const {
    const std::array<uint32_t, 2> labels{crease.corner->labels[crease.pieces[0]],
                                         crease.corner->labels[crease.pieces[1]]};
    const float step = (crease.span[1] - crease.span[0]) / (linePoints - 1);
    const auto labelAt = [&](size_t i) {
        float value;
        return probes_.point(sample + i, value).label;
    };
    size_t last = 0;  // where one of the two pieces was seen
    for (size_t i = 0; i < linePoints; ++i) {
        const uint32_t label = labelAt(i);
        if (label != labels[0] && label != labels[1]) continue;
        const uint32_t before = labelAt(last);
        const bool changes = label != before && (before == labels[0] || before == labels[1]);
        if (changes && i <= last + 2) {  // one point between them may lie within the margin of ties
            crease.span = {crease.span[0] + step * static_cast<float>(last),
                           crease.span[0] + step * static_cast<float>(i)};
            return true;
        }
        last = i;
    }
    return false;
}

}  // namespace sgm::mesh
