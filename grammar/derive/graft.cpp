#include "grammar/derive/graft.h"

#include <algorithm>

#include "modeler/core/random.h"

namespace sgm::derive {
namespace {

uint32_t shifted(uint32_t index, size_t by) { return index == none ? none : index + static_cast<uint32_t>(by); }

/// Index in `list` of `value`, which is appended where it isn't there from `first` on.
template <class T>
uint32_t indexIn(std::vector<T>& list, size_t first, const T& value) {
    const auto found = std::find(list.begin() + static_cast<std::ptrdiff_t>(first), list.end(), value);
    if (found != list.end()) return static_cast<uint32_t>(found - list.begin());
    list.push_back(value);
    return static_cast<uint32_t>(list.size() - 1);
}

class Graft {
public:
    Graft(Derivation& into, ShapeId at, const Derivation& object, const Pose& pose)
        : into_(into), tree_(into.tree), at_(at), object_(object), pose_(pose) {}

    void run() {
        const ShapeTree& from = object_.tree;
        tree_.bonds();  // those of what stands, before the copy comes
        for (const std::string& label : from.labels) labels_.push_back(indexIn(tree_.labels, 0, label));
        const size_t own = object_.grammar->materials.size();
        for (size_t i = 0; i < object_.materials.size(); ++i)
            materials_.push_back(i < own ? static_cast<uint32_t>(i)
                                         : indexIn(into_.materials, own, object_.materials[i]));
        first_ = {tree_.shapes.size(),      tree_.solids.size(), tree_.extras.size(),
                  tree_.namedJoints.size(), into_.steps.size(),  tree_.footprints.append(from.footprints)};
        tree_.solids.insert(tree_.solids.end(), from.solids.begin(), from.solids.end());
        tree_.namedJoints.insert(tree_.namedJoints.end(), from.namedJoints.begin(), from.namedJoints.end());
        copyExtras();
        copyBonds(*tree_.bondsOnDemand.made(), from.bonds());
        copySteps();
        for (ShapeId s = 0; s < from.shapes.size(); ++s) tree_.shapes.push_back(copyOf(s));
        attach(static_cast<ShapeId>(first_.shape));
        copyWarnings();
        into_.classic += object_.classic;
        into_.morphic += object_.morphic;
    }

private:
    struct First {
        size_t shape = 0, solid = 0, extras = 0, joints = 0, step = 0, footprint = 0;
    };

    uint32_t materialOf(uint32_t material) const { return material == none ? none : materials_[material]; }

    Shape copyOf(ShapeId id) const {
        Shape s = object_.tree.shapes[id];
        s.key = combine(tree_.shapes[at_].key, s.key);
        for (ShapeId* link : {&s.parent, &s.firstChild, &s.lastChild, &s.nextSibling, &s.valuesAt})
            *link = shifted(*link, first_.shape);
        s.label = labels_[s.label];
        s.depth += tree_.shapes[at_].depth + 1;
        s.solid = shifted(s.solid, first_.solid);
        s.material = materialOf(s.material);
        s.extras = shifted(s.extras, first_.extras);
        s.jointSet = s.jointSet == 0 ? 0 : shifted(s.jointSet, first_.joints);
        s.madeBy = shifted(s.madeBy, first_.step);
        s.scope.centre = pose_.origin + pose_.axes * s.scope.centre;
        s.scope.axes = pose_.axes * s.scope.axes;
        s.scope.footprint = shifted(s.scope.footprint, first_.footprint);
        return s;
    }

    void copyExtras() {
        for (ShapeId s = 0; s < object_.tree.shapes.size(); ++s) keyOfExtras(s);
        for (size_t i = 0; i < object_.tree.extras.size(); ++i) {
            Extras extras = object_.tree.extras[i];
            extras.object = none;
            for (Cladding& clad : extras.clad) clad.material = materialOf(clad.material);
            tree_.extras.push_back(std::move(extras));
        }
        for (const auto& [extras, shape] : displaced_)
            for (Displacement& noise : tree_.extras[first_.extras + extras].displace) {
                if (noise.key == 0) noise.key = object_.tree.shapes[shape].key;
                noise.frame = {pose_.origin + pose_.axes * noise.frame.origin, pose_.axes * noise.frame.axes};
            }
    }

    void keyOfExtras(ShapeId id) {
        const Shape& s = object_.tree.shapes[id];
        if (s.extras != none && !object_.tree.extras[s.extras].displace.empty()) displaced_.emplace_back(s.extras, id);
    }

