// Text from outside as a terminal may show it.
// Enters: bytes of any kind. Leaves: UTF-8 without control characters. Assumes nothing.
#pragma once

#include <string>
#include <string_view>

namespace sgm {

/// `text` with a '?' for every byte that belongs to a control character, to a mark that turns the direction of writing
/// around, or to no UTF-8 character. Tabs stay, and line ends where `keepsLines`. As many bytes as before.
std::string printable(std::string_view text, bool keepsLines = false);

/// `text` cut to at most `most` bytes with "…" behind it; a character is never cut in two.
std::string shortened(std::string_view text, size_t most);

}  // namespace sgm
