// A field's tape shortened to many boxes, in steps: ranges of boxes side by side cost little more than one.
// Enters: a tape, and boxes of which those that follow each other lie beside each other. Leaves: each box with what
// matters in it.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "modeler/core/parallel.h"
#include "modeler/core/progress.h"
#include "modeler/eval/evaluate.h"

namespace sgm::eval {

/// One worker's.
class LocalTapes {
public:
    static constexpr size_t boxesPerTape = 8;                         ///< that are shortened from one tape
    static constexpr size_t mostBoxes = boxesPerTape * boxesPerTape;  ///< at once

    /// `tape` has to stay.
    explicit LocalTapes(const Tape& tape) : tape_(tape) {}

    /// Shortens the tape to a box, once for all boxes within it.
    void shortenAround(const Box3f& box) { shortenTo(tape_, {&box, 1}, {&around_, 1}); }

    /// Calls visit(i, tape) for those of at most `mostBoxes` boxes, all in that box, that may hold surface.
    template <class Visit>
    void visit(std::span<const Box3f> boxes, Visit&& visit) {
        if (around_.isEmpty) return;
        const Box3f all = boxAround(boxes);
        shortenTo(around_.tape, {&all, 1}, {&all_, 1});
        if (all_.isEmpty) return;
        std::array<Box3f, mostBoxes / boxesPerTape> around;
        const size_t count = (boxes.size() + boxesPerTape - 1) / boxesPerTape;
        const auto group = [&](size_t k) {
            return boxes.subspan(k * boxesPerTape, std::min(boxesPerTape, boxes.size() - k * boxesPerTape));
        };
        for (size_t k = 0; k < count; ++k) around[k] = boxAround(group(k));
        shortenTo(all_.tape, {around.data(), count}, groups_);
        for (size_t k = 0; k < count; ++k) {
            if (groups_[k].isEmpty) continue;
            shortenTo(groups_[k].tape, group(k), each_);
            for (size_t i = 0; i < group(k).size(); ++i)
                if (!each_[i].isEmpty) visit(k * boxesPerTape + i, std::as_const(each_[i].tape));
        }
    }
    Workspace& workspace() { return workspace_; }

private:
    /// A tape for a box.
    struct Local {
        Tape tape;
        bool isEmpty = true;  ///< no surface may be there
    };

    static Box3f boxAround(std::span<const Box3f> boxes) {
        Box3f all;
        for (const Box3f& box : boxes) all = hull(all, box);
        return all;
    }
    /// Leaves in `to` what matters in each box.
    void shortenTo(const Tape& from, std::span<const Box3f> boxes, std::span<Local> to) {
        std::array<FloatInterval, mostBoxes> ranges;
        const RangeTrace trace = evaluateRanges(from, {boxes.data(), boxes.size()}, ranges.data(), workspace_);
        for (size_t i = 0; i < boxes.size(); ++i) {
            to[i].isEmpty = ranges[i].lo > 0 || ranges[i].hi < 0;
            if (!to[i].isEmpty) shorten(from, trace, i, workspace_, to[i].tape);
        }
    }

