// Changes that a text may be given: renaming, fixes of problems, layout; and its outline.
// Enters: an Analysis. Leaves: edits of its files, or why there are none. Assumes the analysis is of the present text.
#pragma once

#include <functional>

#include "grammar/language/text.h"
#include "grammar/language/words.h"
#include "modeler/core/result.h"

namespace sgm::language {

struct Edit {
    syntax::SourceSpan span;
    std::string text;
};

/// All occurrences of what stands at `offset`, in every file of the analysis; the defining ones left out unless asked
/// for.
std::vector<Occurrence> referencesAt(const Analysis& analysis, uint32_t offset, bool withDefinitions);

/// The edits that give what stands at `offset` another name. Error::Input where the name can't be, is taken, or is
/// declared in the standard library.
Result<std::vector<Edit>> rename(const Analysis& analysis, uint32_t offset, const std::string& name);

/// A change that takes a problem away.
struct Fix {
    std::string title;
    Edit edit;
};

/// What the fix of a problem says, as an edit that was tried: of all ways to read it, `extra` among them, the one that
/// leaves the least. `check` weighs the problems of a text; more where one with that message still begins at that
/// offset.
std::vector<Fix> fixesOf(
    const syntax::Source& source, const syntax::Diagnostic& problem, const std::vector<Edit>& extra,
    const std::function<size_t(const std::string& text, std::string_view message, uint32_t offset)>& check);

/// An entry of the outline: a declaration.
struct Entry {
    NameKind kind = NameKind::Symbol;
    std::string name, detail;
    syntax::SourceSpan span, nameSpan;
};
std::vector<Entry> outlineOf(const Analysis& analysis);

/// Lines [first, last] that may be folded: declarations, blocks and comments of several lines; from 0.
struct Fold {
    uint32_t first = 0, last = 0;
    bool comment = false;
    friend auto operator<=>(const Fold&, const Fold&) = default;
};
std::vector<Fold> foldsOf(const Analysis& analysis);

/// A stretch of the text of one kind, for colours. Strings and comments are stretches too; blanks and signs aren't.
enum class TokenKind : uint8_t {
    Keyword,
    Operation,
    Solid,
    Shape,
    Terminal,
    Parameter,
    Value,
    Function,
    Joint,
    Rule,
    Number,
    Text,
    Comment
};
struct Stretch {
    uint32_t begin = 0, end = 0;
    TokenKind kind = TokenKind::Keyword;
    bool defines = false;
};
std::vector<Stretch> stretchesOf(const Analysis& analysis);

}  // namespace sgm::language
