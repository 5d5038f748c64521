// What is asked of a grammar by place or by name.
// Enters: a grammar, checked or still being checked. Leaves: indices and versions.
#pragma once

#include <string_view>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

/// The version of the language that the text of `span` is written in; 1 where nobody knows. O(files).
inline int versionOf(const Grammar& grammar, SourceSpan span) {
    for (size_t i = 0; i < grammar.sources.size() && i < grammar.versions.size(); ++i)
        if (grammar.sources[i].get() == span.source) return grammar.versions[i];
    return 1;
}

/// The `material` or terminal called `name`, as an index into `symbols`; none where there is none. O(symbols).
inline SymbolId findMaterial(const Grammar& grammar, std::string_view name) {
    for (SymbolId i = 0; i < grammar.symbols.size(); ++i)
        if (grammar.symbols[i].terminal && grammar.symbols[i].name == name) return i;
    return none;
}

}  // namespace sgm::rules
