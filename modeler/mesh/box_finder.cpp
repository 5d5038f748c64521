#include "modeler/mesh/box_finder.h"

#include <algorithm>

namespace sgm::mesh {

BoxFinder::BoxFinder(std::span<const Box3f> boxes) : boxes_(boxes) {
    double size = 0;
    for (const Box3f& box : boxes) {
        around_ = hull(around_, box);
        size += static_cast<double>(maxComponent(box.size()));
    }
    if (boxes.empty()) return;
    // So that a cell's number has 21 bits an axis.
    const double least = static_cast<double>(maxComponent(around_.size())) / (1 << 20);
    size = std::max(size / static_cast<double>(boxes.size()), least);
    cellsPerMetre_ = size > 0 ? static_cast<float>(1 / size) : 0;
    entries_.reserve(4 * boxes.size());
    Cells cells;
    for (uint32_t b = 0; b < boxes.size(); ++b) {
        if (!cellsOf(boxes[b], cells)) continue;
        cells.any([&](uint64_t cell) {
            entries_.push_back({cell, b});
            marks_.set(cell);
            return false;
        });
        cells.coarse().any([&](uint64_t cell) {
            coarseMarks_.set(cell);
            return false;
        });
    }
    std::sort(entries_.begin(), entries_.end());
}

template <class Visit>
bool BoxFinder::Cells::any(Visit&& visit) const {
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                if (visit(numberOf({x, y, z}))) return true;
    return false;
}

bool BoxFinder::isOneMarked(const Cells& coarse) const {
    return coarse.any([&](uint64_t cell) { return coarseMarks_.has(cell); });
}

void BoxFinder::findIn(const Cells& cells, const Box3f& box, std::vector<uint32_t>& found) const {
    cells.any([&](uint64_t cell) {
        if (!marks_.has(cell)) return false;
        for (auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{cell, 0});
             e != entries_.end() && e->cell == cell; ++e)
            if (!intersection(boxes_[e->box], box).empty()) found.push_back(e->box);
        return false;
    });
    if (found.size() < 2) return;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace sgm::mesh
