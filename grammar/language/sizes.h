// Sizes that an editor shows behind the elements of rules: those of the shapes that the elements make at the defaults.
// Enters: figures of a derivation. Leaves: hints at byte offsets. Assumes the figures are of the source's text.
#pragma once

#include <string>
#include <vector>

#include "grammar/language/analysis.h"

namespace sgm::language {

/// What an editor shows at a place without its being in the text.
struct SizeHint {
    uint32_t offset = 0;
    std::string label;   ///< "4 × 2.5…3 × 4 m"
    std::string detail;  ///< a sentence
};

/// A hint behind every element that made shapes, but where the element says that size itself; in the order of the text.
/// One of several lines has it at the end of its first line.
std::vector<SizeHint> sizeHints(const syntax::Source& source, const Figures& figures);

/// Moves hints along with a text of which [begin, end) is replaced by `length` bytes; those within go.
void shiftHints(std::vector<SizeHint>& hints, uint32_t begin, uint32_t end, uint32_t length);

}  // namespace sgm::language
