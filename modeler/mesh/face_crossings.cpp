// Creases that leave the faces of cells: whether pieces cross where their lines do.
#include <cmath>
#include <optional>

#include "modeler/mesh/face_creases.h"

namespace sgm::mesh {
namespace {

constexpr double crossingReach = 8.0;      ///< of a cell, that a crossing may lie outside its face
constexpr double parallelSquare = 1e-3;    ///< squared sine of the least angle of a crease outside its face
constexpr float farthestApart = 0.5f;      ///< of a smooth gap: 1 less the cosine between its ends
constexpr float leastTurned = 1e-3f;       ///< of that, between either end and the border
constexpr float smoothBorder = 0.9999f;    ///< cosine between the pieces beside a border that is no crease
constexpr double stopShare = 0x1p-10;      ///< of a cell, between a crossing and the piece that ends its crease
constexpr float confirmedShare = 0.0625f;  ///< of a cell times the slope: the field beside a confirmed crossing

/// Whether the surface turns from one end of a gap to the other, and doesn't bend at the border amid that. Within the
/// margin of ties one piece shows with the other's derivative, which doesn't turn where both are flat.
bool isSmooth(const PiecePoint& begin, const PiecePoint& before, const PiecePoint& behind, const PiecePoint& end) {
    const Vec3f from = normalized(begin.gradient), to = normalized(end.gradient), a = normalized(before.gradient),
                b = normalized(behind.gradient);
    const float apart = 1 - dot(from, to), turned = apart * leastTurned;
    return apart < farthestApart && 1 - dot(from, a) > turned && 1 - dot(b, to) > turned && dot(a, b) > smoothBorder;
}

/// A crossing moved along its crease to a little before a third piece, the nearer the farther it lay beyond; none where
/// the crease runs along that one.
std::optional<Vec3f> beforeThird(Vec3f crossing, Vec3f slopeA, Vec3f slopeB, const LinearField& third, double cell_m) {
    const Vec3d along = normalized(cross(slopeA.as<double>(), slopeB.as<double>()));
    const Vec3d slope = third.point.gradient.as<double>();
    const double rise = dot(slope, along);
    if (!(std::abs(rise) > parallelSine * length(slope))) return std::nullopt;
    const double there = third.value + dot(slope, (crossing - third.point.at).as<double>());
    const double way = -there / rise;  // from the crossing to the end
    const double before = stopShare * cell_m / (1 + std::abs(way) / cell_m);
    return crossing + (along * (way + std::copysign(before, way))).as<float>();
}

}  // namespace

/// The crease lies outside the face: the crossing is its point nearest to `from`, so that points keep their order along
/// it.
void FaceCreases::projectOntoCrease(Gap& gap, Vec3f from) const {
    const Vec3d p = from.as<double>(), a = gap.nearA.point.gradient.as<double>(),
                b = gap.nearB.point.gradient.as<double>();
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), det = aa * bb - ab * ab;
    gap.leaves = false;
    if (!(det > parallelSquare * aa * bb)) return;
    const double fa = gap.nearA.value + dot(a, p - gap.nearA.point.at.as<double>());
    const double fb = gap.nearB.value + dot(b, p - gap.nearB.point.at.as<double>());
    gap.crossing = (p - a * ((fa * bb - fb * ab) / det) - b * ((fb * aa - fa * ab) / det)).as<float>();
    gap.leaves = length(gap.crossing - from) <= crossingReach * grid_->cell_m;
}

/// Crossings outside their faces count where both pieces are found beside them, on the surface. Where a third piece
/// ends the crease before, the crossing is moved to this side of its end and looked at again.
uint64_t FaceCreases::confirmCrossings(const std::vector<FaceSegment>& segments, eval::Workspace& workspace) {
    open_.clear();
    for (uint32_t g = 0; g < gaps_.size(); ++g)
        if (gaps_[g].leaves) open_.push_back(g);
    uint64_t evaluations = 0;
    for (int round = 0; round < 2 && !open_.empty(); ++round) {
        samples_.clear();
        for (const uint32_t g : open_) {
            const size_t brick = segments[gaps_[g].segment].brick;
            samples_.add(tapes_, brick, between(gaps_[g].crossing, gaps_[g].a.at, probeShare));
            samples_.add(tapes_, brick, between(gaps_[g].crossing, gaps_[g].b.at, probeShare));
        }
        evaluations += samples_.size();
        samples_.evaluate(workspace);
        next_.clear();
        for (size_t i = 0; i < open_.size(); ++i) {
            Gap& gap = gaps_[open_[i]];
            gap.leaves = false;
            bool confirmed = true;
            for (size_t side = 0; side < 2; ++side) {
                float value;
                const PiecePoint probe = samples_.point(2 * i + side, value);
                confirmed = confirmed && probe.label == (side == 0 ? gap.a : gap.b).label &&
                            std::abs(value) <= confirmedShare * grid_->cell_m * length(probe.gradient);
                if (round > 0 || gap.leaves || probe.label == gap.a.label || probe.label == gap.b.label) continue;
                const auto moved = beforeThird(gap.crossing, gap.nearA.point.gradient, gap.nearB.point.gradient,
                                               {probe, value}, grid_->cell_m);
                if (!moved) continue;
                gap.crossing = *moved;
                gap.leaves = length(gap.crossing - gap.at) <= crossingReach * grid_->cell_m;
            }
            if (gap.leaves) next_.push_back(open_[i]);
            gap.leaves = gap.leaves || confirmed;
        }
        open_.swap(next_);
    }
    return evaluations;
}

/// Of a crossing outside its face that isn't there, the break was moved to the nearest place inside. Where the surface
/// doesn't bend between its pieces, as on blends, that is no place of theirs: their border is searched between the
/// ends.
uint64_t FaceCreases::searchSmoothBorders(const std::vector<FaceSegment>& segments, eval::Workspace& workspace) {
    std::vector<std::pair<uint32_t, Gap>> before;
    open_.clear();
    for (uint32_t g = 0; g < gaps_.size(); ++g) {
        Gap& gap = gaps_[g];
        if (gap.leaves || gap.looks.isBorder || mayLieAt(segments[gap.segment], gap.crossing)) continue;
        before.emplace_back(g, gap);
        searchBorder(gap);
        open_.push_back(g);
    }
    const uint64_t evaluations = solveOpen(segments, workspace);
    for (const auto& [g, crease] : before) {
        Gap& gap = gaps_[g];
        if (gap.splits == crease.splits && isSmooth(gap.a, gap.nearA.point, gap.nearB.point, gap.b))
            gap.leaves = false;
        else
            gap = crease;
    }
    return evaluations;
}

}  // namespace sgm::mesh
