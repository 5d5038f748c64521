#include "viewer/document/line_edits.h"

#include <algorithm>
#include <vector>

#include "modeler/core/lower_case.h"

namespace sgm::document {
namespace {

constexpr std::string_view step = "  ", sign = "//";

uint32_t endOfLine(const std::string& text, uint32_t at) {
    return static_cast<uint32_t>(std::min(text.find('\n', at), text.size()));
}

/// How many blanks a line begins with, or nothing for one that has nothing else.
std::optional<uint32_t> indentOf(const std::string& text, uint32_t start) {
    const size_t first = text.find_first_not_of(" \t", start);
    if (first >= endOfLine(text, start)) return std::nullopt;
    return static_cast<uint32_t>(first) - start;
}

/// Where the lines begin that the selection reaches into and that aren't empty.
std::vector<uint32_t> linesOf(const EditedText& edited) {
    const auto [from, to] = std::minmax(edited.caret, edited.anchor);
    uint32_t start = from;
    while (start > 0 && edited.text[start - 1] != '\n') --start;
    std::vector<uint32_t> lines;
    do {
        if (indentOf(edited.text, start)) lines.push_back(start);
        start = endOfLine(edited.text, start) + 1;
    } while (start < to);
    return lines;
}

/// Puts `by` in place of `length` bytes; caret and anchor stay with what they stood at.
void replace(EditedText& edited, uint32_t at, uint32_t length, std::string_view by) {
    const bool isSelected = edited.caret != edited.anchor;
    const auto size = static_cast<uint32_t>(by.size());
    const auto follow = [&](uint32_t& place) {
        // What is selected from a line's start keeps its first blanks.
        if (place < at || (place == at && isSelected)) return;
        place = place < at + length ? at + size : place + size - length;
    };
    edited.text.replace(at, length, by);
    const uint32_t caret = edited.caret;
    follow(edited.caret);
    caret == edited.anchor ? void(edited.anchor = edited.caret) : follow(edited.anchor);
}

}  // namespace

EditedText indented(EditedText edited, bool back) {
    const std::vector<uint32_t> lines = linesOf(edited);
    // From the last on, so that the places of the others stay.
    for (size_t i = lines.size(); i-- > 0;) {
        if (!back) {
            replace(edited, lines[i], 0, step);
            continue;
        }
        const uint32_t blanks = *indentOf(edited.text, lines[i]);
        const bool isTab = blanks > 0 && edited.text[lines[i]] == '\t';
        replace(edited, lines[i], isTab ? 1 : std::min<uint32_t>(blanks, static_cast<uint32_t>(step.size())), "");
    }
    return edited;
}

EditedText commented(EditedText edited) {
    const std::vector<uint32_t> lines = linesOf(edited);
    const auto isComment = [&](uint32_t start) {
        return std::string_view(edited.text).substr(start + *indentOf(edited.text, start)).starts_with(sign);
    };
    const bool back = std::all_of(lines.begin(), lines.end(), isComment);
    uint32_t column = ~uint32_t(0);
    for (const uint32_t start : lines) column = std::min(column, *indentOf(edited.text, start));
    for (size_t i = lines.size(); i-- > 0;) {
        if (!back) {
            replace(edited, lines[i] + column, 0, "// ");
            continue;
        }
        const uint32_t at = lines[i] + *indentOf(edited.text, lines[i]);
        const auto length = static_cast<uint32_t>(sign.size());
        replace(edited, at,
                edited.text[std::min<size_t>(at + length, edited.text.size() - 1)] == ' ' ? length + 1 : length, "");
    }
    return edited;
}

std::optional<std::pair<uint32_t, uint32_t>> occurrence(std::string_view text, std::string_view word, uint32_t from,
                                                        bool backward) {
    if (word.empty()) return std::nullopt;
    const std::string all = lowerCase(std::string(text)), sought = lowerCase(std::string(word));
    size_t at = std::string::npos;
    if (!backward) {
        at = all.find(sought, from);
        if (at == std::string::npos) at = all.find(sought);
    } else {
        if (from > 0) at = all.rfind(sought, from - 1);
        if (at == std::string::npos) at = all.rfind(sought);
    }
    if (at == std::string::npos) return std::nullopt;
    return std::pair(static_cast<uint32_t>(at), static_cast<uint32_t>(at + sought.size()));
}

}  // namespace sgm::document
