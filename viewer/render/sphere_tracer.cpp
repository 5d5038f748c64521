#include "viewer/render/sphere_tracer.h"

#include <cmath>

namespace sgm::render {

Vec3f inverseOf(Vec3f direction) {
    const auto one = [](float d) { return 1 / (std::abs(d) < 1e-9f ? 1e-9f : d); };
    return {one(direction.x), one(direction.y), one(direction.z)};
}

float Cell::exit(Vec3f p, Vec3f inverseDirection) const {
    const auto far = [&](int axis) {
        const float a = (low[axis] - p[axis]) * inverseDirection[axis],
                    b = (low[axis] + edge - p[axis]) * inverseDirection[axis];
        return std::max(a, b);
    };
    return std::max(std::min({far(0), far(1), far(2)}), 0.0f) + edge * 1e-3f;
}

Cell CellSpace::cellAt(Vec3f p) const {
    constexpr int finest = 1 << (2 * CellTree::surfaceDepth);
    const CellTree& tree = field.tree;
    Vec3i q;  // in finest cells
    for (int axis = 0; axis < 3; ++axis)
        q[axis] = std::clamp(static_cast<int>((p[axis] - tree.low[axis]) * finestPerMetre), 0, finest - 1);
    uint32_t word = uint32_t(CellState::Node) << 30;
    int shift = 2 * CellTree::surfaceDepth;
    while (CellTree::stateOf(word) == CellState::Node) {
        shift -= 2;
        const auto child = static_cast<size_t>((q.x >> shift & 3) | (q.y >> shift & 3) << 2 | (q.z >> shift & 3) << 4);
        word = tree.nodes[size_t(CellTree::indexOf(word)) * 64 + child];
    }
    const float unit = tree.edge / finest;
    const Vec3f low{static_cast<float>(q.x >> shift << shift), static_cast<float>(q.y >> shift << shift),
                    static_cast<float>(q.z >> shift << shift)};
    Cell cell{CellTree::stateOf(word), 0, tree.low + low * unit, static_cast<float>(1 << shift) * unit, 0};
    if (side < 0 && cell.state != CellState::Near)
        cell.state = cell.state == CellState::Inside ? CellState::Outside : CellState::Inside;
    cell.least = cell.state == CellState::Outside ? margin : -margin;
    if (cell.state == CellState::Near) {
        cell.tape = CellTree::indexOf(word);
        cell.least = side > 0 ? tree.ranges[cell.tape].lo : -tree.ranges[cell.tape].hi;
        cell.doubtful = tree.doubts[cell.tape] & (side > 0 ? DoubtfulOutside : DoubtfulInside);
    }
    return cell;
}

std::array<float, 2> CellSpace::span(Vec3f origin, Vec3f inverseDirection) const {
    float near = 0, far = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (field.box.lo[axis] - origin[axis]) * inverseDirection[axis],
                    b = (field.box.hi[axis] - origin[axis]) * inverseDirection[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return {near, far};
}

SphereTracer::SphereTracer(const CellSpace& space, Vec3f origin, Vec3f direction, float pixelAngle, const Ray& ray)
    : line_{origin, direction, inverseOf(direction)},
      precision_{2e-6f * space.size, 0.1f * pixelAngle, pixelAngle},
      beside_(ray.beside) {
    const auto [near, far] = space.span(origin, line_.inverse);
    t_ = freeBeside_ = std::max(near, ray.start);
    end_ = far;
}

void SphereTracer::settleDoubt() {
    doubt_.active = false;
    if (doubt_.probe.found()) {
        found_ = doubt_.candidate;
        ended_ = true;
        return;
    }
    t_ += std::max(2 * gap(t_), 2 * precision_.tolerance);
    free_ = stride_ = 0;
    slope_ = -1;
}

void SphereTracer::setFree(float from, float to) {
    if (from <= freeBeside_ + gap(from)) freeBeside_ = std::max(freeBeside_, to);
}

bool SphereTracer::ask(const CellSpace& space, Question& question) {
    if (doubt_.active) {
        if (doubt_.probe.ask(space, question)) return true;
        settleDoubt();
    }
    for (; !ended_ && steps_ < 512 && t_ + stride_ <= end_; ++steps_) {
        const Vec3f place = line_.origin + (t_ + stride_) * line_.direction;
        if (!cell_.holds(place)) cell_ = space.cellAt(place);
        if (cell_.least > 0 && stride_ <= free_ + cell_.least * space.inverseLipschitz) {
            t_ += stride_;
            while (cell_.least > 0 && t_ <= end_) {
                const float from = t_;
                t_ += cell_.exit(line_.origin + t_ * line_.direction, line_.inverse);
                const float spare =
                    cell_.least * space.inverseLipschitz - beside_ * t_;  // of a ball about any of the way
                if (spare >= 0) setFree(from - spare, t_);
                cell_ = space.cellAt(line_.origin + t_ * line_.direction);
            }
            free_ = stride_ = 0;
            slope_ = -1;
            if (t_ > end_) break;
        }
        if (cell_.state == CellState::Near) {
            question = {line_.origin + (t_ + stride_) * line_.direction, cell_.tape};
            ++steps_;
            precision_.angle =
                std::min(precision_.angle + 0.015f * precision_.pixelAngle, 0.3f * precision_.pixelAngle);
            return true;
        }
        answer(space, cell_.state == CellState::Inside ? -space.margin : space.margin);
    }
    return false;
}

void SphereTracer::answer(const CellSpace& space, float value) {
    if (doubt_.active) return doubt_.probe.answer(space, value);
    const float next = value * space.inverseLipschitz;
    if (stride_ > free_ + std::abs(next) + gap(t_) && stride_ > 0) {  // back to the safe step
        stride_ = free_;
        slope_ = -1;
        return;
    }
    if (stride_ > 0) slope_ += 0.4f * ((next - free_) / stride_ - slope_);
    t_ += stride_;
    if (value <
        std::max(precision_.tolerance, precision_.angle * t_)) {  // one more safe step, or back out by the secant
        doubt_.candidate = std::max(t_ + (next < 0 && stride_ > 0 ? stride_ * next / (free_ - next) : next), 0.0f);
        const float into = std::max(precision_.tolerance, 0.05f * precision_.pixelAngle * t_);
        doubt_.active = cell_.doubtful && value > -0.25f * into;
        if (doubt_.active) return doubt_.probe.begin(line_.origin + t_ * line_.direction, value, into, line_.direction);
        found_ = doubt_.candidate;
        ended_ = true;
        return;
    }
    free_ = next;
    const float aside = beside_ * (t_ + free_);
    if (free_ > aside) {
        const float half = std::sqrt(free_ * free_ - aside * aside);
        setFree(t_ - half, t_ + half);
    }
    stride_ = std::max(free_, (2 * free_ + gap(t_)) / (1 - std::min(slope_, 0.6f)));
    if (t_ + stride_ > end_) stride_ = free_;  // the long step would leave the box, perhaps past a last surface
}

DiscWalk::DiscWalk(const CellSpace& space, Vec3f place, Vec3f direction, float radius, float pixel, Of of, float from)
    : line_{place, direction, inverseOf(direction)},
      look_{radius, pixel, std::max(4e-6f * space.size, 0.05f * pixel), of == Of::Part ? 0.05f : hidden, of != Of::Sky},
      soft_(of == Of::Part) {
    const auto [near, far] = space.span(place, line_.inverse);
    start_ = t_ = std::max({near, 3e-4f * space.shownSize(pixel), from});
    end_ = far;
}

void DiscWalk::restart() {
    t_ = start_;
    clearance_ = 1;
    within_ = 0;
    pace_ = {};
    steps_ = 0;
    freeUntil_ = -1;
    soft_ = look_.dark > 0;
    passed_ = {};
    turn_ = {};
}

bool DiscWalk::settleDoubt() {
    doubts_.probing = false;
    if (doubts_.careful) {
        if (doubts_.probe.found()) clearance_ = std::min(clearance_, doubts_.probedClearance);
        return true;
    }
    doubts_.any = false;
    if (doubts_.probe.found()) return true;
    doubts_.careful = true;
    restart();
    return false;
}

void DiscWalk::doubt(Vec3f place, float value, float clearance) {
    if (doubts_.careful) {
        doubts_.probe.begin(place, value, look_.into);
        doubts_.probedClearance = clearance;
        doubts_.probing = true;
        return;
    }
    clearance_ = clearance;
    doubts_.any = true;
    doubts_.leastPlace = place;
    doubts_.leastValue = value;
}

/// Radius of the circle in which two spheres meet whose centres lie `apart`; 0 where they don't. Nothing comes nearer
/// to the way between than that where both are free, and an edge that both touch lies just there.
static float meetingRadius(float a, float b, float apart) {
    const float along = (apart * apart + a * a - b * b) / (2 * apart);
    if (along <= 0 || along >= apart) return std::min(a, b);
    return std::sqrt(std::max(a * a - along * along, 0.0f));
}

bool DiscWalk::sawAll(float next, float matters_m) const {
    return pace_.stride <= pace_.free ||
           (pace_.stride < pace_.free + next && meetingRadius(pace_.free, next, pace_.stride) >= matters_m);
}

bool DiscWalk::ask(const CellSpace& space, Question& question) {
    for (;;) {
        if (doubts_.probing) {
            if (doubts_.probe.ask(space, question)) return true;
            settleDoubt();
        }
        for (; steps_ < 128 && t_ + pace_.stride <= end_ && (clearance_ > look_.dark || doubts_.any); ++steps_) {
            const Vec3f place = line_.origin + (t_ + (turn_.active ? turn_.along : pace_.stride)) * line_.direction;
            if (!cell_.holds(place)) cell_ = space.cellAt(place);
            if (turn_.active && cell_.state != CellState::Near) {
                answer(space, cell_.state == CellState::Inside ? -space.margin : space.margin);
                continue;
            }
            // Nothing of the cell comes into the disc, or nearer to its middle than what did before.
            const float near = std::min(matters() * look_.radius * (t_ + pace_.stride + 2 * cell_.edge), space.margin);
            if (cell_.least >= near && !turn_.active) {
                // From within solid the way leads out of it, and shorter strides would only come near its surface.
                if (passed_.value >= 0 && !sawAll(cell_.least * space.inverseLipschitz, near)) {
                    pace_.stride = 0.9f * pace_.free;
                    continue;
                }
                t_ += pace_.stride + cell_.exit(place, line_.inverse);
                pace_ = {};
                passed_ = {};
                continue;
            }
            if (cell_.state == CellState::Near) {
                question = {place, cell_.tape};
                ++steps_;
                return true;
            }
            answer(space, -space.margin);
        }
        if (!doubts_.any) return false;
        doubts_.probe.begin(doubts_.leastPlace, doubts_.leastValue, look_.into);
        doubts_.probing = true;
    }
}

bool DiscWalk::turnsBack(float value, float disc) {
    if (!look_.sharp || turn_.tried || cell_.doubtful || disc < look_.pixel || passed_.value <= 0 ||
        passed_.value > clearance_ * disc || passed_.value >= std::min(passed_.before, value))
        return false;
    // The vertex of a parabola through the last three values.
    const float before = (passed_.before - passed_.value) / passed_.stride,
                after = (value - passed_.value) / pace_.stride,
                bend = (before + after) / (passed_.stride + pace_.stride);
    turn_ = {true, true, 0.5f * (pace_.stride - after / bend), value};
    return true;
}

void DiscWalk::answer(const CellSpace& space, float value) {
    if (doubts_.probing) return doubts_.probe.answer(space, value);
    if (turn_.active) {
        turn_.active = false;
        const float between = value / std::min(look_.radius * t_, space.margin);
        if (!cell_.doubtful && between < clearance_) {
            clearance_ = between;
            doubts_.any = false;
        }
        value = turn_.ahead;
    }
    const float next = std::abs(value) * space.inverseLipschitz;
    const float disc = std::min(look_.radius * (t_ + pace_.stride), space.margin),
                least = std::max((look_.sharp ? 0.25f : 0.5f) * disc,
                                 std::max((look_.sharp ? 2e-4f : 1e-3f) * space.shownSize(look_.pixel),
                                          disc < look_.pixel ? 1.4f * look_.pixel : 0));
    const bool sure = !cell_.doubtful || value <= -0.25f * look_.into;
    if (look_.dark > 0 && sure && value < 0) {  // of a part no more is asked
        clearance_ = 0;
        doubts_.any = false;
        return;
    }
    if (pace_.stride > least && !(value < 0 ? pace_.stride <= pace_.free + next : sawAll(next, matters() * disc))) {
        pace_.stride = std::max(0.9f * pace_.free, least);
        pace_.slope = -1;
        return;
    }
    if (turnsBack(value, disc)) return;
    turn_.tried = false;
    if (value < disc) {
        if (freeUntil_ < 0) freeUntil_ = t_;
        soft_ |= disc >= look_.pixel;
    }
    if (value / disc < clearance_) {
        if (!sure) {
            doubt(line_.origin + (t_ + pace_.stride) * line_.direction, value, value / disc);
        } else {
            clearance_ = value / disc;
            doubts_.any = false;
        }
    }
    // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the solid
    // counts as half as much depth.
    within_ = value < 0 ? within_ + pace_.stride : 0;
    if (value < 0 && disc < look_.pixel && -0.5f * within_ / disc < clearance_) {
        clearance_ = -0.5f * within_ / disc;
        doubts_.any = false;
    }
    passed_ = {value, passed_.value, pace_.stride};
    pace_.slope = pace_.stride > 0 ? (next - pace_.free) / pace_.stride : -1;
    t_ += pace_.stride;
    pace_.free = next;
    pace_.stride = std::max(
        pace_.free > 2 * matters() * disc ? 1.6f * pace_.free / (1 - std::min(pace_.slope, 0.5f)) : 0.9f * pace_.free,
        least);
    if (t_ + pace_.stride > end_) pace_.stride = std::max(0.9f * pace_.free, least);  // perhaps past a last surface
}

float shareOfDisc(float clearance) { return shareOfPart(0.5f + 0.5f * clearance); }

float shareOfPart(float clearance) {
    const float c = std::clamp(clearance, 0.0f, 1.0f);
    return c * c * (3 - 2 * c);
}

std::array<Vec3f, DiscWalk::parts> directionsOfParts(Vec3f middle, float radius) {
    const Vec3f u = normalized(cross(middle, Vec3f{0, 1, 0})), v = cross(u, middle);
    std::array<Vec3f, DiscWalk::parts> directions;
    for (int k = 0; k < DiscWalk::parts; ++k) {
        const float turn = 2.0943951f * static_cast<float>(k), offset = DiscWalk::partOffset * radius;
        directions[size_t(k)] = normalized(middle + u * (offset * std::cos(turn)) + v * (offset * std::sin(turn)));
    }
    return directions;
}

}  // namespace sgm::render
