// `use "name"`: the files of a grammar, each once.
// Enters: the main file's Ast and a Loader. Leaves: Asts in the order their declarations count: a used file before its
// user. Assumes the loader refuses what lies outside the file's folder or std/.
#pragma once

#include <vector>

#include "grammar/rules/check.h"

namespace sgm::rules {

/// The Asts of `main` and everything it uses, `main` last. Cycles and files that can't be had become errors at the `use`.
std::vector<syntax::Ast> withUses(const syntax::Ast& main, const Loader& load, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
