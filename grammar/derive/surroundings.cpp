#include "grammar/derive/surroundings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grammar/derive/boxes.h"
#include "grammar/derive/scope_footprint.h"
#include "modeler/plan/edit.h"

namespace sgm::derive {
namespace {

constexpr double touch_m = 1e-3;

bool isUpright(const Scope& scope) { return scope.axes.y.y > 1 - 1e-9; }

bool standsIn(const ShapeTree& tree, ShapeId inner, ShapeId outer) {
    for (ShapeId s = inner; s != none; s = tree.shapes[s].parent)
        if (s == outer) return true;
    return false;
}

bool areRelated(const ShapeTree& tree, ShapeId a, ShapeId b) { return standsIn(tree, a, b) || standsIn(tree, b, a); }

/// The footprint of an upright scope in the plan of the model.
plan::Footprint planOf(const Scope& scope, const Footprints& footprints) {
    return inModelPlan(scope, footprintOf(scope, footprints));
}

/// How far two volumes reach into each other: more than `least` metres.
bool share(const ShapeTree& tree, const Scope& a, const Scope& b, double least) {
    if (penetration(a, b) <= least) return false;
    const bool arePlans = isUpright(a) && isUpright(b) && (a.footprint != none || b.footprint != none);
    if (!arePlans) return true;
    plan::Footprint p = planOf(a, tree.footprints);
    if (least < 0) p = plan::offset(p, -least);
    return plan::shareArea(p, planOf(b, tree.footprints), 1e-6);
}

/// The volume of a scope, for asking about points.
class Volume {
public:
    Volume(const ShapeTree& tree, const Scope& scope) : scope_(scope) {
        if (scope.footprint != none) footprint_ = footprintOf(scope, tree.footprints);
    }
    bool holds(Vec3d p, double slack_m) const {
        const Vec3d at = scope_.axes.transposed() * (p - scope_.centre), h = scope_.half();
        for (int i = 0; i < 3; ++i)
            if (std::abs(at[i]) > h[i] + slack_m) return false;
        return !footprint_ || plan::contains(*footprint_, {at.x, at.z}) ||
               plan::distanceToEdges(*footprint_, {at.x, at.z}) <= slack_m;
    }

private:
    Scope scope_;
    std::optional<plan::Footprint> footprint_;
};

}  // namespace

void Surroundings::add(List& list, const Scope& scope, ShapeId shape) {
    list.entries.push_back({boxOf(scope), shape});
    list.widest_m = std::max(list.widest_m, list.entries.back().box.size().x);
}

void Surroundings::sort(List& list) {
    std::sort(list.entries.begin(), list.entries.end(), [](const Entry& a, const Entry& b) {
        return a.box.lo.x != b.box.lo.x ? a.box.lo.x < b.box.lo.x : a.shape < b.shape;
    });
}

Surroundings::Surroundings(const ShapeTree& tree) {
    for (ShapeId s = 0; s < tree.shapes.size(); ++s) {
        const Shape& shape = tree.shapes[s];
        if (shape.dead) continue;
        if (shape.symbol != rules::none) add(bySymbol_[shape.symbol], shape.scope, s);
        const bool cuts = shape.op == rules::Operator::Difference;
        if (shape.solid != none && !cuts) add(solids_, shape.scope, s);
        if ((shape.solid != none || shape.live) && !cuts) add(standing_, shape.scope, s);
    }
    for (auto& [symbol, list] : bySymbol_) sort(list);
    sort(solids_);
    sort(standing_);
}

std::vector<ShapeId> Surroundings::shapesOf(rules::SymbolId symbol) const {
    std::vector<ShapeId> shapes;
    if (const auto list = bySymbol_.find(symbol); list != bySymbol_.end())
        for (const Entry& e : list->second.entries) shapes.push_back(e.shape);
    std::sort(shapes.begin(), shapes.end());
    return shapes;
}

template <class F>
void Surroundings::forNear(const List& list, const Box3d& box, F f) {
    const auto begin = std::lower_bound(list.entries.begin(), list.entries.end(), box.lo.x - list.widest_m - touch_m,
                                        [](const Entry& e, double x) { return e.box.lo.x < x; });
    for (auto e = begin; e != list.entries.end() && e->box.lo.x <= box.hi.x + touch_m; ++e) {
        bool near = true;
        for (int i = 0; i < 3; ++i)
            near = near && e->box.lo[i] <= box.hi[i] + touch_m && e->box.hi[i] >= box.lo[i] - touch_m;
        if (near && f(e->shape)) return;
    }
}

bool Surroundings::overlaps(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const {
    const auto list = bySymbol_.find(symbol);
    if (list == bySymbol_.end()) return false;
    const Scope& own = tree.shapes[shape].scope;
    bool found = false;
    forNear(list->second, boxOf(own), [&](ShapeId other) {
        found = !areRelated(tree, shape, other) && share(tree, own, tree.shapes[other].scope, boxSlack_m);
        return found;
    });
    return found;
}

bool Surroundings::touches(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const {
    const auto list = bySymbol_.find(symbol);
    if (list == bySymbol_.end()) return false;
    const Scope& own = tree.shapes[shape].scope;
    bool found = false;
    forNear(list->second, boxOf(own), [&](ShapeId other) {
        found = !areRelated(tree, shape, other) && share(tree, own, tree.shapes[other].scope, -touch_m);
        return found;
    });
    return found;
}

bool Surroundings::inside(const ShapeTree& tree, ShapeId shape, rules::SymbolId symbol) const {
    const auto list = bySymbol_.find(symbol);
    if (list == bySymbol_.end()) return false;
    const Scope& own = tree.shapes[shape].scope;
    const std::vector<plan::PlacedEdge> edges = plan::edgesOf(footprintOf(own, tree.footprints));
    bool found = false;
    forNear(list->second, boxOf(own), [&](ShapeId other) {
        if (areRelated(tree, shape, other)) return false;
        const Volume outer(tree, tree.shapes[other].scope);
        const double half = own.half().y;
        found = std::all_of(edges.begin(), edges.end(), [&](const plan::PlacedEdge& e) {
            const auto at = [&](double y) { return own.centre + own.axes * Vec3d{e.from.x, y, e.from.z}; };
            return outer.holds(at(-half), touch_m) && outer.holds(at(half), touch_m);
        });
        return found;
    });
    return found;
}

double Surroundings::covered(const ShapeTree& tree, ShapeId shape) const {
    return shareOf(tree, shape, tree.shapes[shape].scope, solids_);
}

double Surroundings::shared(const ShapeTree& tree, ShapeId shape, const Scope& part) const {
    return shareOf(tree, shape, part, standing_);
}

/// By points just before the outer face of `own`.
double Surroundings::shareOf(const ShapeTree& tree, ShapeId shape, const Scope& own, const List& list) const {
    constexpr int points = 20;     // along each side
    constexpr double out_m = .01;  // in front of the face, where another solid may begin
    Scope face = own;
    face.centre = own.centre + own.axes.z * own.half().z;
    face.size.z = 4 * out_m;
    std::vector<Volume> near;
    forNear(list, boxOf(face), [&](ShapeId other) {
        if (!areRelated(tree, shape, other)) near.emplace_back(tree, tree.shapes[other].scope);
        return false;
    });
    if (near.empty()) return 0;
    int count = 0;
    for (int i = 0; i < points; ++i)
        for (int k = 0; k < points; ++k) {
            const auto share = [](int at) { return (2.0 * at + 1) / points - 1; };
            const Vec3d p = face.centre + own.axes * Vec3d{share(i) * own.half().x, share(k) * own.half().y, out_m};
            count += std::any_of(near.begin(), near.end(), [&](const Volume& v) { return v.holds(p, 0); });
        }
    return static_cast<double>(count) / (points * points);
}

}  // namespace sgm::derive
