#include "modeler/core/printable.h"

#include <cstdint>

namespace sgm {
namespace {

constexpr bool continues(unsigned char c) { return (c & 0xc0) == 0x80; }

/// Bytes of the UTF-8 character at the beginning of `text`, with its code point; 0 where there is none.
size_t decode(std::string_view text, uint32_t& code) {
    const auto first = static_cast<unsigned char>(text[0]);
    const size_t length = first < 0x80   ? 1
                          : first < 0xc2 ? 0
                          : first < 0xe0 ? 2
                          : first < 0xf0 ? 3
                          : first < 0xf5 ? 4
                                         : 0;
    if (length == 0 || length > text.size()) return 0;
    code = length == 1 ? first : first & (0x7fu >> length);
    for (size_t i = 1; i < length; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if (!continues(next)) return 0;
        code = code << 6 | (next & 0x3fu);
    }
    constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool isSurrogate = code >= 0xd800 && code < 0xe000;
    return code < least[length] || isSurrogate || code > 0x10ffff ? 0 : length;
}

bool isShown(uint32_t code, bool keepsLines) {
    if (code == '\n') return keepsLines;
    if (code < 0x20) return code == '\t';
    const bool control = code >= 0x7f && code < 0xa0;
    const bool turns =
        code == 0x200e || code == 0x200f || (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
    return !control && !turns;
}

}  // namespace

std::string printable(std::string_view text, bool keepsLines) {
    std::string out(text);
    for (size_t i = 0; i < text.size();) {
        uint32_t code = 0;
        const size_t length = decode(text.substr(i), code);
        const size_t bytes = length == 0 ? 1 : length;
        if (length == 0 || !isShown(code, keepsLines)) out.replace(i, bytes, bytes, '?');
        i += bytes;
    }
    return out;
}

std::string shortened(std::string_view text, size_t most) {
    if (text.size() <= most) return std::string(text);
    size_t end = most;
    while (end > 0 && continues(static_cast<unsigned char>(text[end]))) --end;
    return std::string(text.substr(0, end)) + "…";
}

}  // namespace sgm
