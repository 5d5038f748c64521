// Places in a text as editors count them.
// Enters: a Source, byte offsets or positions. Leaves: the other one. Assumes UTF-8; lines and characters count from 0,
// a character being a unit of UTF-16.
#pragma once

#include "grammar/syntax/source.h"

namespace sgm::language {

struct Position {
    uint32_t line = 0, character = 0;
    friend auto operator<=>(const Position&, const Position&) = default;
};

/// Half-open.
struct Range {
    Position begin, end;
    friend bool operator==(const Range&, const Range&) = default;
};

/// The position of a byte offset; one within a character gives the character's begin.
Position positionOf(const syntax::Source& source, uint32_t offset);
Range rangeOf(syntax::SourceSpan span);

/// The byte offset of a position; one behind a line's end gives the line's end, one behind the text its end.
uint32_t offsetOf(const syntax::Source& source, Position position);

}  // namespace sgm::language
