#include "viewer/document/problems.h"

#include <charconv>

namespace sgm::document {
namespace {

/// Reads "NUMBER:" off the end of `text` (without the colon), or gives 0.
uint32_t takeNumber(std::string_view& text) {
    const size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return 0;
    uint32_t number = 0;
    const auto [end, bad] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), number);
    if (bad != std::errc() || end != text.data() + text.size()) return 0;
    text = text.substr(0, colon);
    return number;
}

}  // namespace

std::vector<Problem> problemsOf(const syntax::Diagnostics& diagnostics) {
    std::vector<Problem> rows;
    for (const syntax::Diagnostic& d : diagnostics.all()) {
        Problem row{d.severity, {}, 0, 0, 0, 0, d.message, d.hint};
        if (d.span.source) {
            const auto begin = d.span.source->place(d.span.begin), end = d.span.source->place(d.span.end);
            row.file = d.span.source->name();
            row.line = begin.line, row.column = begin.column;
            row.endLine = end.line, row.endColumn = end.column;
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

Problem problemOf(const Error& error) {
    Problem row;
    row.message = error.message;
    for (size_t at = error.message.find(": "); at != std::string::npos; at = error.message.find(": ", at + 1)) {
        std::string_view place = std::string_view(error.message).substr(0, at);
        const uint32_t column = takeNumber(place), line = column ? takeNumber(place) : 0;
        if (!line) continue;
        row.file = place;
        row.line = row.endLine = line;
        row.column = row.endColumn = column;
        row.message.erase(0, at + 2);
        break;
    }
    return row;
}

}  // namespace sgm::document
