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

DiscWalk::DiscWalk(const CellSpace& space, Vec3f place, Vec3f direction, float radius, float pixel)
    : line_{place, direction, inverseOf(direction)},
      radius_(radius),
      pixel_(pixel),
      into_(std::max(4e-6f * space.size, 0.05f * pixel)) {
    const auto [near, far] = space.span(place, line_.inverse);
    start_ = t_ = std::max(near, 3e-4f * space.size);
    end_ = far;
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
    t_ = start_;
    clearance_ = 1;
    within_ = free_ = stride_ = 0;
    steps_ = 0;
    return false;
}

void DiscWalk::doubt(Vec3f place, float value, float clearance) {
    if (doubts_.careful) {
        doubts_.probe.begin(place, value, into_);
        doubts_.probedClearance = clearance;
        doubts_.probing = true;
        return;
    }
    clearance_ = clearance;
    doubts_.any = true;
    doubts_.leastPlace = place;
    doubts_.leastValue = value;
}

bool DiscWalk::ask(const CellSpace& space, Question& question) {
    for (;;) {
        if (doubts_.probing) {
            if (doubts_.probe.ask(space, question)) return true;
            settleDoubt();
        }
        for (; steps_ < 128 && t_ + stride_ <= end_ && clearance_ > -0.9f; ++steps_) {
            const Vec3f place = line_.origin + (t_ + stride_) * line_.direction;
            if (!cell_.holds(place)) cell_ = space.cellAt(place);
            // Nothing of the cell comes into the disc.
            if (cell_.least >= space.margin || cell_.least >= radius_ * (t_ + stride_ + 2 * cell_.edge)) {
                t_ += stride_ + cell_.exit(place, line_.inverse);
                free_ = stride_ = 0;
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
        doubts_.probe.begin(doubts_.leastPlace, doubts_.leastValue, into_);
        doubts_.probing = true;
    }
}

void DiscWalk::answer(const CellSpace& space, float value) {
    if (doubts_.probing) return doubts_.probe.answer(space, value);
    const float next = std::abs(value) * space.inverseLipschitz;
    const float disc = std::min(radius_ * (t_ + stride_), space.margin),
                least = std::max(0.5f * disc, std::max(1e-3f * space.size, disc < pixel_ ? 1.4f * pixel_ : 0));
    if (stride_ > std::max(free_ + next, least)) {
        stride_ = std::max(free_, least);
        return;
    }
    if (value / disc < clearance_) {
        if (cell_.doubtful && value > -0.25f * into_) {
            doubt(line_.origin + (t_ + stride_) * line_.direction, value, value / disc);
        } else {
            clearance_ = value / disc;
            doubts_.any = false;
        }
    }
    // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the solid
    // counts as half as much depth.
    within_ = value < 0 ? within_ + stride_ : 0;
    if (value < 0 && disc < pixel_ && -0.5f * within_ / disc < clearance_) {
        clearance_ = -0.5f * within_ / disc;
        doubts_.any = false;
    }
    t_ += stride_;
    free_ = next;
    stride_ = std::max(free_ > 2 * disc ? 1.5f * free_ : 0.9f * free_, least);
}

float DiscWalk::seen() const {
    const float c = std::clamp(0.5f + 0.5f * clearance_, 0.0f, 1.0f);
    return c * c * (3 - 2 * c);
}

}  // namespace sgm::render
