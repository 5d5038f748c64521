// Small values of the field that are in doubt: solid is looked for behind them.
#include <cmath>

#include "viewer/render/sphere_tracer.h"

namespace sgm::render {

void SolidProbe::begin(Vec3f place, float value, float into, Vec3f direction) {
    const bool ray = dot(direction, direction) > 0;
    place_ = place;
    value_ = value;
    into_ = into;
    step_ = ray ? alongRay : 0;
    round_ = 0;
    foot_ = place + direction * (std::max(value, 0.0f) + into);
    slope_ = {};
    running_ = true;
    found_ = false;
}

bool SolidProbe::ask(const CellSpace& space, Question& question) {
    while (running_) {
        Vec3f place = foot_;
        if (step_ >= 0 && step_ < atFoot) {
            place = place_;
            place[step_] += into_;
        }
        if (!cell_.holds(place)) cell_ = space.cellAt(place);
        if (cell_.state == CellState::Near) {
            question = {place, cell_.tape};
            return true;
        }
        answer(space, cell_.state == CellState::Inside ? -space.margin : space.margin);
    }
    return false;
}

/// No field falls less than a quarter as fast as a distance.
static constexpr float slightest = 0.25f;

/// A step of Newton's, and a little more.
void SolidProbe::findFoot() {
    const float steep = length(slope_);
    const Vec3f up = slope_ / std::max(steep, 1e-6f);
    foot_ = place_ - up * ((value_ + into_) / std::max(steep, slightest));
}

void SolidProbe::answer(const CellSpace&, float value) {
    if (step_ >= 0 && step_ < atFoot) {
        slope_[step_] = (value - value_) / into_;
        if (++step_ == atFoot) findFoot();
        return;
    }
    found_ = value < -0.25f * into_;
    if (step_ == atFoot) {
        place_ = foot_;
        value_ = value;
        ++round_;
    }
    step_ = 0;
    running_ = !found_ && round_ < rounds;
}

ClearanceWalk::ClearanceWalk(const CellSpace& space, Vec3f place, float value, float enough, float pixel)
    : place_(place),
      value_(value),
      enough_(enough),
      into_(std::max(4e-6f * space.size, 0.05f * pixel)),
      depth_(enough) {}

Vec3f ClearanceWalk::placeOfStep() const {
    Vec3f place = place_;
    if (step_ < firstBehind) {
        place[step_] += into_;
        return place;
    }
    const float steep = length(slope_);
    const Vec3f up = slope_ / std::max(steep, 1e-6f);
    return step_ < aside ? place - up * (value_ / std::max(steep, slightest) + depth_)
                         : place + up * (enough_ - value_);
}

bool ClearanceWalk::ask(const CellSpace& space, Question& question) {
    while (step_ <= aside && open_ > 0) {
        const Vec3f place = placeOfStep();
        if (!cell_.holds(place)) cell_ = space.cellAt(place);
        if (cell_.state == CellState::Near) {
            question = {place, cell_.tape};
            return true;
        }
        answer(space, cell_.state == CellState::Inside ? -space.margin : space.margin);
    }
    return false;
}

void ClearanceWalk::answer(const CellSpace&, float value) {
    if (step_ < firstBehind)
        slope_[step_] = (value - value_) / into_;
    else if (step_ == aside)
        value_ += shareOfPart(open_) * (std::max(value_, std::min(value, enough_)) - value_);
    else {
        open_ = std::min(open_, std::max(2 * value / depth_, 0.0f));
        depth_ *= 0.5f;
    }
    ++step_;
}

}  // namespace sgm::render
