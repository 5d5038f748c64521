#include "grammar/pipeline/square_tapes.h"

#include <algorithm>
#include <array>

#include "modeler/eval/evaluate.h"

namespace sgm::pipeline {
namespace {

using tiles::Cell;

/// Instructions of a tape whose trace is kept for all quarters, a few megabytes.
constexpr size_t longTape = 1 << 17;

/// The tape without what can't matter in a box. What that takes besides the result is gone afterwards.
eval::Tape shortenedOnce(const eval::Tape& tape, const Box3f& box) {
    eval::Workspace workspace;
    eval::FloatInterval range;
    const eval::RangeTrace trace = eval::evaluateRanges(tape, {&box, 1}, &range, workspace);
    return eval::shorten(tape, trace, 0, workspace);
}

}  // namespace

Box3f SquareTapes::boxOf(const Cell& square) const {
    const double margin = margins_.finest_m * (1 << std::min(square.level, margins_.doublings));
    const double reach = square.side_m(finest_m_) / 2 + margin;
    const Vec3d centre = square.centre(finest_m_);
    const auto lift = static_cast<float>(margin);
    return {{static_cast<float>(centre.x - reach), bounds_.lo.y - lift, static_cast<float>(centre.z - reach)},
            {static_cast<float>(centre.x + reach), bounds_.hi.y + lift, static_cast<float>(centre.z + reach)}};
}

/// The tape of a quarter of a step's square. Quarters come one after the other: one pass over the tape serves all four.
eval::Tape SquareTapes::quarterOf(Step& around, const Cell& quarter, eval::Workspace& workspace) const {
    if (around.tape.size() > longTape) return shortenedOnce(around.tape, boxOf(quarter));
    if (!around.trace) {
        const Cell& square = around.square;
        std::array<Box3f, 4> boxes;
        for (int i = 0; i < 4; ++i)
            boxes[static_cast<size_t>(i)] = boxOf({square.level - 1, 2 * square.x + i % 2, 2 * square.z + i / 2});
        std::array<eval::FloatInterval, 4> ranges;
        around.trace = eval::evaluateRanges(around.tape, {boxes.data(), boxes.size()}, ranges.data(), workspace);
    }
    return eval::shorten(around.tape, *around.trace, static_cast<size_t>((quarter.x & 1) + 2 * (quarter.z & 1)),
                         workspace);
}

const eval::Tape& SquareTapes::over(const Cell& square, eval::Workspace& workspace) {
    const double extent = static_cast<double>(std::max(bounds_.hi.x - bounds_.lo.x, bounds_.hi.z - bounds_.lo.z));
    std::vector<Cell> way{square};
    while (way.back().side_m(finest_m_) < extent / 2) way.push_back(way.back().parent());
    std::reverse(way.begin(), way.end());
    size_t kept = 0;
    while (kept < std::min(way.size(), path_.size()) && path_[kept].square == way[kept]) ++kept;
    path_.resize(kept);
    for (size_t i = kept; i < way.size(); ++i) {
        eval::Tape tape = i == 0 ? shortenedOnce(whole_, boxOf(way[0])) : quarterOf(path_[i - 1], way[i], workspace);
        path_.push_back({way[i], std::move(tape), std::nullopt});
    }
    return path_.back().tape;
}

}  // namespace sgm::pipeline
