// Parts of content operations that are called by words: `network { street: … | block: … }`.
// Enters: written blocks. Leaves: checked parts. Assumes one block at a time.
#pragma once

#include <span>
#include <string_view>

#include "grammar/rules/operation_checker.h"

namespace sgm::operations {

/// The parts of the block, each with one of `words` before it; others are errors that name them.
std::vector<rules::Parts::Part> checkWordParts(rules::OperationChecker& checker, const syntax::Attribute& written,
                                               std::span<const std::string_view> words);
/// The part called `label`, or null.
const rules::Parts::Part* findPart(const rules::Parts& parts, std::string_view label);

}  // namespace sgm::operations
