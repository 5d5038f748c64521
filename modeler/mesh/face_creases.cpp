#include "modeler/mesh/face_creases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "modeler/mesh/face_axes.h"
#include "modeler/mesh/region.h"

namespace sgm::mesh {
namespace {

constexpr int probeRounds = 8;  ///< times that both sides of a crease are looked at
/// Of the way from a crossing to either end: farther than `probeShare` a piece is looked at where the other one is
/// found nearer, for the tangents of round pieces cross beyond their crease.
constexpr float farthestProbe = 0.8f;
constexpr float bulgeShare = 0.25f;  ///< of the way to an end: how far its piece may be from it
float fartherThan(float share) { return std::min(4 * share, 0.5f + 0.5f * share); }
constexpr float settledShare = 1e-4f;       ///< of a cell, within which a crease point may still move
constexpr float endMargin = 0x1.0p-12f;     ///< of a segment, kept free of breaks at its ends
constexpr double monotoneShare = 0x1.0p-6;  ///< of a segment, between breaks
constexpr float faceMargin = 0x1.0p-7f;     ///< of a cell, kept free of breaks at the sides of a face
constexpr float thirdShare = 0.5f;          ///< of the field expected outside a third piece: how far it may be off
constexpr float leastToOther = 0.99f;       ///< cosine of a side that may show with the other piece's derivative
constexpr float mostToOwn = 0.95f;          ///< and to the derivative at its own end

/// Whether a point looked at on the way to `end` lies near that one's piece, on the same side of it: within the solid,
/// in seams between parts and in thin sheets, a piece shows with its derivative turned round.
bool isNearPiece(const PiecePoint& point, float value, const PiecePoint& end) {
    return point.label == end.label && dot(point.gradient, end.gradient) > 0 &&
           std::abs(value) <= bulgeShare * length(point.gradient) * length(end.at - point.at);
}

/// Whether a side of a break may show with the derivative of the piece across it.
bool mayShowOther(Vec3f side, Vec3f own, Vec3f other) {
    const Vec3f n = normalized(side);
    return dot(n, normalized(other)) > leastToOther && dot(n, normalized(own)) < mostToOwn;
}

/// Whether each break lies farther along the segment than the one before: then the way over them can't cross itself.
bool isMonotone(const FaceSegment& segment, std::span<const Break> breaks) {
    const Vec3d from = segment.ends[0].at.as<double>(), way = segment.ends[1].at.as<double>() - from;
    double last = 0;
    for (const Break& at : breaks) {
        const double share = dot(at.at.as<double>() - from, way) / dot(way, way);
        if (!(share >= last + monotoneShare)) return false;
        last = share;
    }
    return last + monotoneShare <= 1;
}

/// Whether the breaks are where their pieces cross, and the polyline over them turns both ways, as below a ledge, and
/// is simple. Around a corner it turns one way: there breaks have to move with the corner.
bool isZigzag(const FaceSegment& segment, std::span<const Break> breaks) {
    const FaceAxes axes(segment.axis);
    std::vector<FacePoint> points;
    const auto add = [&](Vec3f p) { points.push_back({p[axes.u], p[axes.v]}); };
    add(segment.ends[0].at);
    for (const Break& at : breaks) {
        if (at.at != at.crossing) return false;
        add(at.at);
    }
    add(segment.ends[1].at);
    return turnsBothWays(points) && isSimple(points);
}

}  // namespace

uint64_t FaceCreases::solve(const BlockTapes& tapes, const Grid& grid, eval::Workspace& workspace,
                            std::vector<FaceSegment>& segments, size_t first) {
    grid_ = &grid, tapes_ = tapes;
    limit_ = surfaceReach(*tapes.whole, grid);
    gaps_.clear(), open_.clear();
    if (first == 0) breaks_.clear();
    for (auto s = static_cast<uint32_t>(first); s < segments.size(); ++s) {
        Gap gap;
        gap.segment = s;
        gap.a = segments[s].ends[0], gap.b = segments[s].ends[1];
        gap.nearA.value = segments[s].values[0], gap.nearB.value = segments[s].values[1];
        takeEnds(segments[s], gap, gap.a, gap.b);
        open_.push_back(static_cast<uint32_t>(gaps_.size()));
        gaps_.push_back(gap);
    }
    uint64_t evaluations = solveOpen(segments, workspace);
    evaluations += confirmCrossings(segments, workspace);
    evaluations += searchSmoothBorders(segments, workspace);
    evaluations += lookBesideTies(segments, workspace);
    separate(segments, first);
    return evaluations;
}

/// Looks at the open gaps until none is left. Returns how often the field was evaluated.
uint64_t FaceCreases::solveOpen(const std::vector<FaceSegment>& segments, eval::Workspace& workspace) {
    uint64_t evaluations = 0;
    std::vector<size_t> first;  // sample of each open gap
    while (!open_.empty()) {
        samples_.clear(), first.clear();
        for (const uint32_t g : open_) {
            first.push_back(samples_.size());
            ask(segments[gaps_[g].segment], gaps_[g]);
        }
        evaluations += samples_.size();
        samples_.evaluate(workspace);
        next_.clear();
        for (size_t i = 0; i < open_.size(); ++i) {
            const uint32_t g = open_[i];
            take(segments[gaps_[g].segment], g, first[i]);
            if (gaps_[g].state != State::Done) next_.push_back(g);
        }
        open_.swap(next_);
    }
    return evaluations;
}

void FaceCreases::ask(const FaceSegment& segment, const Gap& gap) {
    const auto add = [&](Vec3f p) { samples_.add(tapes_, segment.brick, p); };
    switch (gap.state) {
        case State::Ends:
            add(gap.a.at), add(gap.b.at);
            break;
        case State::Middle:
            add(between(gap.a.at, gap.b.at, 0.5));
            break;
        case State::Third:
            add(gap.wall.point.at);
            break;
        case State::Crease:
            add(between(gap.at, gap.a.at, gap.shares[0])), add(between(gap.at, gap.b.at, gap.shares[1]));
            break;
        default:
            askForBorder(segment, gap);
    }
}

void FaceCreases::take(const FaceSegment& segment, uint32_t gap, size_t sample) {
    switch (gaps_[gap].state) {
        case State::Ends: {
            Gap& split = gaps_[gap];
            const PiecePoint a = samples_.point(sample, split.nearA.value),
                             b = samples_.point(sample + 1, split.nearB.value);
            return takeEnds(segment, split, a, b);
        }
        case State::Middle:
            return takeMiddle(segment, gaps_[gap], sample);
        case State::Third:
            return takeThird(segment, gap, sample);
        case State::Crease:
            return takeProbes(segment, gap, sample);
        default:
            return takeBorder(segment, gap, sample);
    }
}

/// The ends of a gap lie on the surface: their derivatives begin the search.
void FaceCreases::takeEnds(const FaceSegment& segment, Gap& gap, const PiecePoint& a, const PiecePoint& b) {
    gap.nearA.point = a, gap.nearB.point = b;
    gap.nearA.point.label = gap.a.label, gap.nearB.point.label = gap.b.label;
    gap.nearA.point.origin = gap.a.origin, gap.nearB.point.origin = gap.b.origin;
    gap.a.gradient = gap.nearA.point.gradient, gap.b.gradient = gap.nearB.point.gradient;
    aim(segment, gap);
}

/// Goes to where the two pieces' lines cross, or looks for a border where they don't.
void FaceCreases::aim(const FaceSegment& segment, Gap& gap) {
    const bool first = gap.state == State::Ends;
    const Vec3f before = gap.at;
    if (!crossInFace(FaceAxes(segment.axis), gap.nearA, gap.nearB, gap.at)) {
        if (first) projectOntoCrease(gap, between(gap.a.at, gap.b.at, 0.5));
        return searchBorder(gap, first && !gap.leaves);
    }
    gap.crossing = gap.at;
    gap.leaves = false;
    if (!mayLieAt(segment, gap.at)) {
        const bool isFar = !(length(gap.at - gap.a.at) < 2 * grid_->cell_m);
        gap.at = inFace(segment, gap.at);  // where a third piece shows, if one cuts the crease off
        projectOntoCrease(gap, isFar ? between(gap.a.at, gap.b.at, 0.5) : gap.at);
        if (isFar && !first) return searchBorder(gap);
        if (first) {
            gap.state = State::Middle;
            return;
        }
    }
    gap.state = State::Crease;
    if (!first && length(gap.at - before) <= settledShare * grid_->cell_m) gap.state = State::Done;
}

/// Where two pieces cross outside the face, a third one lies between them that may show far from that: as a ridge above
/// a slope that it runs into. Amid the gap its field may be the least below the surface alone, as of parts that touch
/// there: so it is looked at again a little outside the place where it would be the surface.
void FaceCreases::takeMiddle(const FaceSegment& segment, Gap& gap, size_t sample) {
    gap.state = State::Crease;
    const FaceAxes axes(segment.axis);
    float value;
    PiecePoint third = samples_.point(sample, value);
    if (gap.splits >= mostSplits || !isKnown(value) || third.label == gap.a.label || third.label == gap.b.label) return;
    if (!moveInFace(axes, third, value) || !moveAlongLine(segment, third)) return;
    const double slope = axes.length(third.gradient), out = probeShare * double{grid_->cell_m};
    if (!(slope > 0)) return;
    for (const int axis : {axes.u, axes.v}) third.at[axis] += static_cast<float>(out * third.gradient[axis] / slope);
    gap.wall = {third, static_cast<float>(out * slope)};
    gap.state = State::Third;
}

void FaceCreases::takeThird(const FaceSegment& segment, uint32_t g, size_t sample) {
    Gap& gap = gaps_[g];
    gap.state = State::Crease;
    float value;
    PiecePoint third = samples_.point(sample, value);
    if (third.label != gap.wall.point.label || !(std::abs(value - gap.wall.value) < thirdShare * gap.wall.value))
        return;
    if (moveInFace(FaceAxes(segment.axis), third, value) && moveAlongLine(segment, third)) split(g, third);
}

/// Moves a point on a piece along the piece's line to the nearest place inside the face; false where the line misses
/// it.
bool FaceCreases::moveAlongLine(const FaceSegment& segment, PiecePoint& piece) const {
    if (mayLieAt(segment, piece.at)) return true;
    const FaceAxes axes(segment.axis);
    const double way[] = {-static_cast<double>(piece.gradient[axes.v]), static_cast<double>(piece.gradient[axes.u])};
    const FaceRectangle face(*grid_, segment.face, segment.axis);
    const Vec3f low = inFace(segment, face.low), high = inFace(segment, face.high);
    double first = -std::numeric_limits<double>::infinity(), last = -first;
    for (const auto& [axis, step] : {std::pair(axes.u, way[0]), {axes.v, way[1]}}) {
        const double before = static_cast<double>(low[axis]) - static_cast<double>(piece.at[axis]),
                     after = static_cast<double>(high[axis]) - static_cast<double>(piece.at[axis]);
        if (step == 0 && (before > 0 || after < 0)) return false;
        if (step == 0) continue;
        first = std::max(first, std::min(before / step, after / step));
        last = std::min(last, std::max(before / step, after / step));
    }
    if (!(first <= last)) return false;
    const double t = std::clamp(0.0, first, last);
    piece.at[axes.u] += static_cast<float>(t * way[0]), piece.at[axes.v] += static_cast<float>(t * way[1]);
    piece.at = inFace(segment, piece.at);
    return true;
}

/// Both pieces are looked at close to where their lines cross.
void FaceCreases::takeProbes(const FaceSegment& segment, uint32_t g, size_t sample) {
    Gap& gap = gaps_[g];
    ++gap.rounds;
    bool known = true, looksFarther = false;
    for (size_t side = 0; side < 2; ++side) {
        float value;
        const PiecePoint probe = samples_.point(sample + side, value);
        const bool isFar = gap.shares[side] > probeShare;
        const bool isOther = probe.label == (side == 0 ? gap.b : gap.a).label;
        const bool goesOn = isOther && gap.shares[side] < farthestProbe;
        gap.shares[side] = goesOn ? fartherThan(gap.shares[side]) : probeShare;
        looksFarther |= goesOn;
        if (isFar && (!isKnown(value) || !isNearPiece(probe, value, side == 0 ? gap.a : gap.b))) continue;
        if (!isKnown(value)) {
            known = false;
        } else if (probe.label == gap.a.label) {
            gap.nearA = {probe, value};
        } else if (probe.label == gap.b.label) {
            gap.nearB = {probe, value};
        } else if (gap.splits < mostSplits) {
            PiecePoint third = probe;
            if (moveInFace(FaceAxes(segment.axis), third, value) && mayLieAt(segment, third.at)) return split(g, third);
            known = false;
        } else {
            known = false;
        }
    }
    if (!known || gap.rounds >= probeRounds) return searchBorder(gap);
    if (!looksFarther) aim(segment, gap);
}

/// A third piece lies between the two.
void FaceCreases::split(uint32_t g, const PiecePoint& third) {
    const auto added = static_cast<uint32_t>(gaps_.size());
    Gap after;
    after.segment = gaps_[g].segment, after.next = gaps_[g].next;
    Gap& gap = gaps_[g];
    after.splits = gap.splits = static_cast<uint8_t>(gap.splits + 1);
    after.a = third, after.b = gap.b;
    gap.b = third;
    gap.next = static_cast<int32_t>(added);
    gap.state = State::Ends;
    gap.leaves = false;
    gap.rounds = 0;
    gap.shares = after.shares;
    gaps_.push_back(after);
    next_.push_back(added);
}

/// A point may lie in the segment's face, a little away from its sides.
bool FaceCreases::mayLieAt(const FaceSegment& segment, Vec3f p) const { return inFace(segment, p) == p; }

/// The nearest point inside the segment's face.
Vec3f FaceCreases::inFace(const FaceSegment& segment, Vec3f p) const {
    return FaceRectangle(*grid_, segment.face, segment.axis).within(p, faceMargin * grid_->cell_m);
}

/// Within the margin of ties one piece shows with the other's derivative, and so do sides of breaks that lie in it:
/// these are looked at a little farther on the way to their end.
uint64_t FaceCreases::lookBesideTies(const std::vector<FaceSegment>& segments, eval::Workspace& workspace) {
    samples_.clear();
    std::vector<std::pair<uint32_t, size_t>> sides;  // a gap and its side
    for (uint32_t g = 0; g < gaps_.size(); ++g) {
        const Gap& gap = gaps_[g];
        for (size_t side = 0; side < 2; ++side) {
            const PiecePoint &own = side == 0 ? gap.a : gap.b, &other = side == 0 ? gap.b : gap.a;
            const Vec3f shown = (side == 0 ? gap.nearA : gap.nearB).point.gradient;
            if (!mayShowOther(shown, own.gradient, other.gradient)) continue;
            sides.emplace_back(g, side);
            samples_.add(tapes_, segments[gap.segment].brick, between(gap.at, own.at, probeShare));
        }
    }
    samples_.evaluate(workspace);
    for (size_t i = 0; i < sides.size(); ++i) {
        Gap& gap = gaps_[sides[i].first];
        const bool isFirst = sides[i].second == 0;
        float value;
        const PiecePoint seen = samples_.point(i, value);
        if (seen.label != (isFirst ? gap.a : gap.b).label || !isKnown(value)) continue;
        (isFirst ? gap.nearA : gap.nearB) = {seen, value};
    }
    return sides.size();
}

/// Pieces between breaks that coincide go; where a segment's way crosses itself, or another segment shares its face,
/// the breaks stay on the line between its ends.
void FaceCreases::separate(std::vector<FaceSegment>& segments, size_t first) {
    for (size_t s = first; s < segments.size(); ++s) {
        chain_.clear();
        const auto begin = static_cast<int32_t>(s - first);  // the gaps of the segments came first, in their order
        for (int32_t g = begin; g >= 0; g = gaps_[static_cast<size_t>(g)].next) {
            const Gap& gap = gaps_[static_cast<size_t>(g)];
            if (chain_.empty() && g == begin) segments[s].ends[0].gradient = gap.a.gradient;
            segments[s].ends[1].gradient = gap.b.gradient;
            const bool crosses = gap.leaves || mayLieAt(segments[s], gap.crossing);
            Break next{gap.at, crosses ? gap.crossing : gap.at, {onSurface(gap.nearA), onSurface(gap.nearB)}};
            if (!chain_.empty() && length(chain_.back().at - gap.at) < mergedShare * grid_->cell_m) {
                next.sides[0] = chain_.back().sides[0];
                next.crossing = next.at;
                chain_.pop_back();
                if (next.sides[0].label == next.sides[1].label) continue;
            }
            chain_.push_back(next);
        }
        arrange(segments[s]);
        segments[s].firstBreak = static_cast<uint32_t>(breaks_.size());
        segments[s].breaks = static_cast<uint32_t>(chain_.size());
        breaks_.insert(breaks_.end(), chain_.begin(), chain_.end());
    }
}

void FaceCreases::arrange(const FaceSegment& segment) {
    const Vec3f a = segment.ends[0].at, b = segment.ends[1].at;
    const size_t n = chain_.size();
    if (!segment.alone || (n > 1 && !isMonotone(segment, chain_) && !isZigzag(segment, chain_))) {
        for (size_t k = 0; k < n; ++k)
            chain_[k].at = between(a, b, static_cast<double>(k + 1) / static_cast<double>(n + 1));
    } else {
        const float least = endMargin * grid_->cell_m;
        for (Break& at : chain_)
            if (std::min(length(at.at - a), length(at.at - b)) < least)
                at.at = between(at.at, between(a, b, 0.5), 2 * endMargin);
    }
    const FaceRectangle face(*grid_, segment.face, segment.axis);
    for (Break& at : chain_) at.at = face.offSides(at.at);
}

}  // namespace sgm::mesh
