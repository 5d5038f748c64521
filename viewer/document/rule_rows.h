// The Rules panel: the grammar's rule tree as rows, each with its node, so that a click can change it (edits.h).
// Enters: a syntax tree. Leaves: rows in the order of the text, a row's parts below it and one deeper. Assumes that
// rows are used no longer than the tree lives: they point into it.
#pragma once

#include <string>
#include <vector>

#include "grammar/syntax/ast.h"
#include "viewer/document/text_edit.h"

namespace sgm::document {

struct RuleRow {
    enum class Kind : uint8_t {
        Start,      ///< `start`, rule is null
        Rule,       ///< rule
        Part,       ///< `when`, `weight`, `repeat`, `beside` of a rule: `word` says which
        Finally,    ///< the body behind `finally`; rule
        Element,    ///< element
        Attribute,  ///< element, attribute
        Case,       ///< part: label: body or { … }*, of a split or a choice
    };
    Kind kind = Kind::Rule;
    uint32_t depth = 0;
    uint32_t sibling = 0;     ///< Element: in which of the body's chains, from 0; a comma stands between two
    bool first = false;       ///< Element: of its chain; Attribute: of an element without a row, the first of its chain
    std::string text;         ///< in one line, without what has rows of its own: "+ sphere : A"
    std::string word;         ///< Part, Attribute: "when", "at"
    syntax::SourceSpan span;  ///< of the whole node
    const syntax::RuleDecl* rule = nullptr;    ///< the rule it belongs to; null in a start
    const syntax::StartDecl* start = nullptr;  ///< the start it belongs to; null in a rule
    const syntax::Element* element = nullptr;
    const syntax::Attribute* attribute = nullptr;
    const syntax::Case* part = nullptr;
    const syntax::Expr* expression = nullptr;  ///< what `setExpression` would change: of a Part, a Case's label
};

/// Starts and rules in the order of the text, with all that stands in them. An element that only has attributes, as a
/// split, has no row of its own where it has no operator either: those of its attributes stand for it.
std::vector<RuleRow> ruleRows(const syntax::Ast& ast);

/// The row whose node is the smallest that holds the byte, or the number of rows where none does.
size_t rowAt(const std::vector<RuleRow>& rows, uint32_t offset);

/// What is selected in the text: a node, by the kind of its row.
struct SelectedNode {
    TextRange range;  ///< of no bytes where only the begin is known: then the outermost row that begins there is meant
    RuleRow::Kind kind = RuleRow::Kind::Rule;
    friend bool operator==(const SelectedNode&, const SelectedNode&) = default;
};
/// The row of a selected node, or the number of rows where it is gone: that which begins there, or else the smallest of
/// its kind around its first byte.
size_t rowOf(const std::vector<RuleRow>& rows, const SelectedNode& node);
/// The row of the node with these bytes, or else the smallest that holds them all.
size_t rowOf(const std::vector<RuleRow>& rows, TextRange range);

}  // namespace sgm::document
