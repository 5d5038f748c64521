// Numbers in texts, read the same in every locale.
#pragma once

#include <charconv>
#include <string_view>

namespace sgm {

/// The number that a text begins with, as "2.5", "1e-3", "inf"; 0 where it begins with none. The C locale doesn't
/// matter, as it does to std::stod, so that programs that link the library may set one.
inline double decimalOf(std::string_view text) {
    double number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

}  // namespace sgm
