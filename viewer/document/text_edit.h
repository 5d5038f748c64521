// A change of text as a value: what an edit does, what undo keeps.
// Enters: texts. Leaves: edits, and texts with edits in them. Assumes bytes; an edit fits the text that it was made
// for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sgm::document {

/// Bytes [begin, end) go, `replacement` stands in their place.
struct TextEdit {
    uint32_t begin = 0, end = 0;
    std::string replacement;

    /// Nothing goes and nothing comes.
    bool empty() const { return begin == end && replacement.empty(); }
    friend bool operator==(const TextEdit&, const TextEdit&) = default;
};

/// `text` after the edit. An edit past the end of the text is cut there.
std::string applied(std::string_view text, const TextEdit& edit);

/// What takes `edit` of `before` back.
TextEdit inverse(std::string_view before, const TextEdit& edit);

/// One edit that makes `after` of `before`: what both share at either end stays.
TextEdit difference(std::string_view before, std::string_view after);

/// One edit that does what all of them do to `text`. They must not overlap; their order doesn't count.
TextEdit merged(std::string_view text, std::vector<TextEdit> edits);

}  // namespace sgm::document
