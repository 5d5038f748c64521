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
    : origin_(origin),
      direction_(direction),
      inverse_(inverseOf(direction)),
      tolerance_(2e-6f * space.size),
      angle_(0.1f * pixelAngle),
      pixelAngle_(pixelAngle),
      beside_(ray.beside) {
    const auto [near, far] = space.span(origin, inverse_);
    t_ = freeBeside_ = std::max(near, ray.start);
    end_ = far;
}

void SphereTracer::settleDoubt() {
    doubted_ = false;
    if (probe_.found()) {
        found_ = candidate_;
        ended_ = true;
        return;
    }
    t_ += std::max(2 * gap(t_), 2 * tolerance_);
    free_ = stride_ = 0;
    slope_ = -1;
}

void SphereTracer::setFree(float from, float to) {
    if (from <= freeBeside_ + gap(from)) freeBeside_ = std::max(freeBeside_, to);
}

bool SphereTracer::ask(const CellSpace& space, Question& question) {
    if (doubted_) {
        if (probe_.ask(space, question)) return true;
        settleDoubt();
    }
    for (; !ended_ && steps_ < 512 && t_ + stride_ <= end_; ++steps_) {
        const Vec3f place = origin_ + (t_ + stride_) * direction_;
        if (!cell_.holds(place)) cell_ = space.cellAt(place);
        if (cell_.least > 0 && stride_ <= free_ + cell_.least * space.inverseLipschitz) {
            t_ += stride_;
            while (cell_.least > 0 && t_ <= end_) {
                const float from = t_;
                t_ += cell_.exit(origin_ + t_ * direction_, inverse_);
                const float spare =
                    cell_.least * space.inverseLipschitz - beside_ * t_;  // of a ball about any of the way
                if (spare >= 0) setFree(from - spare, t_);
                cell_ = space.cellAt(origin_ + t_ * direction_);
            }
            free_ = stride_ = 0;
            slope_ = -1;
            if (t_ > end_) break;
        }
        if (cell_.state == CellState::Near) {
            question = {origin_ + (t_ + stride_) * direction_, cell_.tape};
            ++steps_;
            angle_ = std::min(angle_ + 0.015f * pixelAngle_, 0.3f * pixelAngle_);
            return true;
        }
        answer(space, cell_.state == CellState::Inside ? -space.margin : space.margin);
    }
    return false;
}

void SphereTracer::answer(const CellSpace& space, float value) {
    if (doubted_) return probe_.answer(space, value);
    const float next = value * space.inverseLipschitz;
    if (stride_ > free_ + std::abs(next) + gap(t_) && stride_ > 0) {  // back to the safe step
        stride_ = free_;
        slope_ = -1;
        return;
    }
    if (stride_ > 0) slope_ += 0.4f * ((next - free_) / stride_ - slope_);
    t_ += stride_;
    if (value < std::max(tolerance_, angle_ * t_)) {  // one more safe step, or back out by the secant
        candidate_ = std::max(t_ + (next < 0 && stride_ > 0 ? stride_ * next / (free_ - next) : next), 0.0f);
        const float into = std::max(tolerance_, 0.05f * pixelAngle_ * t_);
        doubted_ = cell_.doubtful && value > -0.25f * into;
        if (doubted_) return probe_.begin(origin_ + t_ * direction_, value, into, direction_);
        found_ = candidate_;
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
    : place_(place),
      direction_(direction),
      inverse_(inverseOf(direction)),
      radius_(radius),
      pixel_(pixel),
      into_(std::max(4e-6f * space.size, 0.05f * pixel)) {
    const auto [near, far] = space.span(place, inverse_);
    start_ = t_ = std::max(near, 3e-4f * space.size);
    end_ = far;
}

bool DiscWalk::settleDoubt() {
    probing_ = false;
    if (careful_) {
        if (probe_.found()) clearance_ = std::min(clearance_, probedClearance_);
        return true;
    }
    doubtful_ = false;
    if (probe_.found()) return true;
    careful_ = true;
    t_ = start_;
    clearance_ = 1;
    within_ = free_ = stride_ = 0;
    steps_ = 0;
    return false;
}

void DiscWalk::doubt(Vec3f place, float value, float clearance) {
    if (careful_) {
        probe_.begin(place, value, into_);
        probedClearance_ = clearance;
        probing_ = true;
        return;
    }
    clearance_ = clearance;
    doubtful_ = true;
    leastPlace_ = place;
    leastValue_ = value;
}

bool DiscWalk::ask(const CellSpace& space, Question& question) {
    for (;;) {
        if (probing_) {
            if (probe_.ask(space, question)) return true;
            settleDoubt();
        }
        for (; steps_ < 128 && t_ + stride_ <= end_ && clearance_ > -0.9f; ++steps_) {
            const Vec3f place = place_ + (t_ + stride_) * direction_;
            if (!cell_.holds(place)) cell_ = space.cellAt(place);
            // Nothing of the cell comes into the disc.
            if (cell_.least >= space.margin || cell_.least >= radius_ * (t_ + stride_ + 2 * cell_.edge)) {
                t_ += stride_ + cell_.exit(place, inverse_);
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
        if (!doubtful_) return false;
        probe_.begin(leastPlace_, leastValue_, into_);
        probing_ = true;
    }
}

void DiscWalk::answer(const CellSpace& space, float value) {
    if (probing_) return probe_.answer(space, value);
    const float next = std::abs(value) * space.inverseLipschitz;
    const float disc = std::min(radius_ * (t_ + stride_), space.margin),
                least = std::max(0.5f * disc, std::max(1e-3f * space.size, disc < pixel_ ? 1.4f * pixel_ : 0));
    if (stride_ > std::max(free_ + next, least)) {
        stride_ = std::max(free_, least);
        return;
    }
    if (value / disc < clearance_) {
        if (cell_.doubtful && value > -0.25f * into_) {
            doubt(place_ + (t_ + stride_) * direction_, value, value / disc);
        } else {
            clearance_ = value / disc;
            doubtful_ = false;
        }
    }
    // Inside, fields may fall little however deep the place is. Where nobody sees the penumbra, a way through the solid
    // counts as half as much depth.
    within_ = value < 0 ? within_ + stride_ : 0;
    if (value < 0 && disc < pixel_ && -0.5f * within_ / disc < clearance_) {
        clearance_ = -0.5f * within_ / disc;
        doubtful_ = false;
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
