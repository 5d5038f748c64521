#include "grammar/language/text.h"

#include <algorithm>

namespace sgm::language {
namespace {

/// Bytes of the character that begins with `first`, and its units of UTF-16.
struct Width {
    size_t bytes;
    uint32_t units;
};
Width widthOf(char first) {
    const auto byte = static_cast<unsigned char>(first);
    if (byte < 0xc0) return {1, 1};  // ASCII, or a byte that begins nothing
    if (byte < 0xe0) return {2, 1};
    if (byte < 0xf0) return {3, 1};
    return {4, 2};
}

}  // namespace

Position positionOf(const syntax::Source& source, uint32_t offset) {
    const auto place = source.place(offset);
    const std::string_view line = source.line(place.line);
    uint32_t units = 0;
    for (size_t at = 0; at < std::min<size_t>(place.column - 1, line.size());) {
        const Width width = widthOf(line[at]);
        if (at + width.bytes > place.column - 1) break;
        at += width.bytes;
        units += width.units;
    }
    return {place.line - 1, units};
}

Range rangeOf(syntax::SourceSpan span) {
    if (!span.source) return {};
    return {positionOf(*span.source, span.begin), positionOf(*span.source, std::max(span.begin, span.end))};
}

uint32_t offsetOf(const syntax::Source& source, Position position) {
    const auto size = static_cast<uint32_t>(source.text().size());
    if (position.line >= source.place(size).line) return size;
    const std::string_view line = source.line(position.line + 1);
    size_t at = 0;
    for (uint32_t units = 0; at < line.size() && units < position.character;) {
        const Width width = widthOf(line[at]);
        at = std::min(at + width.bytes, line.size());
        units += width.units;
    }
    return static_cast<uint32_t>(static_cast<size_t>(line.data() - source.text().data()) + at);
}

}  // namespace sgm::language
