// Facades: a KIFS mapped onto walls, storey by storey and bay by bay, and cladding of any solid with it.
// Enters: the arguments of the primitive row `ornament` over a scope. Leaves: the facade filling its scope, or a solid
// clad with it, g = min(inner, max(outer, fractal)) (McGraw, section 3). Assumes half-sizes > 0.
#pragma once

#include <vector>

#include "modeler/field/primitives.h"

namespace sgm::field {

/// Arguments of the row `ornament`, in its order. The first six are also those of `kifs`.
enum class FacadeParameter : size_t {
    Center,
    Scale,
    Fold,
    Turn,
    Passes,
    Terminal,
    Bay,
    Storey,
    Mirror,
    Zoom,
    Pan,
    Rise,
    Wall,
    Top,
    Fit,
    Round,
    Core,
    Along,
    Across,
    Swing
};

/// A stretch of half a period that has one facade id.
struct FacadeBay {
    double from;  ///< share of half a period, 0 … 1, where triangle wave |2(mod(x, w)/w − 1/2)| begins to be in it
    int id;       ///< 0 … 3
};
/// Algorithm 2's three folds at r, read as |2(mod(x, w)/w − 1/2)| and |u − r| − r, over half a period: bays in the
/// order of the triangle wave. Slivers below a thousandth are left out.
std::vector<FacadeBay> baysOf(const double r[3]);

/// Which cell of the facade a place is in.
struct FacadeCell {
    int idX = 0, idZ = 0, storey = 0;
};
/// Of a place in metres from the scope's middle.
FacadeCell facadeCell(std::span<const Argument> arguments, Vec3d half, Vec3d p);

/// What an ornament's passes leave of its widest parts.
struct FacadeDetail {
    double width_m = 0;  ///< of the bars and holes of the last pass; those of the pass before are `scale` times as wide
    int passes = 1;
    double scale = 3;
};
/// Of a facade over a scope of half-sizes `half`.
FacadeDetail facadeDetail(std::span<const Argument> arguments, Vec3d half);

/// A solid and who owns its surface and the ornament's (0: the solid's own origins stand).
struct Clad {
    Field solid;
    OriginId origin = 0, ornament = 0;
};
/// `c.solid` as the outer shell, an inner one `wall` inside it, less so at the top and not at the foot, and the facade
/// between them. `in.p` is the place in the scope's frame, whose y axis points along `up` in the object's frame.
Field clad(const PrimitiveInput& in, const Clad& c, Vec3d up);

}  // namespace sgm::field
