// A change of text as a value: what an edit does, what undo keeps.
// Enters: texts. Leaves: edits, and texts with edits in them. Assumes bytes; an edit fits the text that it was made
// for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sgm::document {

/// Bytes [begin, end) of a text.
struct TextRange {
    uint32_t begin = 0, end = 0;
    friend bool operator==(const TextRange&, const TextRange&) = default;
};

/// Bytes [begin, end) go, `replacement` stands in their place.
struct TextEdit {
    uint32_t begin = 0, end = 0;
    std::string replacement;
    /// Where in the replacement the node begins that the edit adds or moves: what is selected after it.
    std::optional<uint32_t> node = {};

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

/// One edit that does what all of them do to `text`. They must not overlap; their order doesn't count. Its node is the
/// last of theirs.
TextEdit merged(std::string_view text, std::vector<TextEdit> edits);

/// Where a node of `before` stands after the edit: an edit's own node, which has no bytes yet, goes before it. What was
/// taken out is nowhere; what was written again as it was is found in the replacement.
std::optional<TextRange> followed(TextRange node, std::string_view before, const TextEdit& edit);

}  // namespace sgm::document
