#include "grammar/pipeline/square_tapes.h"

#include <algorithm>

#include "modeler/eval/evaluate.h"

namespace sgm::pipeline {

using tiles::Cell;

Box3f SquareTapes::boxOf(const Cell& square) const {
    const double side = square.side_m(finest_m_), reach = side / 2 + side / 3;
    const Vec3d centre = square.centre(finest_m_);
    const auto lift = static_cast<float>(side / 8);
    return {{static_cast<float>(centre.x - reach), bounds_.lo.y - lift, static_cast<float>(centre.z - reach)},
            {static_cast<float>(centre.x + reach), bounds_.hi.y + lift, static_cast<float>(centre.z + reach)}};
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
        const eval::Tape& around = i == 0 ? whole_ : path_[i - 1].tape;
        const Box3f box = boxOf(way[i]);
        eval::FloatInterval range;
        const eval::RangeTrace trace = eval::evaluateRanges(around, {&box, 1}, &range, workspace);
        path_.push_back({way[i], eval::shorten(around, trace, 0, workspace)});
    }
    return path_.back().tape;
}

}  // namespace sgm::pipeline
