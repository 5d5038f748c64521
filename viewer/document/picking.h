// From a picked surface to its shape, its rule and its text, and back.
// Enters: an OriginId (of a hit or a triangle), a shape, or a place in the text. Leaves: the others. Assumes ids of the
// very model they are asked of; a selection outlives models as a path.
#pragma once

#include <optional>

#include "grammar/derive/faces.h"
#include "viewer/document/edits.h"
#include "viewer/document/rule_rows.h"
#include "viewer/document/session.h"

namespace sgm::document {

/// What is known of a shape: for the hover label and the selection.
struct Picked {
    derive::ShapeId shape = derive::none;
    std::string path, symbol, rule;  ///< rule "" for the start
    syntax::SourceSpan element;      ///< the text that made it; may lie in a used file
    syntax::SourceSpan ruleText;     ///< the rule or start that has it
};
Picked about(const derive::Derivation& derivation, derive::ShapeId shape);
/// The shape that owns surface of this origin; nothing for an origin that no shape has.
std::optional<Picked> pick(const BuiltModel& shown, OriginId origin);

/// The face of the shape on which a point of its surface lies, in the picture's space: sides, tops, slopes, eaves and
/// gables, with the words that `each(…)` and `faces { … }` call it by.
std::optional<derive::NamedFace> faceAt(const BuiltModel& shown, derive::ShapeId shape, Vec3d point);
/// What a label says of it: "slope: front, street".
std::string labelOf(const derive::NamedFace& face);

/// The shape that a selection means in this tree, or none.
derive::ShapeId selected(const derive::ShapeTree& tree, const std::string& path);

/// The shapes that a row's text made, in tree order: those of the element itself, or else the topmost of what stands in
/// it; of an attribute those of its element, of a rule's part those of the rule. Costs one look at every shape.
std::vector<derive::ShapeId> shapesOf(const derive::Derivation& derivation, const RuleRow& row);
/// The origins under which the shape, or anything below it, owns surface: what to light up in the view.
std::vector<OriginId> originsOf(const BuiltModel& shown, derive::ShapeId shape);

/// True when the model was made from the document's present text, so that its spans are spans of that text.
bool isCurrent(const Document& document, const BuiltModel& shown);
/// The element that made the shape, in the document's own syntax tree; null when it stands in a used file, or the model
/// isn't current.
const syntax::Element* elementOf(const Document& document, const BuiltModel& shown, derive::ShapeId shape);

/// The shapes at whose joints `moved` can be joined: that on which its rule puts it, and those that fill the same
/// place. Error::Input, in words, where there is none. Costs one look at every shape.
Result<std::vector<derive::ShapeId>> hostsFor(const Document& document, const BuiltModel& shown, derive::ShapeId moved);
/// Joins `moved` at a joint of `host`: what dropping a shape on a joint asks for. Error::Input, in words, where the
/// grammar can't say so: the element is joined to another shape than `host` (with the rule that would join it), it is
/// the content of its shape, it stands in a used file.
edits::Edit attach(const Document& document, const BuiltModel& shown, derive::ShapeId moved, derive::ShapeId host,
                   uint32_t joint);

}  // namespace sgm::document
