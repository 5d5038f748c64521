#include "modeler/mesh/box_finder.h"

#include <algorithm>

namespace sgm::mesh {

BoxFinder::BoxFinder(std::span<const Box3f> boxes) : boxes_(boxes), marks_((size_t{1} << bits) / 64) {
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
    for (uint32_t b = 0; b < boxes.size(); ++b)
        forCells(boxes[b], [&](uint64_t cell) { entries_.push_back({cell, b}); });
    std::sort(entries_.begin(), entries_.end());
    for (const Entry& e : entries_) marks_[bitOf(e.cell) / 64] |= uint64_t{1} << bitOf(e.cell) % 64;
}

template <class Visit>
void BoxFinder::forCells(const Box3f& box, Visit&& visit) const {
    const Vec3f lo = (max(box.lo, around_.lo) - around_.lo) * cellsPerMetre_,
                hi = (min(box.hi, around_.hi) - around_.lo) * cellsPerMetre_;
    if (minComponent(hi - lo) < 0) return;
    const Vec3i first{static_cast<int>(lo.x), static_cast<int>(lo.y), static_cast<int>(lo.z)},
        last{static_cast<int>(hi.x), static_cast<int>(hi.y), static_cast<int>(hi.z)};
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                visit(static_cast<uint64_t>(z) << 42 | static_cast<uint64_t>(y) << 21 | static_cast<uint64_t>(x));
}

void BoxFinder::find(const Box3f& box, std::vector<uint32_t>& found) const {
    found.clear();
    forCells(box, [&](uint64_t cell) {
        if (!(marks_[bitOf(cell) / 64] >> bitOf(cell) % 64 & 1)) return;
        for (auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{cell, 0});
             e != entries_.end() && e->cell == cell; ++e)
            if (!intersection(boxes_[e->box], box).empty()) found.push_back(e->box);
    });
    if (found.size() < 2) return;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace sgm::mesh
