#include "viewer/document/selection.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::document {

using derive::none;
using derive::ShapeId;

namespace {

constexpr const char* madeNothing = "This text made no shape in the model that is shown";

std::optional<RuleRow> rowOfShape(const Document& document, const BuiltModel& model, ShapeId shape) {
    const syntax::SourceSpan span = model.model.derivation.tree.shapes[shape].span;
    if (!isCurrent(document, model) || span.source != model.grammar->sources[0].get()) return std::nullopt;
    const std::vector<RuleRow> rows = ruleRows(*document.ast());
    const size_t at = rowOf(rows, TextRange{span.begin, span.end});
    return at == rows.size() ? std::nullopt : std::optional(rows[at]);
}

}  // namespace

void Selection::clear(Document& document) {
    shape_ = none;
    document.select({});
}

void Selection::choose(Document& document, const BuiltModel& model, const std::vector<ShapeId>& made, size_t index) {
    index_ = index;
    shape_ = made[index];
    document.select(model.model.derivation.tree.path(shape_, true));
}

void Selection::selectShape(Document& document, const BuiltModel& model, ShapeId shape) {
    waiting_ = false;
    index_ = 0;
    clear(document);
    document.selectNode(std::nullopt);
    ofText_ = false;
    if (shape == none) return;
    shape_ = shape;
    document.select(model.model.derivation.tree.path(shape, true));
    const std::optional<RuleRow> row = rowOfShape(document, model, shape);
    if (!row) {
        const syntax::Source* file = model.model.derivation.tree.shapes[shape].span.source;
        if (file && file != model.grammar->sources[0].get())
            notice_ = fmt::format("Made by {}, which is no part of this text", file->name());
        return;
    }
    document.selectNode(SelectedNode{{row->span.begin, row->span.end}, row->kind});
    ofText_ = true;
    const std::vector<ShapeId> made = shapesOf(model.model.derivation, *row);
    const auto found = std::find(made.begin(), made.end(), shape);
    if (found != made.end()) index_ = static_cast<size_t>(found - made.begin());
}

void Selection::selectRow(Document& document, const BuiltModel* model, const RuleRow& row) {
    const SelectedNode node{{row.span.begin, row.span.end}, row.kind};
    const bool again = document.choice().node == node;
    document.selectNode(node);
    ofText_ = true;
    waiting_ = !model || !isCurrent(document, *model);
    if (waiting_) return clear(document);
    const std::vector<ShapeId> made = shapesOf(model->model.derivation, row);
    if (made.empty()) {
        notice_ = madeNothing;
        return clear(document);
    }
    const auto present = std::find(made.begin(), made.end(), shape_);
    size_t index = present == made.end() ? 0 : static_cast<size_t>(present - made.begin());
    if (again && present != made.end()) index = (index + 1) % made.size();
    choose(document, *model, made, index);
    if (made.size() > 1)
        notice_ = fmt::format("One of {} shapes that this text made; click again for the next", made.size());
}

void Selection::resolve(Document& document, const BuiltModel* model, bool byText) {
    const std::optional<SelectedNode> node = document.choice().node;
    const bool had = shape_ != none, gone = ofText_ && !node;
    shape_ = model ? selected(model->model.derivation.tree, document.choice().selection) : none;
    if (!model || !byText) return;
    ofText_ = node.has_value();
    if (gone) return clear(document);
    if (!node || !isCurrent(document, *model)) return;
    const std::vector<RuleRow> rows = ruleRows(*document.ast());
    const size_t row = rowOf(rows, *node);
    if (row == rows.size()) return clear(document);
    const std::vector<ShapeId> made = shapesOf(model->model.derivation, rows[row]);
    const bool asked = std::exchange(waiting_, false) || had;
    if (made.empty()) {
        if (asked) notice_ = madeNothing;
        return clear(document);
    }
    const auto present = std::find(made.begin(), made.end(), shape_);
    if (present == made.end())
        choose(document, *model, made, std::min(index_, made.size() - 1));
    else
        index_ = static_cast<size_t>(present - made.begin());
}

}  // namespace sgm::document
