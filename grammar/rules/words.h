// Words that mean something by themselves.
// Enters: names as written. Leaves: what kind of name it is. Assumes ASCII capitals.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sgm::rules {

/// Symbols with a capital may still be rewritten (V_N); lower case is terminal (V_T).
bool isNonTerminal(std::string_view name);

/// A word of the language that parameters, locals and terminals can't be called.
bool isTaken(std::string_view name);

/// 0 … 5 for +x −x +y −y +z −z, 6 for centre; −1 for any other word.
int axisNumber(std::string_view word);

/// "did you mean 'x'?" of the candidate that is nearest to `word`, or "" where none is near.
std::string nearestHint(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace sgm::rules
