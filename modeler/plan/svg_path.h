// The path language of SVG. For this folder's sources alone.
// Enters: the attribute `d`. Leaves: closed chains of points. Assumes nothing.
#pragma once

#include <string_view>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// An affine map: x' = a·x + c·z + e, z' = b·x + d·z + f.
struct SvgMatrix {
    double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;
    Vec2 operator()(Vec2 p) const { return {a * p.x + c * p.z + e, b * p.x + d * p.z + f}; }
    /// First `inner`, then this.
    SvgMatrix operator*(const SvgMatrix& inner) const;
};

/// The subpaths as rings; curves and arcs become 8 chords. At most `most` points, then an error, as for what is no
/// path.
Result<std::vector<std::vector<Vec2>>> svgPath(std::string_view text, size_t most);
/// "translate(3 4) rotate(30)" and the like; what isn't known is an error.
Result<SvgMatrix> svgTransform(std::string_view text);
/// The numbers of a list, separated by blanks and commas; nothing behind them.
Result<std::vector<double>> svgNumbers(std::string_view text, size_t most);

}  // namespace sgm::plan
