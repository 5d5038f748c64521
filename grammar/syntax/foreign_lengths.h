// Lengths of other systems, as hints and maps convert them.
// Enters: nothing. Leaves: metres. Assumes the international units of 1959.
#pragma once

namespace sgm::syntax {

inline constexpr double foot_m = .3048, inch_m = .0254, yard_m = .9144;

}  // namespace sgm::syntax
