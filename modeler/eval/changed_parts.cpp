#include "modeler/eval/changed_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "modeler/eval/evaluate.h"
#include "modeler/field/ops.h"

namespace sgm::eval {

void ChangedParts::mark(const Tape& tape, const NumbersChanged& changed) {
    numbers_.assign(tape.constants().size(), 0);
    values_.assign(tape.size() + 3, 0);
    for (const uint32_t place : changed.places) numbers_[place] = 1;
    for (size_t i = 0; i < tape.size(); ++i) {
        const Source* const operands = chains_.operands(i);
        uint8_t any = 0;
        for (uint32_t k = 0; k < tape.code()[i].count; ++k)
            any |= isConstant(operands[k]) ? numbers_[indexOf(operands[k])] : values_[operands[k]];
        values_[i + 3] = any;
    }
}

/// Finds the changed values below the topmost minima.
void ChangedParts::descend(const Tape& tape) {
    found_.clear();
    const auto visit = [&](Source s) {
        if (isConstant(s) || values_[s] == 0) return;
        values_[s] = 0;  // once
        stack_.push_back(s);
    };
    visit(chains_.result());
    while (!stack_.empty()) {
        const uint32_t value = stack_.back();
        stack_.pop_back();
        if (!isMinimum(tape.code()[value - 3])) {
            found_.push_back(value);
            continue;
        }
        for (uint32_t k = 0; k < 2; ++k) visit(chains_.operands(value - 3)[k]);
    }
}

/// The tape of one value.
void ChangedParts::extract(const Tape& tape, uint32_t value, Tape& into) {
    builder_.begin(tape.size() + 3);
    for (uint32_t axis = 0; axis < 3; ++axis) builder_.bindInput(axis, axis);
    builder_.result({value});
    for (uint32_t v = builder_.nextLive(value + 1); v != TapeBuilder::none; v = builder_.nextLive(v))
        builder_.define(v, tape.code()[v - 3], chains_.operands(v - 3), nullptr);
    builder_.finish(tape.sharedConstants(), tape.grids(), TapeBuilder::scaleOf(tape), into);
}

bool ChangedParts::find(const Tape& tape, const NumbersChanged& changed) {
    if (!chains_.follows(tape)) chains_.build(tape);
    mark(tape, changed);
    descend(tape);
    if (parts_.size() < found_.size()) parts_.resize(found_.size());
    size_t size = 0;
    for (size_t i = 0; i < found_.size(); ++i) {
        extract(tape, found_[i], parts_[i].now);
        size += parts_[i].now.size();
        if (4 * size > tape.size()) return false;
        parts_[i].before = parts_[i].now;
        TapeBuilder::rebind(parts_[i].before, changed.before, TapeBuilder::scaleOf(tape));
    }
    return true;
}

ChangedParts::Reach ChangedParts::reach(std::span<const Box3f> boxes, RelevantRange relevant,
                                        Workspace& workspace) const {
    Reach reach{boxes.size() == 64 ? ~uint64_t{0} : (uint64_t{1} << boxes.size()) - 1, true};
    std::array<FloatInterval, 64> ranges;
    const auto ask = [&](const Tape& tape) {
        evaluateRanges(tape, {boxes.data(), boxes.size()}, ranges.data(), workspace);
        for (size_t i = 0; i < boxes.size(); ++i) {
            if (!(ranges[i].lo > relevant.most)) reach.unreached &= ~(uint64_t{1} << i);
            reach.bounded = reach.bounded && std::isfinite(ranges[i].lo) && std::isfinite(ranges[i].hi);
        }
    };
    for (size_t i = 0; i < found_.size(); ++i) {
        ask(parts_[i].before);
        ask(parts_[i].now);
    }
    return reach;
}

Tape ChangedParts::around(const Tape& tape, const Box3f& box, RelevantRange relevant, Workspace& workspace) const {
    std::vector<uint32_t> free;
    for (const uint32_t value : found_) free.push_back(value - 3);
    std::sort(free.begin(), free.end());
    FloatInterval whole;
    const RangeTrace trace = evaluateRanges(tape, {&box, 1}, &whole, workspace, free);
    return shorten(tape, trace, 0, workspace, relevant);
}

}  // namespace sgm::eval
