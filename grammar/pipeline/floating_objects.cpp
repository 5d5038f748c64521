#include "grammar/pipeline/floating_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "grammar/derive/boxes.h"
#include "grammar/derive/support.h"
#include "modeler/mesh/components.h"

namespace sgm::pipeline {
namespace {

using derive::Derivation;
using derive::none;
using derive::Scope;
using derive::ShapeId;

constexpr double slack_m = 1e-3;  // feet are set by numbers of the grammar, which round
constexpr double sky_m = 1e6;     // half the height of a box that a relief lifts by who knows how much

/// A solid or an object.
struct Body {
    Scope scope;
    Box3d box;
    ShapeId shape = none;
    uint32_t group = 0;
    uint32_t object = none;
    bool isLifted = false;  ///< by a relief, on which it stands
};

/// The boxes of objects with all that they hold, in their own frames.
class ObjectBoxes {
public:
    explicit ObjectBoxes(const PlacedModels& objects) : objects_(objects) {}

    const Box3d& of(uint32_t index) {
        if (const auto known = boxes_.find(index); known != boxes_.end()) return known->second;
        const PlacedModel& object = objects_[index];
        const Derivation& derivation = *object.derivation;
        Box3d box;
        if (derivation.terminals() > 0) box = derive::boxOf(derivation.tree.contentBox(0));
        if (!object.holds.empty())
            for (const derive::Placement& placement : derive::placementsOf(derivation))
                box = hull(box, derive::boxOf(placed(derivation, object.holds, placement)));
        if (box.empty()) box = derive::boxOf(derivation.tree.shapes[0].scope);
        if (!derivation.reliefs.empty()) box.lo.y -= sky_m, box.hi.y += sky_m;
        return boxes_.emplace(index, box).first->second;
    }

    /// Where an object stands, as the scope of all of it.
    Scope placed(const Derivation& holder, const std::vector<uint32_t>& holds, const derive::Placement& placement) {
        const uint32_t index = objects_.of(holds, placement.object);
        const Pose pose = PlacedModels::poseOf(objects_[index], holder.tree.shapes[placement.shape].scope);
        const Box3d& box = of(index);
        Scope scope{pose.origin + pose.axes * box.centre(), pose.axes, box.size()};
        scope.centre.y += holder.tree.extrasOf(placement.shape)->lift_m;
        return scope;
    }

private:
    const PlacedModels& objects_;
    std::unordered_map<uint32_t, Box3d> boxes_;
};

/// By shape: whether it or one above it lies on a relief.
std::vector<bool> liftedShapes(const derive::ShapeTree& tree) {
    std::vector<bool> lifted(tree.shapes.size());
    for (ShapeId s = 0; s != none; s = tree.next(s)) {
        const derive::Extras* extras = tree.extrasOf(s);
        const ShapeId parent = tree.shapes[s].parent;
        lifted[s] = (extras && extras->relief != none) || (parent != none && lifted[parent]);
    }
    return lifted;
}

/// The solids and objects of one derivation.
class Bodies {
public:
    Bodies(const Derivation& holder, const std::vector<uint32_t>& holds, ObjectBoxes& boxes) : holder_(holder) {
        const auto placements = derive::placementsOf(holder);
        const std::vector<bool> lifted = liftedShapes(holder.tree);
        if (std::all_of(placements.begin(), placements.end(), [&](const auto& p) { return lifted[p.shape]; })) return;
        const auto groupOf = derive::touchingGroups(holder.tree);
        uint32_t groups = 0;
        for (ShapeId s = 0; s < groupOf.size(); ++s) {
            if (groupOf[s] == none) continue;
            Scope scope = derive::outerScope(holder.tree, s);
            Box3d box = derive::boxOf(scope);
            if (lifted[s]) box.lo.y -= sky_m, box.hi.y += sky_m;
            bodies_.push_back({scope, box, s, groupOf[s], none, lifted[s]});
            groups = std::max(groups, groupOf[s] + 1);
        }
        startsWithSolid_ = groups > 0;
        for (const derive::Placement& p : placements) {
            const Scope scope = boxes.placed(holder, holds, p);
            bodies_.push_back({scope, derive::boxOf(scope), p.shape, groups++, p.object, lifted[p.shape]});
        }
        joined_ = mesh::Components(groups);
        join();
        findStanding();
    }

    /// Objects that touch nothing that stands, in tree order.
    std::vector<const Body*> hanging() {
        std::vector<const Body*> found;
        for (const Body& body : bodies_)
            if (body.object != none && !stands_[joined_.find(body.group)]) found.push_back(&body);
        std::sort(found.begin(), found.end(), [](const Body* a, const Body* b) { return a->group < b->group; });
        return found;
    }

