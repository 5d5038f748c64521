// Booleans, blends, morphs and displacement of fields.
// Enters: fields of one graph, each with the origin that owns its surface (0: its own origins stand).
// Leaves: one Field with bounds kept true. Assumes nothing about nesting: chains are flattened, nothing recurses deep.
#pragma once

#include <span>

#include "modeler/field/field.h"

namespace sgm::field {

/// A field and who owns the surface it contributes.
struct Owned {
    Field field;
    OriginId origin = 0;
};

/// The empty solid ε (`nil`): positive everywhere.
Field nothing(Graph& graph);

/// Sum, SG-M eq. 13 (min under definition 4), as a balanced tree in the order of the parts: where two share a surface
/// the first owns it. The tree hangs on nothing but their order, so that moving a part changes numbers alone; what a
/// region can drop doesn't hang on it (eval::shorten compares each part with the nearest of all). Empty list:
/// nothing(). Give all parts at once: a chain of sums of two is right but deep.
Field sum(Graph& graph, std::span<const Owned> parts);
/// The sum of two or more parts whose value is known already, when only their bounds have changed.
Field summed(NodeRef value, std::span<const Owned> parts);
/// max(a, −b): cuts b from a; the wall of the cut belongs to b's origin.
Field difference(Owned a, Owned b);
/// Cuts whose edges are rounded off: −blend(−a, cuts…); exactly the sharp cuts beyond `radius`, never more solid than
/// they.
Field difference(Owned a, std::span<const Owned> cuts, NodeRef radius, double radiusValue);
/// max(a, b).
Field intersection(Owned a, Owned b);
/// Order-free n-ary smooth union of bounded support: solves Σ max(0, c − fᵢ)² = k², f = c − k; 1-Lipschitz, exactly min
/// beyond k. `radius` is k ≥ 0 in metres with its present value; a part owns the surface where it is the least
/// argument. A part that is itself a blend of the same radius is taken apart, so grouping can't change the shape; the
/// bounds are tightest when all parts come at once.
Field blend(Graph& graph, std::span<const Owned> parts, NodeRef radius, double radiusValue);
/// SG-M eq. 14: a·(1 − t) + b·t of true distances; the surface belongs to `origin`.
Field morph(Field a, Field b, NodeRef t, double tValue, OriginId origin);
/// (d − amplitude · noise(p · frequency)) / (1 + |amplitude · frequency| · L), L the noise's own bound, so that a
/// distance stays 1-Lipschitz. A negative amplitude turns the noise inside out. The noise is never switched off far
/// away (that would leave specks). Billow is in [0, 1]: rounded lumps on the outside; fbm in [−1, 1].
enum class Noise { Billow, Fbm };
/// `amplitude` in metres, `frequency` in 1/m; octaves 1 … 8 is structure. Papers guide, section 3.
Field displace(Field f, Point p, Noise noise, NodeRef amplitude, double amplitudeValue, NodeRef frequency,
               double frequencyValue, int octaves, uint32_t seed);

}  // namespace sgm::field
