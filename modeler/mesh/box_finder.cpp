#include "modeler/mesh/box_finder.h"

#include <algorithm>
#include <bit>

namespace sgm::mesh {
namespace {

constexpr size_t mostCoarseWords = size_t{1} << 14;  ///< so that they stay in a core's cache
constexpr size_t bucketsPerEntry = 4;

size_t wordsFor(Vec3i cells, int bits) {
    return static_cast<size_t>((cells.x >> bits) / 64 + 1) * static_cast<size_t>((cells.y >> bits) + 1) *
           static_cast<size_t>((cells.z >> bits) + 1);
}

size_t bucketOf(uint64_t cell, int bits) { return static_cast<size_t>(cell * 0x9e3779b97f4a7c15u >> (64 - bits)); }

}  // namespace

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
    order(listEntries());
}

std::vector<BoxFinder::Entry> BoxFinder::listEntries() {
    std::vector<Entry> entries;
    Cells all;
    if (!cellsOf(around_, all)) return entries;
    while (wordsFor(all.last, coarseBits_) > mostCoarseWords) ++coarseBits_;
    rows_ = static_cast<size_t>(coarse(all.last).y) + 1;
    rowWords_ = static_cast<size_t>(coarse(all.last).x) / 64 + 1;
    coarseMarks_.resize(wordsFor(all.last, coarseBits_));
    entries.reserve(4 * boxes_.size());
    for (uint32_t b = 0; b < boxes_.size(); ++b) {
        Cells cells;
        if (!cellsOf(boxes_[b], cells)) continue;
        for (int z = cells.first.z; z <= cells.last.z; ++z)
            for (int y = cells.first.y; y <= cells.last.y; ++y)
                for (int x = cells.first.x; x <= cells.last.x; ++x) {
                    entries.push_back({numberOf({x, y, z}), b});
                    const Vec3i c = coarse({x, y, z});
                    coarseMarks_[rowOf(c.y, c.z) + static_cast<size_t>(c.x) / 64] |= uint64_t{1} << c.x % 64;
                }
    }
    return entries;
}

void BoxFinder::order(std::span<const Entry> entries) {
    bucketBits_ = std::bit_width(bucketsPerEntry * entries.size());
    bucketBegin_.assign((size_t{1} << bucketBits_) + 1, 0);
    for (const Entry& e : entries) ++bucketBegin_[bucketOf(e.cell, bucketBits_)];
    uint32_t end = 0;
    for (uint32_t& begin : bucketBegin_) begin = end += begin;  // each one's end; it sinks to its beginning below
    entries_.resize(entries.size());
    for (const Entry& e : entries) entries_[--bucketBegin_[bucketOf(e.cell, bucketBits_)]] = e;
}

void BoxFinder::findIn(const Cells& cells, const Box3f& box, std::vector<uint32_t>& found) const {
    const auto findInCell = [&](Vec3i at) {
        const uint64_t cell = numberOf(at);
        const size_t bucket = bucketOf(cell, bucketBits_);
        for (size_t e = bucketBegin_[bucket]; e < bucketBegin_[bucket + 1]; ++e)
            if (entries_[e].cell == cell && !intersection(boxes_[entries_[e].box], box).empty())
                found.push_back(entries_[e].box);
    };
    for (int z = cells.first.z; z <= cells.last.z; ++z)
        for (int y = cells.first.y; y <= cells.last.y; ++y) {
            const Vec3i first{cells.first.x, y, z}, last{cells.last.x, y, z};
            if (!isCoarseMarked({first, last})) continue;
            for (int x = first.x; x <= last.x; ++x) findInCell({x, y, z});
        }
    if (found.size() < 2) return;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace sgm::mesh