    const Tape& tape_;
    Local around_, all_;
    std::array<Local, mostBoxes / boxesPerTape> groups_;
    std::array<Local, boxesPerTape> each_;
    Workspace workspace_;
};

/// A field's slope as far as it is believed: fractals' bound is hundreds, which they have nowhere.
inline float believedSlope(const Tape& tape) { return std::clamp(tape.lipschitz(), 1.0f, 4.0f); }

/// Points as the evaluation takes them.
struct PointList {
    std::vector<float> x, y, z;
    void clear() { x.clear(), y.clear(), z.clear(); }
    void add(Vec3f p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    Vec3f operator[](size_t i) const { return {x[i], y[i], z[i]}; }
    size_t size() const { return x.size(); }
    Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

/// Whose surface points lie on. One worker's.
class SurfaceOwners {
public:
    /// By point; 0 where another part's surface is the same, for a mesh may have it as that part's.
    const std::vector<OriginId>& at(const PointList& points, const Tape& tape, Workspace& workspace) {
        owners_.resize(points.size()), tied_.resize(points.size()), labels_.resize(points.size());
        evaluateOrigin(tape, points.points(), owners_.data(), workspace);
        evaluateLabels(tape, points.points(), labels_.data(), tied_.data(), workspace);
        for (size_t i = 0; i < owners_.size(); ++i)
            if (tied_[i] != owners_[i]) owners_[i] = 0;
        return owners_;
    }
    /// Of the points that at() was asked for last: the first in the grammar of those that share a surface, which a
    /// mesh gives it to but for rounding.
    const std::vector<OriginId>& first() const { return tied_; }

private:
    std::vector<OriginId> owners_, tied_;
    std::vector<uint32_t> labels_;
};

/// Orders items, which have a centre() and a number(), so that those that LocalTapes takes together lie beside each
/// other: halves of the list, and halves of these, cut between groups. O(n log² n).
template <class Item>
void orderByPlace(std::span<Item> items) {
    if (items.size() <= LocalTapes::boxesPerTape) return;
    size_t group = LocalTapes::boxesPerTape;
    while (group * LocalTapes::boxesPerTape < items.size()) group *= LocalTapes::boxesPerTape;
    Box3d box;
    for (const Item& item : items) box = hull(box, item.centre());
    const Vec3d size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t middle = std::max<size_t>(items.size() / 2 / group, 1) * group;
    std::nth_element(items.begin(), items.begin() + static_cast<ptrdiff_t>(middle), items.end(),
                     [&](const Item& a, const Item& b) {
                         return std::pair(a.centre()[axis], a.number()) < std::pair(b.centre()[axis], b.number());
                     });
    orderByPlace(items.first(middle));
    orderByPlace(items.subspan(middle));
}

/// Calls probe(prober, items, boxes, number of the group) for groups of at most LocalTapes::mostBoxes items that follow
/// each other, on `threads` threads (0: all), each with a prober that `make` makes; ticks for every item, or, where
/// `stage` is null, is a part of a stage that has begun. A prober has boxOf(item), in which it looks, and tapes(),
/// which are shortened around the boxes.
template <class Item, class Make, class Probe>
void probeInGroups(std::span<Item> items, int threads, Progress* progress, const char* stage, Make make, Probe probe) {
    constexpr size_t groupsAtOnce = LocalTapes::boxesPerTape;
    std::vector<decltype(make())> probers;
    probers.reserve(static_cast<size_t>(threadCount(threads)));
    for (int w = 0; w < threadCount(threads); ++w) probers.push_back(make());
    if (progress && stage) progress->begin(stage, items.size());
    const size_t groups = (items.size() + LocalTapes::mostBoxes - 1) / LocalTapes::mostBoxes;
    const auto itemsOf = [&](size_t group) {
        const size_t first = group * LocalTapes::mostBoxes;
        return items.subspan(first, std::min(LocalTapes::mostBoxes, items.size() - first));
    };
    parallelFor((groups + groupsAtOnce - 1) / groupsAtOnce, threads, progress, [&](size_t step, int worker) {
        auto& prober = probers[static_cast<size_t>(worker)];
        const size_t first = step * groupsAtOnce, end = std::min(groups, first + groupsAtOnce);
        std::array<std::vector<Box3f>, groupsAtOnce> boxes;
        Box3f around;
        for (size_t g = first; g < end; ++g)
            for (const Item& item : itemsOf(g)) {
                boxes[g - first].push_back(prober.boxOf(item));
                around = hull(around, boxes[g - first].back());
            }
        prober.tapes().shortenAround(around);
        for (size_t g = first; g < end && !cancelled(progress); ++g) {
            probe(prober, itemsOf(g), boxes[g - first], g);
            for (size_t i = 0; stage && i < itemsOf(g).size(); ++i) tick(progress);
        }
    });
}

}  // namespace sgm::eval
