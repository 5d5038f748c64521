// What `value` can't read or find of what files say of outlines.
// Enters: a checked grammar and its files. Leaves: warnings with the file, the feature and the text.
#pragma once

#include "grammar/rules/check_context.h"

namespace sgm::rules {

/// Warns of properties in files whose text a `value` can't read as a number, once a file and property.
void warnOfUnreadValues(CheckContext& ctx);

/// Warns of `value` and `word` behind a `footprint file(…)` of the same shape, whose outline reaches only what stands
/// below; where nothing above could bring another outline.
void findValuesOfOwnOutline(const Grammar& grammar, syntax::Diagnostics& diagnostics);

}  // namespace sgm::rules
