// The verbs of the Rules and Parameters panels, each a minimal edit of the text at the span of what it changes.
// Enters: a syntax tree and a node of it. Leaves: one TextEdit of its source; comments and layout around it stay.
// Assumes that the node belongs to the tree. Every edit is tried before it is given: one that would leave the text
// unreadable is refused with the parser's words (Error::Input), and so are verbs that make no sense where they are
// asked for. What a text means is for `check` to judge: a rule for an unknown shape can be written.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/syntax/ast.h"
#include "modeler/core/result.h"
#include "viewer/document/text_edit.h"

namespace sgm::document::edits {

using syntax::Ast;
using syntax::Element;
using syntax::RuleDecl;
using Edit = Result<TextEdit>;

// --- Rules ---
// `derive` lines follow: a rule keeps being called in them, by its name or as "Cell#2" by its number among the
// nameless.

/// A new rule "rule SYMBOL -> BODY", behind `after`, or else behind the last rule of that symbol, else of all.
Edit addRule(const Ast& ast, std::string_view symbol, std::string_view body, const RuleDecl* after = nullptr);
/// A new rule or start as it is written: "Name when n > 2 -> BODY", "rule …", or "start …". Where the text has no
/// start, it is made the start. It stands behind `after`, a start behind the last one and else before the rules.
Edit addDeclaration(const Ast& ast, std::string_view written, const RuleDecl* after = nullptr);
/// Takes the rule's lines out, with comments in and behind them; those above it stay.
Edit removeRule(const Ast& ast, const RuleDecl& rule);
/// A copy right behind the rule. A copy of a named rule takes the next free name: R1, then R1b, R1c …
Edit duplicateRule(const Ast& ast, const RuleDecl& rule);
/// Puts the rule before another, or behind the last (null); comments right above it go with it. Order matters among the
/// rules of one symbol.
Edit moveRule(const Ast& ast, const RuleDecl& rule, const RuleDecl* before);
/// Names the rule; "" takes its name away.
Edit setName(const Ast& ast, const RuleDecl& rule, std::string_view name);
/// The shape the rule matches.
Edit setSymbol(const Ast& ast, const RuleDecl& rule, std::string_view symbol);
/// `when`, `weight`, `repeat` (expressions) and `beside` (a name); "" takes the part out.
Edit setGuard(const Ast& ast, const RuleDecl& rule, std::string_view condition);
Edit setWeight(const Ast& ast, const RuleDecl& rule, std::string_view weight);
Edit setRepeat(const Ast& ast, const RuleDecl& rule, std::string_view count);
Edit setBeside(const Ast& ast, const RuleDecl& rule, std::string_view symbol);

// --- What stands in a body ---

/// `text`, an element as it is written ("+ sphere at +y"), behind another in its chain.
Edit addElement(const Ast& ast, const Element& after, std::string_view text);
/// The last element of a body becomes `nil` where it was the content; one that grew can't go: delete the rule.
Edit removeElement(const Ast& ast, const Element& element);
/// A copy right behind it; a copy of a content is added to it (+).
Edit duplicateElement(const Ast& ast, const Element& element);
/// Exchanges it with the neighbour `by` places (−1 or 1) along in its chain; the first stays the content.
Edit moveElement(const Ast& ast, const Element& element, int by);
/// `by` goes with a morph when the operator becomes another. None makes the first of a chain the content.
Edit setOperator(const Ast& ast, const Element& element, syntax::Operator op);
/// The solid or symbol that is placed: "sphere", "morph(cube, sphere, .3)".
Edit setSolid(const Ast& ast, const Element& element, std::string_view solid);
/// `: Name`; "" takes it out.
Edit setLive(const Ast& ast, const Element& element, std::string_view name);
/// What an attribute says, "+x" for At, "(0, .2, 0)" for Shift: changes the one that stands there, or adds it. A
/// calculation is put in parentheses.
Edit setAttribute(const Ast& ast, const Element& element, const syntax::Operation& operation,
                  std::string_view arguments);
/// Nothing to take out is an error.
Edit removeAttribute(const Ast& ast, const Element& element, const syntax::Operation& operation);
/// Joins the element at `joint` of its host: `at JOINT`, and no `to` that named a face. What dragging a shape onto a
/// joint does; see `attach` in picking.h.
Edit attach(const Ast& ast, const Element& element, std::string_view joint);
/// Any expression of the text: an argument of a solid, a range's end, the condition of a loop.
Edit setExpression(const Ast& ast, const syntax::Expr& expression, std::string_view text);
/// The body of a rule, a start, a case or a loop, whole.
Edit setBody(const Ast& ast, const syntax::Body& body, std::string_view text);

// --- Parts of a block: `label: body` of a split, faces or a choice, and { … }* ---
// A bar stands between two: it comes and goes with them, in a line of its own or not as the others stand.

using syntax::Case;

/// `text`, a part as it is written ("~1: cube", "{ ~2m: Tile }*"), behind another of its block.
Edit addPart(const Ast& ast, const Case& after, std::string_view text);
/// The last one of a block can't go: delete what the block belongs to.
Edit removePart(const Ast& ast, const Case& part);
/// A copy right behind it.
Edit duplicatePart(const Ast& ast, const Case& part);
/// Exchanges it with the neighbour `by` places (−1 or 1) along in its block.
Edit movePart(const Ast& ast, const Case& part, int by);
/// What stands before its colon, a size or a word: "1.5m", "~1", "100% - 2m", "tag street".
Edit setPartLabel(const Ast& ast, const Case& part, std::string_view label);
/// How often { … } repeats: "*", "+", or a count, "3" or "(n + 1)".
Edit setPartTimes(const Ast& ast, const Case& part, std::string_view times);
/// The parts among which this one stands; null where it isn't one of the tree.
const std::vector<Case>* partsAround(const Ast& ast, const Case& part);
/// A way to divide a shape's scope into parts, or to repeat it.
struct Division {
    const char* name;  ///< "split { }*"
    const char* text;  ///< as it is written, S for the shape: "split x { { ~1m: S }* }"
    const char* doc;
};
std::span<const Division> divisions();
/// The shape becomes parts of its scope, each with the shape in it; its attributes stay those of the whole. Refused for
/// a shape that rules go on with.
Edit divide(const Ast& ast, const Element& element, std::string_view division);
/// A part that fits the block of an attribute: "~1: cube" in a split, "1: cube" in a choice (null).
std::string samplePart(const syntax::Attribute* attribute);

// --- Values ---

/// One parameter's value as written: "7", "1.2m", "(1, 2, 3)", "#c8b090".
struct NamedValue {
    std::string name, value;
};
/// Where the panel writes a value: into the style called `style`, or, where that is "", to where the value comes from
/// for `start`: its default style, then any default style, then a `use { … }`, then the `param` itself. A parameter of
/// a used file is set in the first `use { … }`. One edit for all; the values of other parameters stay as they are
/// written.
Edit setValues(const Ast& ast, std::string_view start, std::string_view style, const std::vector<NamedValue>& values);
/// A style with these values: "style NAME for START { … }", in place of the one of that name, or behind the last one.
Edit saveStyle(const Ast& ast, std::string_view name, std::string_view start, const std::vector<NamedValue>& values);
/// A new parameter as it is written, "width = 8m in 4m..20m": behind the last one, or else behind what is used.
Edit addParameter(const Ast& ast, std::string_view written);
/// What a number that becomes a parameter counts: a bare number of metres gets its unit.
enum class Quantity { Count, Real, Metres };
/// A number of the text becomes a parameter of this name, or the next free one, which ranges from its half to its
/// double.
Edit makeParameter(const Ast& ast, const syntax::Expr& number, std::string_view name, Quantity quantity);
/// Takes a setting out of a style, so that the default counts again.
Edit removeSetting(const Ast& ast, std::string_view start, std::string_view style, std::string_view param);
Edit removeStyle(const Ast& ast, std::string_view name, std::string_view start);

}  // namespace sgm::document::edits
