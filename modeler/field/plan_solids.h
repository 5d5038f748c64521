// The rows of the primitive table that stand over the footprint of their scope: blocks and roofs.
// Enters: a footprint about the scope's centre, metres. Leaves: heights and fields. Assumes sound footprints
// (modeler/plan/validate.h) and their formulas.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "modeler/field/plan_numbers.h"
#include "modeler/field/primitives.h"
#include "modeler/plan/formula.h"

namespace sgm::field {

/// The height, metres above its foot, of a row of PlanUse::OwnHeight over a footprint: at most a hundredth too much.
/// `arguments` need their values alone. O(n log n) and a search of the footprint's depth, which the numbers keep.
double heightOver(const Primitive& row, const std::shared_ptr<const PlanNumbers>& numbers,
                  std::span<const Argument> arguments);

/// How far, metres, a row over a footprint stands out of the edges below it: the `out` of a moulding, the eaves of a
/// roof, the top of a block that leans outward. `arguments` need their values alone; `height_m` is that of the scope.
double standsOut_m(const Primitive& row, std::span<const Argument> arguments, double height_m);

/// What is wrong with the numbers of a row as a whole: the sentence of a moulding whose profile crosses itself; ""
/// where nothing is.
std::string profileFault(const Primitive& row, std::span<const Argument> arguments);

/// Which edges of a footprint a roof leaves as gables: where a ridge ends over them, those that face x or z, or all
/// that can.
enum class GableEnds : uint8_t { Auto, X, Z, All };
/// Their numbers, ascending, as in edgesOf(); edges at reflex corners can't be gables.
std::vector<uint32_t> gablesOf(const plan::Footprint& footprint, const plan::Formula& formula, GableEnds ends);

}  // namespace sgm::field