    void copyBonds(Bonds& into, const Bonds& from) const {
        const size_t bonds = into.all.size(), bodies = into.bodies.size(), named = into.named.size();
        for (Bond bond : from.all) {
            bond.shift = pose_.axes * bond.shift;
            for (int end = 0; end < 2; ++end) {
                bond.shape[end] = shifted(bond.shape[end], first_.shape);
                bond.next[end] = shifted(bond.next[end], bonds);
            }
            into.all.push_back(bond);
        }
        for (Body body : from.bodies) {
            body.owner = shifted(body.owner, first_.shape);
            body.firstBond = shifted(body.firstBond, bonds);
            for (uint32_t& bond : body.bond) bond = shifted(bond, bonds);
            into.bodies.push_back(body);
        }
        for (const uint32_t body : from.bodyOf) into.bodyOf.push_back(shifted(body, bodies));
        for (const uint32_t at : from.namedAt) into.namedAt.push_back(shifted(at, named));
        for (const uint32_t bond : from.named) into.named.push_back(shifted(bond, bonds));
    }

    void copySteps() {
        for (Step step : object_.steps) {
            step.shape = shifted(step.shape, first_.shape);
            step.firstMade = shifted(step.firstMade, first_.shape);
            into_.steps.push_back(step);
        }
    }

    void copyWarnings() {
        const auto isAt = [](const auto& other, const syntax::SourceSpan& span) {
            return other.span.source == span.source && other.span.begin == span.begin && other.span.end == span.end;
        };
        for (const Closed& closed : object_.closed) {
            const auto known = std::find_if(into_.closed.begin(), into_.closed.end(),
                                            [&](const Closed& c) { return isAt(c, closed.span); });
            if (known == into_.closed.end()) {
                into_.closed.push_back(closed);
                into_.closed.back().host = shifted(closed.host, first_.shape);
            } else
                known->count += closed.count;
        }
        for (const Warning& warning : object_.warnings)
            if (std::none_of(into_.warnings.begin(), into_.warnings.end(),
                             [&](const Warning& w) { return isAt(w, warning.span); }))
                into_.warnings.push_back(warning);
    }

    /// The copy's root becomes the last child of the shape that holds the object.
    void attach(ShapeId root) {
        ShapeRecord& holder = tree_.shapes.record(at_);
        tree_.shapes.record(root).parent = at_;
        tree_.shapes.record(root).occurrence = 1;
        (holder.lastChild == none ? holder.firstChild : tree_.shapes.record(holder.lastChild).nextSibling) = root;
        holder.lastChild = root;
    }

    Derivation& into_;
    ShapeTree& tree_;
    const ShapeId at_;
    const Derivation& object_;
    const Pose& pose_;
    First first_;
    std::vector<uint32_t> labels_, materials_;
    std::vector<std::pair<uint32_t, ShapeId>> displaced_;  ///< extras with noise, and whose they are
};

}  // namespace

void graft(Derivation& into, ShapeId at, const Derivation& object, const Pose& pose) {
    Graft(into, at, object, pose).run();
}

std::optional<Mass> massOf(const Derivation& object) {
    const auto& shapes = object.tree.shapes;
    const auto first = std::find_if(shapes.begin(), shapes.end(), [](const Shape& s) { return s.solid != none; });
    if (first == shapes.end()) return std::nullopt;
    Mass mass{object.tree.contentBox(0), none};
    for (auto s = static_cast<ShapeId>(first - shapes.begin()); s != none && mass.material == none;
         s = shapes[s].parent)
        mass.material = shapes[s].material;
    return mass;
}

void graftMass(Derivation& into, ShapeId at, const Derivation& object, const Pose& pose) {
    const auto mass = massOf(object);
    if (!mass) return;
    Derivation held;
    held.grammar = object.grammar;
    held.materials = object.materials;
    held.tree.labels = {"mass"};
    held.tree.namedJoints.emplace_back();
    SolidValue cube;
    cube.kind = rules::Solid::Kind::Primitive;
    cube.primitive = field::findPrimitive("cube");
    held.tree.solids.push_back(std::move(cube));
    Shape box;
    box.key = object.tree.shapes[0].key;
    box.solid = 0;
    box.meetsNobody = true;
    box.material = mass->material;
    box.scope = mass->box;
    box.span = object.tree.shapes[0].span;
    held.tree.shapes.push_back(box);
    graft(into, at, held, pose);
}

}  // namespace sgm::derive
