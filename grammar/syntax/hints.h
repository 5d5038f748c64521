// What writers bring along from other languages, and how it is written here.
// Enters: where a declaration can't be read. Leaves: a message with its fix, where one is known.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grammar/syntax/cursor.h"

namespace sgm::syntax {

/// A better report than "unexpected …".
struct Hint {
    SourceSpan span;
    std::string message, hint;
};

/// Recognizes habits of other languages at the cursor: ';', '#' comments, '2,5', 'if', 'else', names beyond ASCII.
/// `message` and the token at the cursor stay where the habit needs no other.
std::optional<Hint> findHint(const Cursor& cursor, std::string_view message);

/// The declaration that a word of another language stands for ("import": "use"; "" where its line is written another
/// way), with the fix; null for other words.
struct ForeignDeclaration {
    std::string_view word, means, hint;
};
const ForeignDeclaration* findForeignDeclaration(std::string_view word);

/// What an attribute's name of another program is here ("rotate": "write 'turn'"); empty for other words.
std::string foreignAttributeHint(std::string_view word);

/// What a function of another language is here ("mod": "write 'a % b'"); empty for other words.
std::string foreignFunctionHint(std::string_view word);

}  // namespace sgm::syntax
