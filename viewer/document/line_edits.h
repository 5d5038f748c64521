// Edits of whole lines, as editors of text have them.
// Enters: a text, a caret and the other end of what is selected. Leaves: the same after the edit. Assumes UTF-8, and
// places within the text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace sgm::document {

/// A text with its caret; `anchor` is the other end of the selection, the caret itself where nothing is selected.
struct EditedText {
    std::string text;
    uint32_t caret = 0, anchor = 0;  ///< bytes
    friend bool operator==(const EditedText&, const EditedText&) = default;
};

/// Two spaces before every line that the selection reaches into, or the caret's; `back`: up to two spaces, or a tab,
/// less. Empty lines stay. A line at whose start the selection ends isn't reached.
EditedText indented(EditedText edited, bool back);

/// Makes comments of these lines (`// `, at the least indented one's column), or takes the signs away where all of them
/// are comments. Empty lines don't count.
EditedText commented(EditedText edited);

/// Where `word` next begins and ends in `text`: at or behind `from`, or `backward` before it, and round past the
/// end. Capitals of ASCII don't count. Nothing where it isn't there or is empty.
std::optional<std::pair<uint32_t, uint32_t>> occurrence(std::string_view text, std::string_view word, uint32_t from,
                                                        bool backward);

}  // namespace sgm::document
