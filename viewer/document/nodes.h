// Where nodes of a syntax tree stand: in their chain, in their lines, between tokens and comments.
// Enters: a syntax tree, nodes and offsets of it. Leaves: places for edits. Assumes the node belongs to the tree.
#pragma once

#include <functional>

#include "grammar/syntax/ast.h"
#include "viewer/document/edits.h"

namespace sgm::document::edits {

/// An element's place in the tree.
struct Place {
    const syntax::Body* body = nullptr;  ///< null: not in this tree
    size_t sibling = 0, index = 0;

    const std::vector<Element>& chain() const { return body->siblings[sibling]; }
};
Place placeOf(const Ast& ast, const Element& element);

/// Calls `visit` for every body of the tree, outer before inner, in the order of the text within starts and rules.
void forBodies(const Ast& ast, const std::function<void(const syntax::Body&)>& visit);

/// Where the last token that ends at or before `offset` ends, blanks and comments apart; and begins.
uint32_t endBefore(const Ast& ast, uint32_t offset);
uint32_t beginBefore(const Ast& ast, uint32_t offset);
/// The first token that begins at or behind `offset`.
syntax::SourceSpan tokenFrom(const Ast& ast, uint32_t offset);

/// First byte of the line, and the byte of its line end (the text's end in the last line).
uint32_t lineBegin(std::string_view text, uint32_t offset);
uint32_t lineEnd(std::string_view text, uint32_t offset);
/// Nothing but blanks from the line's begin to `offset`; nothing but blanks and a comment from `offset` to its end.
bool beginsLine(std::string_view text, uint32_t offset);
bool endsLine(std::string_view text, uint32_t offset);

/// Takes bytes [begin, end) out with the blanks before them, or a whole line where nothing else stands in it.
TextEdit removal(std::string_view text, uint32_t begin, uint32_t end);

/// The edit, if the text can still be read after it as well as before.
Edit tried(const Ast& ast, TextEdit edit);

/// A rule as `derive` lines tell it from others; `rule` is null for one that the text doesn't have yet.
struct ListedRule {
    const RuleDecl* rule;
    std::string symbol, name;
};
/// The rules of the text, in order.
std::vector<ListedRule> listed(const Ast& ast);
/// `tried` for an edit after which the rules are `now`: `derive` lines go on meaning the same ones.
Edit withWays(const Ast& ast, TextEdit edit, const std::vector<ListedRule>& now);

/// `text` as one expression that may stand where an attribute's argument does (in parentheses where it calculates), or
/// anywhere. Error::Input when it is none.
Result<std::string> asArgument(std::string_view text);
Result<std::string> asExpression(std::string_view text);
/// `text` as one name.
Result<std::string> asName(std::string_view text);

/// Error::Input with this sentence.
Error refused(std::string why);

}  // namespace sgm::document::edits
