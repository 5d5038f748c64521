#include "viewer/render/samples.h"

#include <algorithm>
#include <cmath>

#include "modeler/eval/evaluate.h"
#include "viewer/render/camera.h"

namespace sgm::render {

std::vector<float> valuesAt(const eval::Tape& tape, const std::vector<Vec3f>& points) {
    std::vector<float> x, y, z, values(points.size());
    for (const Vec3f& p : points) {
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
    }
    eval::Workspace workspace;
    eval::evaluate(tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    return values;
}

Samples sample(const eval::Tape& tape, const Box3f& bounds) {
    Samples grid;
    grid.bounds = bounds;
    grid.cell = maxComponent(bounds.size()) / Samples::edge;
    for (int axis = 0; axis < 3; ++axis)
        grid.count[axis] = std::max(1, static_cast<int>(std::ceil(bounds.size()[axis] / grid.cell - 1e-3f)));
    grid.values.resize(size_t(grid.count.x) * size_t(grid.count.y) * size_t(grid.count.z));
    // By parts of 10³ samples, each with its own shortened tape.
    constexpr int splits = 4, edge = Samples::edge / splits;
    std::vector<Box3f> boxes;
    std::vector<std::vector<size_t>> members;
    for (int part = 0; part < splits * splits * splits; ++part) {
        const Vec3i lo{part % splits * edge, part / splits % splits * edge, part / splits / splits * edge};
        const Vec3i hi{std::min(lo.x + edge, grid.count.x), std::min(lo.y + edge, grid.count.y),
                       std::min(lo.z + edge, grid.count.z)};
        if (lo.x >= hi.x || lo.y >= hi.y || lo.z >= hi.z) continue;
        boxes.push_back(hull(Box3f{grid.at(lo.x, lo.y, lo.z), grid.at(lo.x, lo.y, lo.z)},
                             Box3f{grid.at(hi.x - 1, hi.y - 1, hi.z - 1), grid.at(hi.x - 1, hi.y - 1, hi.z - 1)})
                            .inflated(grid.cell / 4));
        members.emplace_back();
        for (int k = lo.z; k < hi.z; ++k)
            for (int j = lo.y; j < hi.y; ++j)
                for (int i = lo.x; i < hi.x; ++i) members.back().push_back(grid.index(i, j, k));
    }
    eval::Workspace workspace;
    std::vector<eval::FloatInterval> ranges(boxes.size());
    const eval::RangeTrace trace = evaluateRanges(tape, {boxes.data(), boxes.size()}, ranges.data(), workspace);
    std::vector<eval::Tape> tapes;
    for (size_t part = 0; part < boxes.size(); ++part) tapes.push_back(shorten(tape, trace, part, workspace));
    for (size_t part = 0; part < boxes.size(); ++part) {
        std::vector<Vec3f> points;
        for (const size_t i : members[part])
            points.push_back(grid.at(static_cast<int>(i) % grid.count.x,
                                     static_cast<int>(i) / grid.count.x % grid.count.y,
                                     static_cast<int>(i) / grid.count.x / grid.count.y));
        const std::vector<float> values = valuesAt(tapes[part], points);
        for (size_t k = 0; k < values.size(); ++k) grid.values[members[part][k]] = values[k];
    }
    return grid;
}

std::vector<Vec3f> Samples::placesBelow(float below) const {
    std::vector<Vec3f> places;
    for (int k = 0; k < count.z; ++k)
        for (int j = 0; j < count.y; ++j)
            for (int i = 0; i < count.x; ++i)
                if (values[index(i, j, k)] < below) places.push_back(at(i, j, k));
    return places;
}

namespace {

/// Whether intervals prove that no solid is in the box, cut into up to 4⁵ columns. O(columns).
bool provenEmpty(const eval::Tape& tape, const Box3f& box) {
    std::vector<Box3f> open{box};
    eval::Workspace workspace;
    for (int depth = 0; depth <= 5 && !open.empty(); ++depth) {
        std::vector<Vec3f> centres;
        for (const Box3f& column : open) centres.push_back(column.centre());
        for (const float value : valuesAt(tape, centres))
            if (value <= 0) return false;
        std::vector<eval::FloatInterval> ranges(open.size());
        for (size_t i = 0; i < open.size(); i += 64)
            evaluateRanges(tape, {&open[i], std::min<size_t>(64, open.size() - i)}, &ranges[i], workspace);
        std::vector<Box3f> parts;
        for (size_t i = 0; i < open.size(); ++i) {
            if (ranges[i].lo > 0) continue;
            const Box3f& column = open[i];
            const Vec3f middle = column.centre();
            for (int part = 0; part < 4; ++part) {
                Box3f quarter = column;
                (part & 1 ? quarter.lo : quarter.hi).x = middle.x;
                (part & 2 ? quarter.lo : quarter.hi).z = middle.z;
                parts.push_back(quarter);
            }
        }
        open = std::move(parts);
    }
    return open.empty();
}

/// `box` without the layers at its foot that hold no solid, to a thousandth of its size: the ground lies there, and
/// bounds of smooth unions and displaced solids reach below what they hold.
Box3f raiseFoot(const eval::Tape& tape, Box3f box, float cell) {
    const float least = maxComponent(box.size()) / 1024, top = std::min(box.lo.y + 4 * cell, box.hi.y);
    Box3f foot = box;
    foot.hi.y = top;
    eval::Workspace workspace;
    eval::FloatInterval range;
    const eval::Tape near = shorten(tape, evaluateRanges(tape, {&foot, 1}, &range, workspace), 0, workspace);
    for (float height = 2 * cell; height >= least;) {
        Box3f layer = box;
        layer.hi.y = box.lo.y + height;
        if (layer.hi.y < top && provenEmpty(near, layer))
            box.lo.y = layer.hi.y;
        else
            height /= 2;
    }
    return box;
}

}  // namespace

Box3f tighten(const eval::Tape& tape, const Box3f& bounds) {
    if (bounds.empty() || !bounds.finite() || !(maxComponent(bounds.size()) > 0)) return bounds;
    const Samples grid = sample(tape, bounds);
    // No surface is in a cell whose centre is farther from it than the corners are.
    const float reach = grid.cell * 0.867f;
    Box3f tight;
    for (const Vec3f& place : grid.placesBelow(reach * tape.lipschitz()))
        tight = hull(tight, Box3f{place, place}.inflated(grid.cell / 2));
    return tight.empty() ? bounds : raiseFoot(tape, intersection(tight, bounds), grid.cell);
}

}  // namespace sgm::render
