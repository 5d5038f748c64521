// A way of deriving as text: the `derive` line of a grammar.
// Enters: the steps of a session. Leaves: text. Assumes that the grammar's first source is the file to be written.
#pragma once

#include <span>
#include <string>

#include "grammar/rules/grammar.h"

namespace sgm::derive {

/// "derive NAME: R0 => R2 at Figure/I0 => R4" with its line end, broken where it would be wider than 100 columns.
std::string wayText(const rules::Grammar& grammar, const std::string& name, std::span<const rules::Derive::Step> steps);

/// The grammar's own file with `line` in it: in place of the way of that name, else after its last `derive` line, else
/// at its end. All other bytes stay.
std::string fileWithWay(const rules::Grammar& grammar, const std::string& name, const std::string& line);

}  // namespace sgm::derive