    /// What stands below a body, as far as boxes tell: "; 5 m below is 'Town/lawn'".
    std::string below(const Body& body) {
        const Body* nearest = nullptr;
        for (const Body& other : bodies_) {
            const bool isUnder = other.box.lo.x < body.box.hi.x && other.box.hi.x > body.box.lo.x &&
                                 other.box.lo.z < body.box.hi.z && other.box.hi.z > body.box.lo.z &&
                                 other.box.hi.y <= body.box.lo.y;
            if (isUnder && stands_[joined_.find(other.group)] && (!nearest || other.box.hi.y > nearest->box.hi.y))
                nearest = &other;
        }
        if (!nearest) return {};
        return fmt::format("; {:.3g} m below is '{}'", body.box.lo.y - nearest->box.hi.y,
                           holder_.tree.path(nearest->shape));
    }

private:
    /// Joins objects with what they touch.
    void join() {
        Box3d all;
        for (const Body& body : bodies_) all = hull(all, body.box);
        const int axis = all.size().x >= all.size().z ? 0 : 2;
        std::sort(bodies_.begin(), bodies_.end(), [&](const Body& a, const Body& b) {
            return a.box.lo[axis] != b.box.lo[axis] ? a.box.lo[axis] < b.box.lo[axis] : a.group < b.group;
        });
        for (size_t i = 0; i < bodies_.size(); ++i)
            for (size_t k = i + 1; k < bodies_.size() && bodies_[k].box.lo[axis] <= bodies_[i].box.hi[axis] + slack_m;
                 ++k)
                if (bodies_[i].object != none || bodies_[k].object != none) joinPair(bodies_[i], bodies_[k]);
    }

    void joinPair(const Body& a, const Body& b) {
        for (int i = 0; i < 3; ++i)
            if (a.box.hi[i] + slack_m < b.box.lo[i] || b.box.hi[i] + slack_m < a.box.lo[i]) return;
        if (joined_.find(a.group) == joined_.find(b.group)) return;
        if (a.isLifted || b.isLifted || derive::penetration(a.scope, b.scope) >= -slack_m)
            joined_.join(a.group, b.group);
    }

    void findStanding() {
        double ground_m = 1e300;
        for (const Body& body : bodies_)
            if (!body.isLifted) ground_m = std::min(ground_m, body.box.lo.y);
        stands_.resize(joined_.size());
        if (startsWithSolid_) stands_[joined_.find(0)] = true;
        for (const Body& body : bodies_)
            if (body.isLifted || body.box.lo.y <= ground_m + slack_m) stands_[joined_.find(body.group)] = true;
    }

    const Derivation& holder_;
    std::vector<Body> bodies_;
    mesh::Components joined_{0};  ///< groups that touch
    std::vector<bool> stands_;
    bool startsWithSolid_ = false;
};

void warnOf(const Derivation& holder, const std::vector<uint32_t>& holds, const PlacedModels& objects,
            ObjectBoxes& boxes, syntax::Diagnostics& told) {
    Bodies bodies(holder, holds, boxes);
    struct Alike {
        const Body* first;
        size_t count;
    };
    using Place = std::tuple<const syntax::Source*, uint32_t, uint32_t>;
    std::map<Place, Alike> alike;
    std::vector<Place> order;
    for (const Body* body : bodies.hanging()) {
        const syntax::SourceSpan span = holder.tree.shapes[body->shape].span;
        const Place place{span.source, span.begin, holder.objects[body->object].start};
        const auto [at, isNew] = alike.try_emplace(place, Alike{body, 0});
        if (isNew) order.push_back(place);
        ++at->second.count;
    }
    for (const Place& place : order) {
        const auto& [first, count] = alike.at(place);
        const std::string& name = objects.nameOf(objects[objects.of(holds, first->object)]);
        told.warning(
            holder.tree.shapes[first->shape].span,
            fmt::format("{}{}: the object '{}' touches nothing that stands{}", derive::madeBy(holder, first->shape),
                        count == 1 ? " floats" : fmt::format(" and {} more like it float", count - 1), name,
                        bodies.below(*first)),
            "let its foot touch what stands on the ground");
    }
}

}  // namespace

syntax::Diagnostics floatingObjects(const Derivation& model, const PlacedModels& objects) {
    syntax::Diagnostics told;
    ObjectBoxes boxes(objects);
    if (!model.objects.empty()) warnOf(model, objects.ofModel(), objects, boxes, told);
    // Of objects of one start that hold others, the first says it for all.
    std::set<uint32_t> starts;
    for (uint32_t i = 0; i < objects.size(); ++i)
        if (objects[i].same == i && !objects[i].holds.empty() && starts.insert(objects[i].inputs.start).second)
            warnOf(*objects[i].derivation, objects[i].holds, objects, boxes, told);
    return told;
}

}  // namespace sgm::pipeline
