// The one selection of the window: a node of the text with a shape that it made.
// Enters: what was clicked, and every new model. Leaves: the shape, and the document's node and path. Assumes that the
// document and the models are of one window; ids are of the model last given.
#pragma once

#include <string>

#include "viewer/document/picking.h"

namespace sgm::document {

class Selection {
public:
    /// Of the model last given, or none.
    derive::ShapeId shape() const { return shape_; }

    /// Selects a shape, and the text that made it where that is the document's; none clears both.
    void selectShape(Document& document, const BuiltModel& model, derive::ShapeId shape);
    /// Selects a row of the document's text, and what it made: asked again for the same, the next of several. Where the
    /// model isn't of the present text yet (or null), the shape comes with it.
    void selectRow(Document& document, const BuiltModel* model, const RuleRow& row);
    /// Finds the selection again in another model, null for none: by the text while that is there, which edits may have
    /// changed, else by the shape's path. Without `byText` the path alone counts, as while one derives by hand.
    void resolve(Document& document, const BuiltModel* model, bool byText = true);

    /// What the user should know of the last call, "" for nothing; once.
    std::string takeNotice() { return std::exchange(notice_, {}); }

private:
    void choose(Document& document, const BuiltModel& model, const std::vector<derive::ShapeId>& made, size_t index);
    void clear(Document& document);

    derive::ShapeId shape_ = derive::none;
    size_t index_ = 0;      ///< of the shape among those that its text made
    bool ofText_ = false;   ///< there was a node: where an edit took it out, its shape goes too
    bool waiting_ = false;  ///< for the model of the present text
    std::string notice_;
};

}  // namespace sgm::document
