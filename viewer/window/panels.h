// The panels. Each fills the present ImGui window, reads the workbench and changes the document by its verbs alone.
// Enters: the workbench. Leaves: edits. Assumes a frame of ImGui.
#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewer/document/export_job.h"
#include "viewer/document/letters.h"
#include "viewer/document/param_rows.h"
#include "viewer/document/report_rows.h"
#include "viewer/document/rule_rows.h"
#include "viewer/document/shape_rows.h"
#include "viewer/window/code_editor.h"
#include "viewer/window/text_search.h"
#include "viewer/window/workbench.h"

namespace sgm::window {

/// Parameters from the annotations, with locks, styles, seed and re-roll.
class ParametersPanel {
public:
    void show(Workbench& bench);
    /// Hotkeys of the grammar (`param … key`); Shift reverses. Call once a frame, when no text takes keys.
    void keys(Workbench& bench);

private:
    void choices(Workbench& bench);
    /// What shapes report, below the parameters.
    void reports(Workbench& bench);
    void styles(Workbench& bench);
    void row(Workbench& bench, document::ParamRow row);
    bool control(Workbench& bench, document::ParamRow& row);
    bool numbers(Workbench& bench, document::ParamRow& row);
    bool color(Workbench& bench, document::ParamRow& row);

    /// Writes the row's value into the text.
    void set(Workbench& bench, const document::ParamRow& row);
    /// `rows_` as the text has them, though the model may still be an earlier one.
    void list(Workbench& bench);

    std::vector<document::ParamRow> rows_;
    std::vector<document::ParamRow> ahead_;   ///< what was set since the shown model
    uint64_t aheadRevision_ = 0;              ///< of the document, when the last of them was
    std::optional<document::ParamRow> held_;  ///< what is dragged; the model follows it
    void newParameter(Workbench& bench);

    std::string styleName_, newParameter_ = "name = 2m in 1m..4m";
    std::shared_ptr<const document::BuiltModel> reported_;  ///< what `reports_` are of
    std::vector<document::ReportRow> reports_;
    float labelShare_ = 0.46f;  ///< of a row's width
};

/// The derived tree, filtered and foldable; a shape may be dragged onto a joint of the view.
class ShapesPanel {
public:
    void show(Workbench& bench);

private:
    void row(Workbench& bench, const document::ShapeRow& row);

    document::ShapeFilter filter_, listedFilter_;
    document::Folded folded_;
    std::shared_ptr<const document::BuiltModel> listed_;  ///< what `rows_` are of
    bool stale_ = true;
    std::vector<document::ShapeRow> rows_;
    derive::ShapeId seen_ = derive::none;  ///< the selection that was last scrolled to
};

/// The grammar's rules as rows, and below them what the selected one can be changed to.
class RulesPanel {
public:
    void show(Workbench& bench);

private:
    void row(Workbench& bench, size_t index);
    void newRule(Workbench& bench, size_t selected);
    void dragRule(const document::RuleRow& row, ImVec2 low);
    void inspector(Workbench& bench, const document::RuleRow& row);
    void ruleInspector(Workbench& bench, const document::RuleRow& row);
    void elementInspector(Workbench& bench, const document::RuleRow& row);
    void elementButtons(Workbench& bench, const syntax::Element& element);
    void attributes(Workbench& bench, const syntax::Element& element);
    void addAttribute(Workbench& bench, const syntax::Element& element);
    size_t selectedRow(Workbench& bench);
    // In rule_parts.cpp:
    void partInspector(Workbench& bench, const syntax::Case& part);
    void partButtons(Workbench& bench, const syntax::Case& part);
    void removePart(Workbench& bench, const syntax::Case& part);
    /// An operation that divides the scope: what stands before its braces, and its parts.
    void divisionInspector(Workbench& bench, const document::RuleRow& row);
    void blockInspector(Workbench& bench, const std::vector<syntax::Case>& parts, const syntax::Attribute* attribute);
    /// What stands before an attribute's field: a swatch for a colour, a list for a material.
    void argumentHelp(Workbench& bench, const syntax::Attribute& attribute,
                      const std::function<document::edits::Edit(const std::string&)>& set);
    /// A button that makes a number of the expression a parameter; nothing where there is none above 0.
    void parameterButton(Workbench& bench, const std::string& id, const syntax::Expr& written,
                         document::edits::Quantity quantity);
    void addPart(Workbench& bench, const syntax::Case& after, const syntax::Attribute* attribute);
    /// A field of `width` pixels, 0 for what is left; the edit is made when it is left, changed.
    void partField(Workbench& bench, const std::string& id, const std::string& value, float width,
                   const std::function<document::edits::Edit(const std::string&)>& commit, const char* label);
    /// A field for a part of the node; `commit` makes the edit when it is left.
    template <class Commit>
    void part(Workbench& bench, const char* name, const std::string& value, Commit commit);

    std::shared_ptr<const syntax::Ast> listed_;
    std::vector<document::RuleRow> rows_;
    size_t selected_ = 0;  ///< row of what is selected; the number of rows for none
    /// Where a rule that is dragged would go.
    struct Drop {
        size_t rule, before;  ///< of the syntax tree
    };
    std::optional<Drop> drop_;
    std::string holding_, held_;  ///< the field that takes keys, and its text
    /// What was typed in a field of a row and makes no sense there: it stays until it does, or until `Esc`.
    struct Refused {
        size_t row;
        std::string field, text, why;
    };
    std::optional<Refused> refused_;
    std::string newRule_ = "Name -> sphere";
    std::string newPart_, samplePart_;  ///< the part to add, and what it was at first
};

/// The grammar itself, with its problems under their lines; a click selects the shapes that the place made.
class TextPanel {
public:
    void show(Workbench& bench);
    void leave() { editor_.leave(); }

private:
    CodeEditor editor_;
    TextSearch search_;
    std::shared_ptr<const syntax::Ast> colored_;
    std::vector<std::vector<document::Coloured>> colors_;
};

/// The letters of an L-system pass by pass, and the way that its turtle goes.
class LettersView {
public:
    /// Nothing where the model reads no L-system.
    void show(Workbench& bench);

private:
    static constexpr uint32_t mostPasses = ~uint32_t(0);
    bool take(Workbench& bench, const std::vector<uint32_t>& known);

    uint32_t lsystem_ = 0, passes_ = mostPasses;
    std::shared_ptr<const document::BuiltModel> of_;  ///< what `made_` is of
    uint32_t asked_ = 0;                              ///< passes that `made_` was asked with
    document::LettersShown made_;
    std::string fault_;  ///< why there are no letters
    int letter_ = 0;     ///< how many the turtle has read
};

/// The derivation by hand: live shapes, the rules that match, forward and back, saved as a `derive` line.
class StepPanel {
public:
    void show(Workbench& bench);

private:
    void begin(Workbench& bench);
    void shapes(Workbench& bench, const document::StepView& view);
    void save(Workbench& bench, const document::StepView& view);

    LettersView letters_;
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
    void option(Workbench& bench, document::ExportRow& row);
    /// Asks first where a file is there that this window hasn't written.
    void start(Workbench& bench, document::ExportRequest request);

    size_t format_ = 0;  // row of the table
    int resolution_ = 192;
    int keep_ = 0;  // mesh::Keep
    std::string objects_ = "material";
    std::filesystem::path document_;  // that `file_` was named after
    std::vector<document::ExportRow> options_;
    std::string file_;
    std::set<std::filesystem::path> written_;
};

/// What is wrong, a row each; a click shows the place.
void problemsPanel(Workbench& bench);

}  // namespace sgm::window
