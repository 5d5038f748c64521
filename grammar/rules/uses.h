// `use "name"`: the files of a grammar, each once.
// Enters: the main file's Ast and a Loader. Leaves: Asts in the order their declarations count: a used file before its
// user. Assumes the loader refuses what lies outside the file's folder or std/.
#pragma once

#include <vector>

#include "grammar/rules/check.h"

namespace sgm::rules {

struct Files {
    std::vector<syntax::Ast> asts;  ///< the main file last
    bool missing = false;           ///< a used file can't be had
};

/// `main` and everything it uses. Cycles and files that can't be had became errors at the `use`.
Files withUses(const syntax::Ast& main, const Loader& load, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
