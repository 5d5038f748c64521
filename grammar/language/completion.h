// What may be written at a place of a text.
// Enters: an Analysis, an offset, the standard library. Leaves: items with docs. Assumes the analysis is of that text.
#pragma once

#include "grammar/language/words.h"

namespace sgm::language {

/// A file of the standard library as `use` names it.
struct LibraryFile {
    std::string name;  ///< "std/walls.sgm"
    syntax::SourcePtr source;
};

/// What an item is to an editor's eyes.
enum class ItemKind : uint8_t {
    Keyword,
    Operation,
    Solid,
    Shape,
    Parameter,
    Value,
    Function,
    Joint,
    Choice,
    File,
    Rule,
    Style
};

struct Item {
    ItemKind kind = ItemKind::Keyword;
    std::string label;
    std::string detail;    ///< a few words beside the label
    std::string doc;       ///< Markdown
    std::string use = {};  ///< the library's file that must be used for it, "" for none
};

/// Everything that may begin or go on the word at `offset`, by kind and then by name. The editor filters by what is
/// typed.
std::vector<Item> completionsAt(const Analysis& analysis, uint32_t offset, const std::vector<LibraryFile>& library);

/// Where a `use` line belongs: behind the last one, or behind the version.
uint32_t useOffset(const Analysis& analysis);

}  // namespace sgm::language
