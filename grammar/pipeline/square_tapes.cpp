#include "grammar/pipeline/square_tapes.h"

#include <algorithm>
#include <array>

#include "modeler/eval/evaluate.h"

namespace sgm::pipeline {
namespace {

using tiles::Cell;

constexpr int splitLevels = 3;               ///< that a long tape is cut across: to eight by eight squares
constexpr int mostAlong = 1 << splitLevels;  ///< squares

Cell ancestorOf(Cell cell, int level) {
    while (cell.level < level) cell = cell.parent();
    return cell;
}

}  // namespace

SquareTapes::SquareTapes(const eval::Tape& whole, const Box3f& bounds, double finest_m, const Margins& margins)
    : whole_(whole), bounds_(bounds), finest_m_(finest_m), margins_(margins) {}

Box3f SquareTapes::boxOf(const Cell& square) const {
    const double margin = margins_.finest_m * (1 << std::min(square.level, margins_.doublings));
    const double reach = square.side_m(finest_m_) / 2 + margin;
    const Vec3d centre = square.centre(finest_m_);
    const auto lift = static_cast<float>(margin);
    return {{static_cast<float>(centre.x - reach), bounds_.lo.y - lift, static_cast<float>(centre.z - reach)},
            {static_cast<float>(centre.x + reach), bounds_.hi.y + lift, static_cast<float>(centre.z + reach)}};
}

bool SquareTapes::Cuts::has(const Cell& square) const {
    return square.level == level && square.x >= x && square.x < x + along && square.z >= z && square.z < z + across;
}

SquareTapes::Cuts SquareTapes::cutsOf(const eval::Tape& tape, const Cell& from, const Cell& to) const {
    eval::Workspace workspace;  // grows with the tape, so it isn't the one that is kept for cells
    std::vector<Box3f> boxes;
    for (int z = from.z; z <= to.z; ++z)
        for (int x = from.x; x <= to.x; ++x) boxes.push_back(boxOf({from.level, x, z}));
    return {from.level,
            from.x,
            from.z,
            to.x - from.x + 1,
            to.z - from.z + 1,
            eval::RegionCuts(tape, {boxes.data(), boxes.size()}, workspace)};
}

/// A square's tape from that of a larger one: whole parts go first, what is in them only where a short tape is left.
eval::Tape SquareTapes::cut(const eval::Tape& tape, const Cuts& cuts, const Cell& square,
                            eval::Workspace& workspace) const {
    if (cuts.cuts.empty() || !cuts.has(square)) return eval::shortenTo(tape, boxOf(square), workspace);
    const int index = (square.z - cuts.z) * cuts.along + square.x - cuts.x;
    eval::Workspace own;  // grows with the tape as well
    eval::Tape parts = cuts.cuts.cut(tape, static_cast<size_t>(index), own);
    if (parts.size() > eval::mostTraced) return parts;
    return eval::shortenTo(parts, boxOf(square), workspace);
}

/// The tape of a quarter of a step's square. Quarters come one after the other: one pass over the tape serves all four.
eval::Tape SquareTapes::quarterOf(Step& around, const Cell& quarter, eval::Workspace& workspace) const {
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

void SquareTapes::cutWhole() {
    if (ofWhole_ || bounds_.empty()) return;
    const auto at = [&](float x, float z) {
        return ancestorOf(tiles::cellAt(static_cast<double>(x), static_cast<double>(z), finest_m_), margins_.doublings);
    };
    Cell from = at(bounds_.lo.x, bounds_.lo.z), to = at(bounds_.hi.x, bounds_.hi.z);
    while (to.x - from.x >= mostAlong || to.z - from.z >= mostAlong) from = from.parent(), to = to.parent();
    ofWhole_ = cutsOf(whole_, from, to);
}

/// The square around another one that is cut from the whole tape.
SquareTapes::Step SquareTapes::first(const Cell& square, eval::Workspace& workspace) {
    cutWhole();
    const Cell top = ancestorOf(square, ofWhole_->level);
    return {top, cut(whole_, *ofWhole_, top, workspace), {}, {}};
}

/// The next square on the way from a larger one to one in it.
SquareTapes::Step SquareTapes::below(Step& around, const Cell& square, eval::Workspace& workspace) const {
    const Cell& from = around.square;
    if (around.tape.size() <= eval::mostTraced) {
        const Cell quarter = ancestorOf(square, from.level - 1);
        return {quarter, quarterOf(around, quarter, workspace), {}, {}};
    }
    const int level = std::max(from.level - splitLevels, std::min(from.level - 1, margins_.doublings));
    const Cell next = ancestorOf(square, level);
    if (!around.cuts) {
        const int along = 1 << (from.level - level);
        const Cell corner{level, from.x * along, from.z * along};
        around.cuts = cutsOf(around.tape, corner, {level, corner.x + along - 1, corner.z + along - 1});
    }
    return {next, cut(around.tape, *around.cuts, next, workspace), {}, {}};
}

const eval::Tape& SquareTapes::over(const Cell& square, eval::Workspace& workspace) {
    while (!path_.empty() && ancestorOf(square, path_.back().square.level) != path_.back().square) path_.pop_back();
    if (path_.empty()) path_.push_back(first(square, workspace));
    while (path_.back().square.level > square.level) path_.push_back(below(path_.back(), square, workspace));
    return path_.back().tape;
}

}  // namespace sgm::pipeline
