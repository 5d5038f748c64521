#include "grammar/lower/likeness.h"

#include <cmath>

#include "modeler/core/random.h"

namespace sgm::lower {
namespace {

using derive::none;
using derive::Shape;
using derive::ShapeId;

/// A number in millionths, so that rounding on the way to it doesn't count.
uint64_t hashed(double v) { return static_cast<uint64_t>(std::llround(v * 1e6)); }

uint64_t add(uint64_t hash, Vec3d v) { return combine(combine(combine(hash, hashed(v.x)), hashed(v.y)), hashed(v.z)); }

uint64_t add(uint64_t hash, const rules::Value& value) {
    hash = combine(combine(hash, static_cast<uint64_t>(value.kind)), hashText(value.text));
    for (const double n : value.n) hash = combine(hash, hashed(n));
    return hash;
}

uint64_t add(uint64_t hash, const derive::SolidValue& solid) {
    hash = combine(combine(hash, static_cast<uint64_t>(solid.kind)), static_cast<uint64_t>(solid.op));
    hash = combine(combine(hash, hashed(solid.amount)), hashText(solid.primitive ? solid.primitive->name : ""));
    for (const rules::Value& value : solid.args) hash = add(hash, value);
    for (const derive::SolidValue& part : solid.parts) hash = add(hash, part);
    return hash;
}

/// The shape alone, without its children; 0 where it is like no other.
uint64_t likenessOf(const derive::ShapeTree& tree, ShapeId id) {
    const Shape& s = tree.shapes[id];
    const derive::Extras* extras = tree.extrasOf(id);
    if (s.blend_m > 0 || (extras && (!extras->displace.empty() || extras->relief != none))) return 0;
    uint64_t hash = combine(hashText(tree.labels[s.label]), static_cast<uint64_t>(s.op));
    hash = combine(hash, hashed(s.amount));
    for (const Vec3d& v : {s.scope.size, s.scope.axes.x, s.scope.axes.y, s.scope.axes.z}) hash = add(hash, v);
    if (const derive::SolidValue* solid = tree.solidOf(id)) hash = add(hash, *solid);
    if (extras)
        for (const derive::Cladding& clad : extras->clad) hash = add(combine(hash, hashText(clad.name)), clad.ornament);
    return hash;
}

}  // namespace

std::vector<uint64_t> likenesses(const derive::Derivation& derivation, const Model& model) {
    const derive::ShapeTree& tree = derivation.tree;
    std::vector<uint64_t> all(tree.shapes.size());
    for (ShapeId s = 0; s < all.size(); ++s) all[s] = likenessOf(tree, s);
    for (OriginId o = 1; o < model.shapeOf.size(); ++o) {
        const ShapeId s = model.shapeOf[o];
        if (s != none && all[s] != 0) all[s] = combine(all[s], model.provenance.parts[o].material);
    }
    // Children in joining order; from the last shape on, so that those below are complete.
    std::vector<ShapeId> order;
    for (ShapeId s = 0; s != none; s = tree.next(s)) order.push_back(s);
    for (size_t i = order.size(); i-- > 0;) {
        const Shape& s = tree.shapes[order[i]];
        uint64_t& hash = all[order[i]];
        for (ShapeId c = s.firstChild; c != none && hash != 0; c = tree.shapes[c].nextSibling)
            hash = all[c] == 0 ? 0 : add(combine(hash, all[c]), tree.shapes[c].scope.centre - s.scope.centre);
    }
    return all;
}

}  // namespace sgm::lower
