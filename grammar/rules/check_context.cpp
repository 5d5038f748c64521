#include "grammar/rules/check_context.h"

#include <algorithm>
#include <cctype>

namespace sgm::rules {
void SuppressedNames::read(const syntax::Diagnostics& unread, bool missingFile) {
    all_ = missingFile;
    const auto inWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (const syntax::Diagnostic& d : unread.all()) {
        if (d.severity != syntax::Severity::Error || !d.span.source) continue;
        const std::string_view line = d.span.source->line(d.span.source->place(d.span.begin).line);
        // A `use` that couldn't be read brings nothing, and nobody knows what it would have.
        all_ = all_ || line.starts_with("use");
        for (auto begin = line.begin(); begin != line.end();) {
            const auto end = std::find_if_not(begin, line.end(), inWord);
            if (end != begin) words_.emplace(begin, end);
            begin = end == line.end() ? end : end + 1;
        }
    }
}

}  // namespace sgm::rules
