// Borders between pieces that don't bend where they meet: the point where one ends and the other begins.
#include <algorithm>
#include <cmath>

#include "modeler/mesh/face_axes.h"
#include "modeler/mesh/face_creases.h"

namespace sgm::mesh {
namespace {

constexpr int mostLooks = 2;               ///< times that the field is looked at below a border
constexpr double depthShare = 0.5625;      ///< of a bracket's length: how far below its middle
constexpr double besideShare = 0x1.0p-9;   ///< of a cell, between a border and where its sides are looked at
constexpr double tiesReach = 2;            ///< of the margin of ties: at least as far as that from the wall
constexpr double leastRise = 0.125;        ///< of a gap into its wall, a metre: flatter ones are looked at as for that
constexpr int besideRounds = 3;            ///< times that both sides are looked at, as the surface may bend
constexpr size_t borderParts = 4;          ///< of a border's bracket, one of which is the next: few rounds fill vectors
constexpr int borderRounds = 6;            ///< 4^-6 of a segment is left
constexpr float parallelCosine = 0.9999f;  ///< between two planes that have no crease
constexpr double gapMargin = 0x1.0p-7;     ///< of the line between a gap's ends, kept free of its break

double shareOfPart(size_t k) { return static_cast<double>(k) / static_cast<double>(borderParts); }

/// The point nearest to `p` on the line between a gap's ends, a little away from both: it always lies in the face.
Vec3f onLine(Vec3f from, Vec3f to, Vec3f p) {
    const Vec3d way = (to - from).as<double>();
    const double share = dot((p - from).as<double>(), way) / std::max(dot(way, way), 1e-300);
    return between(from, to, std::clamp(share, gapMargin, 1 - gapMargin));
}

}  // namespace

/// How far beside a border its pieces are looked at along the gap, metres: beyond where the fields of both tie, for
/// there the wall between them has the point. The flatter the gap runs into the wall, the farther that is.
double FaceCreases::besideReach(const Gap& gap) const {
    const Vec3d out = normalized(gap.wall.point.gradient.as<double>());
    const double rise = std::abs(dot(out, normalized((gap.nearB.point.at - gap.nearA.point.at).as<double>())));
    const double ties = tiesReach * double{tapes_.whole->tieMargin()} / std::max(rise, leastRise);
    return std::max(besideShare * double{grid_->cell_m}, ties);
}

/// `isFlat`: both pieces lie in one plane.
void FaceCreases::searchBorder(Gap& gap, bool isFlat) {
    gap.state = State::Border;
    gap.rounds = 0;
    gap.looks.isBorder = true;
    gap.looks.below = isFlat ? mostLooks : 0;
    gap.nearA.point = gap.a, gap.nearB.point = gap.b;
    gap.nearA.value = gap.nearB.value = 0;
}

void FaceCreases::askForBorder(const FaceSegment& segment, const Gap& gap) {
    const auto add = [&](Vec3d p) { samples_.add(tapes_, segment.brick, p.as<float>()); };
    const Vec3d low = gap.nearA.point.at.as<double>(), way = (gap.nearB.point.at - gap.nearA.point.at).as<double>();
    if (gap.state == State::Below)
        return add(low + way * 0.5 - normalized(gap.a.gradient.as<double>()) * (depthShare * length(way)));
    if (gap.state == State::Beside) {
        const Vec3d step = normalized(way) * besideReach(gap);
        add(gap.at.as<double>() - step);
        return add(gap.at.as<double>() + step);
    }
    for (size_t k = 1; k < borderParts; ++k) add(low + way * shareOfPart(k));
}

void FaceCreases::takeBorder(const FaceSegment& segment, uint32_t g, size_t sample) {
    Gap& gap = gaps_[g];
    if (gap.state == State::Border) return takeParts(segment, g, sample);
    const bool found = gap.state == State::Below ? takeBelow(segment, gap, sample) : takeBeside(segment, gap, sample);
    if (!found) gap.state = State::Border;
}

/// A little below a border at which two parts stand side by side, the field is the distance to the wall between them,
/// which leads to the border at once. False where it doesn't meet the surface within the bracket.
bool FaceCreases::takeBelow(const FaceSegment& segment, Gap& gap, size_t sample) {
    float value;
    gap.wall.point = samples_.point(sample, value);
    gap.state = State::Beside;
    gap.looks.beside = 0;
    // The point nearest to it in the plane of the face.
    const int across = segment.axis;
    gap.wall.value = value + gap.wall.point.gradient[across] * (gap.nearA.point.at[across] - gap.wall.point.at[across]);
    gap.wall.point.at[across] = gap.nearA.point.at[across];
    return isKnown(value) && meetWall(segment, gap, {gap.nearA.point, 0});
}

bool FaceCreases::meetWall(const FaceSegment& segment, Gap& gap, const LinearField& surface) const {
    if (!crossInFace(FaceAxes(segment.axis), surface, gap.wall, gap.at)) return false;
    const Vec3d way = (gap.nearB.point.at - gap.nearA.point.at).as<double>();
    const double along = dot((gap.at - gap.nearA.point.at).as<double>(), way);
    return along >= 0 && along <= dot(way, way) && mayLieAt(segment, gap.at);
}

/// Done where the first piece lies on one side and the second on the other, on the surface.
bool FaceCreases::takeBeside(const FaceSegment& segment, Gap& gap, size_t sample) {
    LinearField a, b;
    a.point = samples_.point(sample, a.value), b.point = samples_.point(sample + 1, b.value);
    if (!isKnown(a.value) || !isKnown(b.value) || a.point.label != gap.a.label || b.point.label != gap.b.label)
        return false;
    const double near = besideReach(gap);
    const auto liesOn = [&](const LinearField& f) { return std::abs(f.value) <= near * length(f.point.gradient); };
    if (!liesOn(a) || !liesOn(b)) return ++gap.looks.beside < besideRounds && meetWall(segment, gap, a);
    gap.nearA = a, gap.nearB = b;
    gap.crossing = gap.at;
    gap.state = State::Done;
    return true;
}

/// A point of a border's bracket, on the surface where that is at most so many metres away; on the line, with the
/// piece before it, where the field isn't known. Whether its piece may reach the surface in the face: in seams inside
/// the solid pieces show that don't.
std::pair<PiecePoint, bool> FaceCreases::inBracket(const FaceSegment& segment, const PiecePoint& before, double most,
                                                   size_t sample) const {
    float value;
    PiecePoint point = samples_.point(sample, value);
    if (!isKnown(value)) {
        const Vec3f at = point.at;
        point = before;
        point.at = at;
        return {point, false};
    }
    const FaceAxes plane(segment.axis);
    const double slope = plane.length(point.gradient);
    if (std::abs(value) <= most * slope) moveInFace(plane, point, value);
    return {point, std::abs(value) <= 2 * grid_->cell_m * slope};
}

/// The bracket becomes that part of itself where the first piece ends.
void FaceCreases::takeParts(const FaceSegment& segment, uint32_t g, size_t sample) {
    Gap& gap = gaps_[g];
    const double bracket = length((gap.nearB.point.at - gap.nearA.point.at).as<double>());
    const bool isWide = bracket > mergedShare * grid_->cell_m;  // else the breaks beside a third piece become one
    // Where a step lies between parallel planes a third piece tells so, whether or not it reaches the surface here.
    const bool areParallel = dot(normalized(gap.a.gradient), normalized(gap.b.gradient)) > parallelCosine;
    for (size_t k = 1; k < borderParts; ++k) {
        const double most = shareOfPart(std::min(k, borderParts - k)) * bracket;
        const auto [point, mayCross] = inBracket(segment, gap.nearA.point, most, sample + k - 1);
        if (point.label == gap.a.label) {
            gap.nearA.point = point;
            continue;
        }
        const bool isThird = point.label != gap.b.label && (mayCross || areParallel);
        if (isThird && gap.splits < mostSplits && isWide && mayLieAt(segment, point.at)) return split(g, point);
        if (point.label == gap.b.label)
            gap.nearB.point = point;
        else
            gap.nearB.point.at = point.at;
        break;
    }
    if (++gap.rounds < borderRounds) {
        if (gap.looks.below > 0) --gap.looks.below, gap.state = State::Below;
        return;
    }
    const Vec3f found = between(gap.nearA.point.at, gap.nearB.point.at, 0.5);
    const bool isInside = mayLieAt(segment, found);
    gap.at = isInside ? found : onLine(gap.a.at, gap.b.at, found);
    if (!gap.leaves) gap.crossing = found, gap.leaves = !isInside;
    gap.state = State::Done;
}

}  // namespace sgm::mesh
