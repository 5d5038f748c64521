#include "modeler/field/facade.h"

#include <algorithm>
#include <cmath>

#include "modeler/core/conventions.h"
#include "modeler/field/domain.h"
#include "modeler/field/facade_op.h"
#include "modeler/field/ops.h"
#include "modeler/field/solids.h"

namespace sgm::field {

namespace {

using enum FacadeParameter;

/// The tiling's numbers.
struct Tiling {
    double period[2]{}, shrink[2]{1, 1};  ///< along x and z
    double storey = 1;
    int storeys = 1;
    Vec3d origin;      ///< of the tiling, from the scope's middle
    double round = 0;  ///< > 0: x runs along a circle about the scope's y axis, z across it
    double along = 0, across = 1, swing = 0, core = 0;
};

double number(std::span<const Argument> a, FacadeParameter p, int i = 0) { return a[size_t(p)].value[i]; }

/// As long as wished, but so that it fits a whole number of times.
double fitted(double wished, double whole) { return whole / std::max(1.0, std::round(whole / wished)); }

Tiling tilingOf(std::span<const Argument> a, Vec3d half) {
    Tiling t;
    const bool whole = number(a, Fit) < 0.5;
    const double bay = number(a, Bay);
    t.storey = whole ? fitted(number(a, Storey), 2 * half.y) : number(a, Storey);
    t.storeys = std::max(1, static_cast<int>(std::ceil(2 * half.y / t.storey - 1e-6)));
    t.period[0] = t.period[1] = bay;
    t.origin.y = -half.y;
    t.round = number(a, Round);
    if (t.round <= 0) {
        if (!whole) return t;
        t.period[0] = fitted(bay, 2 * half.x), t.period[1] = fitted(bay, 2 * half.z);
        t.origin = -half;
        return t;
    }
    t.along = number(a, Along) > 0 ? number(a, Along) : t.round;
    t.across = number(a, Across);
    t.swing = number(a, Swing);
    t.core = number(a, Core) > 0 ? number(a, Core) : t.round / 2;
    if (whole) t.period[0] = fitted(bay, 2 * pi * t.along);
    return t;
}

/// |2(mod(x, w)/w − 1/2)|
double triangle(double x, double w) { return std::abs(2 * (x / w - std::floor(x / w)) - 1); }

int idAt(double u, const double r[3]) {
    int id = 0;
    for (int i = 0; i < 3; ++i) {
        const double v = std::abs(u - r[i]) - r[i];
        id += v > 0;
        u = std::abs(v);
    }
    return id;
}

/// Neighbours of the same scale and shift are one bay.
std::vector<FacadeBay> distinctBays(std::span<const Argument> a) {
    std::vector<FacadeBay> bays = baysOf(a[size_t(Mirror)].value);
    const auto same = [&](const FacadeBay& p, const FacadeBay& q) {
        return number(a, Zoom, p.id) == number(a, Zoom, q.id) && number(a, Pan, p.id) == number(a, Pan, q.id);
    };
    bays.erase(std::unique(bays.begin(), bays.end(), same), bays.end());
    return bays;
}

/// The least stretch of the map from the world to the fractal over all cells.
double leastStretch(std::span<const Argument> a, const std::vector<FacadeBay>& bays, const Tiling& t) {
    double least[2] = {1e30, 1e30};
    for (int axis = 0; axis < 2; ++axis)
        for (const FacadeBay& b : bays)
            least[axis] =
                std::min(least[axis], std::abs(number(a, Zoom, b.id)) * 2 / (t.period[axis] * t.shrink[axis]));
    return std::max({least[0], least[1], number(a, Rise) / t.storey});
}

/// How far inside the fractal's terminal solids the field can fall, metres.
double deepest(std::span<const Argument> a, double stretch) {
    const Argument& c = a[size_t(Center)];
    const double terminal = number(a, Terminal) > 0.5 ? std::max({c.value[0], c.value[1], c.value[2]}) : 2;
    return terminal / std::pow(number(a, Scale), number(a, Passes)) / stretch * 1.0001;
}

struct Pattern {
    NodeRef value;
    NodeRef inner;  ///< the inner shell, and the core that a round facade leaves alone
};

/// The op over in.p between two shells; `most` bounds it, metres.
Pattern pattern(const PrimitiveInput& in, NodeRef outer, NodeRef inner, double most) {
    Graph& graph = outer.graph();
    const auto a = in.arguments;
    Tiling t = tilingOf(a, in.halfValue);
    const std::vector<FacadeBay> bays = distinctBays(a);
    const auto slot = [&](double v) { return graph.slot(static_cast<float>(v)); };
    Point q{in.p.x - slot(t.origin.x), in.p.y - slot(t.origin.y), in.p.z - slot(t.origin.z)};
    if (t.round > 0) {  // eqs. 5, 6; inside the core bays would grow ever narrower
        const NodeRef radius = sqrt(square(in.p.x) + square(in.p.z));
        q.x = slot(t.along) * (atan2(in.p.x, in.p.z) + slot(t.swing));
        q.z = slot(t.across) * (radius - slot(t.round));
        const double nearest = std::max(t.core - deepest(a, number(a, Rise) / t.storey), t.core / 4);
        t.shrink[0] = nearest / t.along, t.shrink[1] = 1 / t.across;
        inner = min(inner, radius - slot(t.core));
    }
    const double stretch = leastStretch(a, bays, t);
    const double least = std::min({t.storey, t.period[0] * t.shrink[0], t.period[1] * t.shrink[1]});
    if (t.storeys > 1) most = std::min(most, 0.49 * t.storey);  // farther storeys could be nearer than that

    double extent = 2 + number(a, Rise);
    for (const FacadeBay& b : bays)
        extent = std::max(extent, std::abs(number(a, Zoom, b.id)) + std::abs(number(a, Pan, b.id)) + 2);
    std::vector<Operand> operands;
    const auto add = [&](NodeRef n) { operands.push_back({n.id(), 0}); };
    for (const NodeRef n : {q.x, q.y, q.z, outer, inner}) add(n);
    for (const auto& [parameter, count] : {std::pair{Center, 3}, {Scale, 1}, {Fold, 9}, {Turn, 9}})
        for (int i = 0; i < count; ++i) add(a[size_t(parameter)].node[i]);
    for (const double v : {t.period[0], t.period[1], t.shrink[0], t.shrink[1]}) add(slot(v));
    for (int i = 0; i < 3; ++i) add(a[size_t(Mirror)].node[i]);
    for (const double v : {t.storey, double(t.storeys), number(a, Rise), most, deepest(a, stretch), 1e-4 * least,
                           1e-6 * (number(a, Passes) + 2) * extent / stretch})
        add(slot(v));
    for (size_t i = 0; i < ops::Facade::mostBays; ++i) {
        const FacadeBay bay = i < bays.size() ? bays[i] : FacadeBay{ops::Facade::noBay, 0};
        add(slot(bay.from));
        add(slot(number(a, Zoom, bay.id)));
        add(slot(number(a, Pan, bay.id)));
    }
    return {graph.apply(codeOf<ops::Facade>, operands, ops::Facade::pack(solids::kifsForm(a))), inner};
}

}  // namespace

std::vector<FacadeBay> baysOf(const double r[3]) {
    // Stretches of the triangle wave in which each fold so far is a straight line; the folds bend at r and 2r.
    const auto folded = [&](double u, int folds) {
        for (int i = 0; i < folds; ++i) u = std::abs(std::abs(u - r[i]) - r[i]);
        return u;
    };
    std::vector<double> ends{0, 1};
    for (int i = 0; i < 3; ++i) {
        std::vector<double> bends;
        for (size_t k = 0; k + 1 < ends.size(); ++k) {
            const double from = folded(ends[k], i), to = folded(ends[k + 1], i);
            for (const double level : {r[i], 2 * r[i]})
                if ((from - level) * (to - level) < 0)
                    bends.push_back(ends[k] + (ends[k + 1] - ends[k]) * (level - from) / (to - from));
        }
        ends.insert(ends.end(), bends.begin(), bends.end());
        std::sort(ends.begin(), ends.end());
    }
    std::vector<FacadeBay> bays;
    for (size_t k = 0; k + 1 < ends.size(); ++k) {
        if (ends[k + 1] - ends[k] < 1e-3) continue;
        const int id = idAt((ends[k] + ends[k + 1]) / 2, r);
        if (bays.empty() || bays.back().id != id) bays.push_back({bays.empty() ? 0 : ends[k], id});
    }
    return bays;
}

FacadeDetail facadeDetail(std::span<const Argument> a, Vec3d half) {
    const Argument& c = a[size_t(Center)];
    const double cube = 2 * std::max({c.value[0], c.value[1], c.value[2]});  // of the fractal, its side
    FacadeDetail detail{0, static_cast<int>(solids::kifsForm(a).passes), number(a, Scale)};
    const double stretch = leastStretch(a, distinctBays(a), tilingOf(a, half));
    detail.width_m = cube / std::pow(detail.scale, detail.passes) / stretch;
    return detail;
}

FacadeCell facadeCell(std::span<const Argument> arguments, Vec3d half, Vec3d p) {
    const Tiling t = tilingOf(arguments, half);
    Vec3d q = p - t.origin;
    if (t.round > 0) {
        q.x = t.along * (std::atan2(p.x, p.z) + t.swing);
        q.z = t.across * (std::hypot(p.x, p.z) - t.round);
    }
    const double* r = arguments[size_t(Mirror)].value;
    return {idAt(triangle(q.x, t.period[0]), r), idAt(triangle(q.z, t.period[1]), r),
            std::clamp(static_cast<int>(std::floor(q.y / t.storey)), 0, t.storeys - 1)};
}

Field clad(const PrimitiveInput& in, const Clad& c, Vec3d up) {
    Graph& graph = in.p.x.graph();
    const double wall = number(in.arguments, Wall), top = number(in.arguments, Top);
    // Erosion by `wall`, then stretched about the middle, down by `wall` and up by wall − top: nowhere by more than
    // `wall`, so that the inner shell stays inside the outer one whatever the solid is.
    const auto slot = [&](double v) { return graph.slot(static_cast<float>(v)); };
    const NodeRef shift = min(in.p.y + slot(wall), max(in.p.y - slot(wall - top), 0.0f)) - in.p.y;
    Point moved = graph.position();
    if (up == Vec3d{0, 1, 0})
        moved.y = moved.y + shift;
    else
        moved = moved + Point{shift * slot(up.x), shift * slot(up.y), shift * slot(up.z)};
    const NodeRef outer = c.solid.value, shell = substitute(outer, moved) + slot(wall);
    const Pattern p = pattern(in, outer, shell, wall);
    const auto chosen = [&](OpCode op, NodeRef a, OriginId ofA, NodeRef b, OriginId ofB) {
        const Operand both[] = {{a.id(), ofA}, {b.id(), ofB}};
        return graph.apply(op, both);
    };
    const NodeRef inside = chosen(codeOf<ops::Min>, p.inner, c.origin, p.value, c.ornament);
    Field result = c.solid;
    result.value = chosen(codeOf<ops::Max>, outer, c.ornament, inside, 0);
    result.lipschitz = std::max(c.solid.lipschitz, 1.0f);
    return result;
}

namespace solids {

// Standing alone: the pattern cut by its scope, no inner shell.
Field ornament(const PrimitiveInput& in) {
    const NodeRef box = boxDistance(in.p, in.half);
    const Tiling t = tilingOf(in.arguments, in.halfValue);
    const Pattern p = pattern(in, box, box + 1e6f, std::max(t.storey, t.period[0]));
    return {max(box, in.arguments[size_t(FacadeParameter::Round)].value[0] > 0 ? min(p.inner, p.value) : p.value),
            scopeBox(in), 1, growth(1)};
}

}  // namespace solids

}  // namespace sgm::field
