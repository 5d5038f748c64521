// A derivation as text and JSON, for `sgm tree`.
// Enters: a Derivation. Leaves: text. Assumes nothing; never recurses, and stops indenting at 40 levels.
#pragma once

#include <string>

#include "grammar/derive/derive.h"

namespace sgm::derive {

/// An indented tree: operator, symbol, solid, rule, bond with its partner, stream key; with `steps` the log before it.
std::string toText(const Derivation& derivation, bool steps);
/// {seed, start, classic, morphic, shapes: […], bonds: […], steps: […]}; shapes refer to each other by index.
std::string toJson(const Derivation& derivation);

}  // namespace sgm::derive
