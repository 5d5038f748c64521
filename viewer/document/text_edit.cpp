#include "viewer/document/text_edit.h"

#include <algorithm>

namespace sgm::document {

std::string applied(std::string_view text, const TextEdit& edit) {
    const size_t begin = std::min<size_t>(edit.begin, text.size()),
                 end = std::clamp<size_t>(edit.end, begin, text.size());
    std::string result;
    result.reserve(text.size() - (end - begin) + edit.replacement.size());
    return result.append(text.substr(0, begin)).append(edit.replacement).append(text.substr(end));
}

TextEdit inverse(std::string_view before, const TextEdit& edit) {
    return {edit.begin, edit.begin + static_cast<uint32_t>(edit.replacement.size()),
            std::string(before.substr(edit.begin, edit.end - edit.begin))};
}

TextEdit difference(std::string_view before, std::string_view after) {
    const size_t shorter = std::min(before.size(), after.size());
    size_t head = 0, tail = 0;
    while (head < shorter && before[head] == after[head]) ++head;
    while (tail < shorter - head && before[before.size() - 1 - tail] == after[after.size() - 1 - tail]) ++tail;
    return {static_cast<uint32_t>(head), static_cast<uint32_t>(before.size() - tail),
            std::string(after.substr(head, after.size() - tail - head))};
}

TextEdit merged(std::string_view text, std::vector<TextEdit> edits) {
    if (edits.empty()) return {};
    std::stable_sort(edits.begin(), edits.end(),
                     [](const TextEdit& a, const TextEdit& b) { return a.begin < b.begin; });
    TextEdit all{edits.front().begin, edits.front().begin, {}};
    for (const TextEdit& edit : edits) {
        all.replacement += text.substr(all.end, edit.begin - all.end);
        if (edit.node) all.node = static_cast<uint32_t>(all.replacement.size()) + *edit.node;
        all.replacement += edit.replacement;
        all.end = edit.end;
    }
    return all;
}

std::optional<TextRange> followed(TextRange node, std::string_view before, const TextEdit& edit) {
    if (edit.node) return TextRange{edit.begin + *edit.node, edit.begin + *edit.node};
    const auto grown = static_cast<uint32_t>(edit.replacement.size() - (edit.end - edit.begin));  // modulo 2^32
    if (edit.end <= node.begin) return TextRange{node.begin + grown, node.end + grown};
    if (edit.begin >= node.end && edit.begin > node.begin) return node;
    if (edit.begin >= node.begin && edit.end <= node.end &&
        !(edit.replacement.empty() && edit.end == node.end && edit.begin == node.begin))
        return TextRange{node.begin, node.end + grown};
    if (edit.begin > node.begin) {  // its first bytes stay: is it still itself?
        const uint32_t middle = std::max(edit.begin, node.begin + (node.end - node.begin) / 2);
        const bool kept = edit.begin == middle ||
                          edit.replacement.find(before.substr(middle, node.end - middle)) != std::string::npos;
        return kept ? std::optional(TextRange{node.begin, edit.begin}) : std::nullopt;
    }
    // The edit begins before the node: what it leaves of the node's first bytes is found again in the replacement, near
    // its end where the node goes on behind it.
    const std::string_view text = before.substr(node.begin, std::min(node.end, edit.end) - node.begin);
    for (size_t bytes = text.size(); bytes > 0 && 2 * bytes >= text.size(); --bytes) {
        const std::string_view head = text.substr(0, bytes);
        const size_t again = node.end > edit.end ? edit.replacement.rfind(head) : edit.replacement.find(head);
        if (again == std::string::npos) continue;
        const uint32_t begin = edit.begin + static_cast<uint32_t>(again);
        return TextRange{begin, begin + static_cast<uint32_t>(bytes)};
    }
    return std::nullopt;
}

}  // namespace sgm::document
