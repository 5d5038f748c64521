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
    slope_ = away_ = {};
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

/// A step of Newton's, and a little more; no field falls less than a quarter as fast as a distance.
void SolidProbe::findFoot() {
    const float steep = length(slope_);
    const Vec3f up = slope_ / std::max(steep, 1e-6f);
    if (round_ == 0) away_ = up;
    foot_ = place_ - up * ((value_ + into_) / std::max(steep, 0.25f));
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
    : place_(place), value_(value), enough_(enough) {
    probe_.begin(place, value, std::max(4e-6f * space.size, 0.05f * pixel));
}

/// What is near beside the place shows a little farther away from where no surface was found.
bool ClearanceWalk::ask(const CellSpace& space, Question& question) {
    if (ended_ || probe_.ask(space, question)) return !ended_;
    ended_ = true;
    if (probe_.found()) return false;
    const Vec3f place = place_ + probe_.away() * (enough_ - value_);
    const Cell cell = space.cellAt(place);
    if (cell.state == CellState::Near) {
        aside_ = true;
        question = {place, cell.tape};
        return true;
    }
    value_ = cell.state == CellState::Outside ? enough_ : value_;
    return false;
}

void ClearanceWalk::answer(const CellSpace& space, float value) {
    if (!aside_) return probe_.answer(space, value);
    value_ = std::max(value_, std::min(value, enough_));
}

}  // namespace sgm::render
