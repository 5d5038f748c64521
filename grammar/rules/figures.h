// What `check … expect` may ask for.
// Enters: a name. Leaves: a figure of derivations. For this folder's sources alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/rules/grammar.h"
#include "grammar/rules/typed.h"

namespace sgm::rules {

/// The figure of that name: of the shape tree, of a town, or the sum of what is reported; nothing where there is none.
std::optional<Typed> findFigure(const Grammar& grammar, const syntax::Expr& e);
/// All their names.
std::vector<std::string> figureNames(const Grammar& grammar);

}  // namespace sgm::rules
