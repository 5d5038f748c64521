// The panels. Each fills the present ImGui window, reads the workbench and changes the document by its verbs alone.
// Enters: the workbench. Leaves: edits. Assumes a frame of ImGui.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "viewer/document/export_job.h"
#include "viewer/document/param_rows.h"
#include "viewer/document/rule_rows.h"
#include "viewer/document/shape_rows.h"
#include "viewer/window/code_editor.h"
#include "viewer/window/workbench.h"

namespace sgm::viewer {

/// Parameters from the annotations, with locks, styles, seed and re-roll.
class ParametersPanel {
public:
    void show(Workbench& bench);
    /// Hotkeys of the grammar (`param … key`); Shift reverses. Call once a frame, when no text takes keys.
    void keys(Workbench& bench);

private:
    void choices(Workbench& bench);
    void styles(Workbench& bench);
    void row(Workbench& bench, ParamRow row);
    bool control(Workbench& bench, ParamRow& row);
    bool numbers(Workbench& bench, ParamRow& row);
    bool color(Workbench& bench, ParamRow& row);

    /// Writes the row's value into the text.
    void set(Workbench& bench, const ParamRow& row);
    /// `rows_` as the text has them, though the model may still be an earlier one.
    void list(Workbench& bench);

    std::vector<ParamRow> rows_;
    std::vector<ParamRow> ahead_;   ///< what was set since the shown model
    uint64_t aheadRevision_ = 0;    ///< of the document, when the last of them was
    std::optional<ParamRow> held_;  ///< what is dragged; the model follows it
    std::string styleName_;
    float labelShare_ = 0.46f;  ///< of a row's width
};

/// The derived tree, filtered and foldable; a shape may be dragged onto a joint of the view.
class ShapesPanel {
public:
    void show(Workbench& bench);

private:
    void row(Workbench& bench, const ShapeRow& row);

    ShapeFilter filter_, listedFilter_;
    Folded folded_;
    std::shared_ptr<const BuiltModel> listed_;  ///< what `rows_` are of
    bool stale_ = true;
    std::vector<ShapeRow> rows_;
    derive::ShapeId seen_ = derive::none;  ///< the selection that was last scrolled to
};

/// The grammar's rules as rows, and below them what the selected one can be changed to.
class RulesPanel {
public:
    void show(Workbench& bench);

private:
    void row(Workbench& bench, size_t index);
    void newRule(Workbench& bench, size_t selected);
    void dragRule(const RuleRow& row, ImVec2 low);
    void inspector(Workbench& bench, const RuleRow& row);
    void ruleInspector(Workbench& bench, const RuleRow& row);
    void elementInspector(Workbench& bench, const RuleRow& row);
    void attributes(Workbench& bench, const syntax::Element& element);
    /// A field for a part of the node; `commit` makes the edit when it is left.
    template <class Commit>
    void part(Workbench& bench, const char* name, const std::string& value, Commit commit);

    std::shared_ptr<const syntax::Ast> listed_;
    std::vector<RuleRow> rows_;
    std::optional<uint32_t> at_;  ///< first byte of the selected row's node
    RuleRow::Kind kind_ = RuleRow::Kind::Rule;
    bool scroll_ = false;  ///< the selected row is to be seen
    /// Where a rule that is dragged would go.
    struct Drop {
        size_t rule, before;  ///< of the syntax tree
    };
    std::optional<Drop> drop_;
    std::string holding_, held_;  ///< the field that takes keys, and its text
    std::string newRule_ = "Name -> sphere";
};

/// The grammar itself, with its problems under their lines; a click selects the shapes that the place made.
class TextPanel {
public:
    void show(Workbench& bench);
    void leave() { editor_.leave(); }

private:
    CodeEditor editor_;
    std::shared_ptr<const syntax::Ast> colored_;
    std::vector<std::vector<Coloured>> colors_;
};

/// The derivation by hand: live shapes, the rules that match, forward and back, saved as a `derive` line.
class StepPanel {
public:
    void show(Workbench& bench);

private:
    void begin(Workbench& bench);
    void shapes(Workbench& bench);
    void save(Workbench& bench);

    std::string way_ = "byhand";
    derive::ShapeId seen_ = derive::none;  ///< the selection that was last scrolled to
};

/// Every exporter's options from its table, and the work with its progress.
class ExportPanel {
public:
    void show(Workbench& bench);

private:
    void take(size_t format);
    void chooseFormat(Workbench& bench);
    void chooseMesh(Workbench& bench);
    void option(Workbench& bench, ExportRow& row);

    size_t format_ = 0;  // row of the table
    int resolution_ = 192;
    int keep_ = 0;  // mesh::Keep
    std::string objects_ = "material";
    std::filesystem::path document_;  // that `file_` was named after
    std::vector<ExportRow> options_;
    std::string file_;
};

/// What is wrong, a row each; a click shows the place.
void problemsPanel(Workbench& bench);

}  // namespace sgm::viewer
