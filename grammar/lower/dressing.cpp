// What dresses the whole content of a shape: cladding, noise, and the hills that it is laid over.
#include "grammar/lower/lowering.h"
#include "grammar/lower/solids.h"
#include "modeler/core/random.h"
#include "modeler/field/domain.h"
#include "modeler/field/drape.h"

namespace sgm::lower {

namespace {

/// A cladding holds its content twice, so that cladding in cladding grows with 2 to the power of its depth. A few
/// levels are fine, and one level however large its content is.
bool cladsTooMuch(size_t cladNodes, size_t nodes) {
    constexpr size_t always = 100'000, share = 3;
    return cladNodes > always + share * (nodes - cladNodes);
}

}  // namespace

/// Cladding is a part of its own, named after its terminal.
Owned Lowering::applyCladding(Owned part, ShapeId id) {
    const auto* x = tree_.extrasOf(id);
    if (!x || x->clad.empty() || part.field.bounds.empty()) return part;
    const derive::Cladding& clad = x->clad[0];
    OriginId ornament = ownerOf(id);
    if (!clad.name.empty()) {
        Part own = model_.provenance.parts[ornament];
        own.path = own.path.text() + "/" + clad.name;
        PartSource source = own.source();
        source.symbol = clad.name;
        own.madeBy = std::make_shared<const PartSource>(std::move(source));
        if (clad.material != none) own.material = clad.material;
        ornament = static_cast<OriginId>(model_.provenance.parts.size());
        model_.provenance.parts.push_back(std::move(own));
        model_.shapeOf.push_back(id);
    }
    if (noted_.refused != none || cladsTooMuch(noted_.cladNodes, model_.graph.nodeCount())) {
        if (noted_.refused == none) noted_.refused = id;
        return part;
    }
    const derive::Scope box = tree_.contentBox(id);
    const size_t before = model_.graph.nodeCount();
    const Owned whole{lowerClad(model_.graph, {part.field, part.origin, ornament}, clad.ornament, box,
                                combine(tree_.shapes[id].key, hashText("clad"))),
                      0};
    noted_.cladNodes += model_.graph.nodeCount() - before;
    return whole;
}

Owned Lowering::displaced(Owned part, ShapeId id) {
    const auto* x = tree_.extrasOf(id);
    if (!x || x->displace.empty() || part.field.bounds.empty()) return part;
    const Shape& s = tree_.shapes[id];
    const bool isBounded = part.field.bounds.finite();
    for (size_t i = 0; i < x->displace.size(); ++i) {
        const derive::Displacement& n = x->displace[i];
        const uint64_t key = combine(s.key, i), pattern = n.key == 0 ? key : combine(n.key, i);
        const field::Point position =
            n.key == 0 ? model_.graph.position()
                       : field::toLocal(model_.graph.position(), {n.frame.origin, n.frame.axes},
                                        combine(key, hashText("displace.frame")), tree_.shapes[turnedAt_[id]].key);
        part.field = field::displace(
            part.field, position, n.fbm ? field::Noise::Fbm : field::Noise::Billow,
            model_.graph.slot({key, hashText("displace.amplitude")}, static_cast<float>(n.amplitude_m)), n.amplitude_m,
            model_.graph.slot({key, hashText("displace.frequency")}, static_cast<float>(n.frequency)), n.frequency,
            n.octaves, static_cast<uint32_t>(pattern >> 32));
    }
    if (isBounded && !part.field.bounds.finite() && noted_.boundless == none) noted_.boundless = id;
    return part;
}

/// Laid over the heights of its relief.
Owned Lowering::draped(Owned part, ShapeId id) {
    const auto* x = tree_.extrasOf(id);
    if (!x || x->relief == none) return part;
    const derive::Relief& relief = d_.reliefs[x->relief];
    if (relief.heights)
        part.field = field::drape(part.field, relief.heights, {relief.frame.origin, relief.frame.axes},
                                  combine(combine(tree_.shapes[0].key, x->relief), hashText("relief")));
    return part;
}

}  // namespace sgm::lower
