// A field's tape shortened to many boxes, in steps: ranges of boxes side by side cost little more than one.
// Enters: a tape, and boxes of which those that follow each other lie beside each other. Leaves: each box with what
// matters in it.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "modeler/eval/evaluate.h"

namespace sgm::lower {

/// One worker's.
class LocalTapes {
public:
    static constexpr size_t most = 64;  ///< boxes at once

    /// `tape` has to stay.
    explicit LocalTapes(const eval::Tape& tape) : tape_(tape) {}

    /// Calls visit(i, tape) for those of at most `most` boxes that may hold surface.
    template <class Visit>
    void visit(std::span<const Box3f> boxes, Visit&& visit) {
        const Box3f all = boxAround(boxes);
        shortenTo(tape_, {&all, 1}, {&group_, 1});
        if (group_.isEmpty) return;
        std::array<Box3f, most / together> around;
        const size_t count = (boxes.size() + together - 1) / together;
        const auto some = [&](size_t k) {
            return boxes.subspan(k * together, std::min(together, boxes.size() - k * together));
        };
        for (size_t k = 0; k < count; ++k) around[k] = boxAround(some(k));
        shortenTo(group_.tape, {around.data(), count}, some_);
        for (size_t k = 0; k < count; ++k) {
            if (some_[k].isEmpty) continue;
            shortenTo(some_[k].tape, some(k), each_);
            for (size_t i = 0; i < some(k).size(); ++i)
                if (!each_[i].isEmpty) visit(k * together + i, std::as_const(each_[i].tape));
        }
    }
    eval::Workspace& workspace() { return workspace_; }

private:
    static constexpr size_t together = 8;  ///< boxes that are shortened from one tape

    /// A tape for a box.
    struct Local {
        eval::Tape tape;
        bool isEmpty = true;  ///< no surface may be there
    };

    static Box3f boxAround(std::span<const Box3f> boxes) {
        Box3f all;
        for (const Box3f& box : boxes) all = hull(all, box);
        return all;
    }
    /// Leaves in `to` what matters in each box.
    void shortenTo(const eval::Tape& from, std::span<const Box3f> boxes, std::span<Local> to) {
        std::array<eval::FloatInterval, most> ranges;
        const eval::RangeTrace trace =
            eval::evaluateRanges(from, {boxes.data(), boxes.size()}, ranges.data(), workspace_);
        for (size_t i = 0; i < boxes.size(); ++i) {
            to[i].isEmpty = ranges[i].lo > 0 || ranges[i].hi < 0;
            if (!to[i].isEmpty) eval::shorten(from, trace, i, workspace_, to[i].tape);
        }
    }

    const eval::Tape& tape_;
    Local group_;
    std::array<Local, most / together> some_;
    std::array<Local, together> each_;
    eval::Workspace workspace_;
};

/// Orders items so that halves of the list, and halves of these, lie beside each other. `centreOf` gives an item's
/// place, `numberOf` a number that no other has. O(n log² n).
template <class Item, class CentreOf, class NumberOf>
void orderByPlace(std::span<Item> items, CentreOf centreOf, NumberOf numberOf) {
    constexpr size_t fewest = 8;
    if (items.size() <= fewest) return;
    Box3d box;
    for (const Item& item : items) box = hull(box, centreOf(item));
    const Vec3d size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = items.begin() + static_cast<ptrdiff_t>(items.size() / 2);
    std::nth_element(items.begin(), middle, items.end(), [&](const Item& a, const Item& b) {
        return std::pair(centreOf(a)[axis], numberOf(a)) < std::pair(centreOf(b)[axis], numberOf(b));
    });
    orderByPlace(items.first(items.size() / 2), centreOf, numberOf);
    orderByPlace(items.subspan(items.size() / 2), centreOf, numberOf);
}

/// Points as the evaluation takes them.
struct PointList {
    std::vector<float> x, y, z;
    void clear() { x.clear(), y.clear(), z.clear(); }
    void add(Vec3f p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    Vec3f operator[](size_t i) const { return {x[i], y[i], z[i]}; }
    size_t size() const { return x.size(); }
    eval::Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

}  // namespace sgm::lower
