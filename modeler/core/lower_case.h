// Text that is compared without regard to capitals: endings of files, words that come near a known one.
#pragma once

#include <string>

namespace sgm {

/// The text with 'A' to 'Z' as 'a' to 'z'; other bytes stay, in any locale.
inline std::string lowerCase(std::string text) {
    for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    return text;
}

}  // namespace sgm
