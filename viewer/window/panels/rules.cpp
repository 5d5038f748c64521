#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <array>
#include <cctype>

#include "grammar/operations/operations.h"
#include "viewer/document/word_lists.h"
#include "viewer/window/panels.h"
#include "viewer/window/selecting.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

using namespace widgets;
using syntax::Element;
using syntax::Operation;
using syntax::Operator;
using Kind = document::RuleRow::Kind;

std::string textOf(const std::optional<syntax::Expr>& e) { return e ? std::string(e->span.text()) : std::string(); }

/// What stands behind an attribute's name.
std::string argumentsOf(const syntax::Attribute& attribute) {
    const std::string_view all = attribute.span.text();
    const size_t from = all.find_first_not_of(" \t\n", attribute.name.text.size());
    return from == std::string_view::npos ? "" : std::string(all.substr(from));
}

ImU32 colorOf(const document::RuleRow& row) {
    switch (row.kind) {
        case Kind::Start:
        case Kind::Rule:
            return tint::text;
        case Kind::Element:
            if (row.element->kind != Element::Kind::Shape) return tint::accent;
            if (row.element->solid && row.element->solid->text.size() &&
                std::isupper(static_cast<unsigned char>(row.element->solid->text[0])))
                return tint::nonTerminal;
            return row.element->live.empty() ? tint::terminal : tint::nonTerminal;
        default:
            return tint::faint;
    }
}

/// What an example of an operation gives it: the text up to the first blank outside parentheses.
std::string firstArgument(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    int open = 0;
    size_t end = 0;
    for (; end < text.size() && (open > 0 || text[end] != ' '); ++end)
        open += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
    return std::string(text.substr(0, end));
}

void label(const char* text, float& left) {
    left = ImGui::GetCursorStartPos().x + ImGui::GetFontSize() * 5;
    ImGui::AlignTextToFramePadding();
    faint(text);
    ImGui::SameLine(left);
}

/// The part whose body is the selected shape alone: what is done with the shape is done with the part.
const syntax::Case* onlyShapeOf(const std::vector<document::RuleRow>& rows, size_t row) {
    if (rows[row].kind != Kind::Element) return nullptr;
    size_t above = row;
    while (above > 0 && rows[above].depth >= rows[row].depth) --above;
    const syntax::Case* part = rows[above].kind == Kind::Case ? rows[above].part : nullptr;
    const bool alone = part && part->body && part->body->siblings.size() == 1 && part->body->siblings[0].size() == 1;
    return alone && &part->body->siblings[0][0] == rows[row].element ? part : nullptr;
}

/// Which files' rules work beside those of the text.
void nameUses(const syntax::Ast& ast) {
    if (ast.uses.empty()) return;
    std::string used;
    for (const syntax::UseDecl& use : ast.uses) used += (used.empty() ? "" : ", ") + std::string(use.file.span.text());
    ImGui::Dummy({0, 4});
    ImGui::PushTextWrapPos(0);
    faint("and the rules of " + used);
    ImGui::PopTextWrapPos();
    hint("They are used and not part of this text; Shapes tells which of them made a shape");
}

}  // namespace

void RulesPanel::show(Workbench& bench) {
    if (listed_ != bench.document.ast()) {
        listed_ = bench.document.ast();
        rows_ = document::ruleRows(*listed_);
    }
    const size_t selected = selected_ = selectedRow(bench);
    const float below =
        selected < rows_.size() ? ImGui::GetContentRegionAvail().y * 0.46f : ImGui::GetFrameHeightWithSpacing() * 1.3f;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 2));
    if (ImGui::BeginChild("rows", {0, -below})) {
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(rows_.size()), ImGui::GetTextLineHeight() + 6);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) row(bench, size_t(i));
        nameUses(*listed_);
        if (std::exchange(bench.panels.revealRow, false) && selected < rows_.size()) {
            const float height = ImGui::GetTextLineHeight() + 6, y = height * static_cast<float>(selected);
            const float above = ImGui::GetScrollY();
            if (y < above || y + height > above + ImGui::GetWindowHeight())
                ImGui::SetScrollY(std::max(0.0f, y - ImGui::GetWindowHeight() / 3));
        }
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    if (const auto drop = std::exchange(drop_, std::nullopt); drop && drop->rule < listed_->rules.size()) {
        const syntax::RuleDecl* before = drop->before < listed_->rules.size() ? &listed_->rules[drop->before] : nullptr;
        bench.edit(document::edits::moveRule(*listed_, listed_->rules[drop->rule], before),
                   "Move rule " + listed_->rules[drop->rule].symbol.text);
    }
    ImGui::Separator();
    if (ImGui::BeginChild("inspector")) {
        if (selected < rows_.size()) inspector(bench, rows_[selected]);
        newRule(bench, selected);
    }
    ImGui::EndChild();
}

/// The row of what is selected; what an edit left vague is said exactly.
size_t RulesPanel::selectedRow(Workbench& bench) {
    const auto& node = bench.document.choice().node;
    if (!node) return rows_.size();
    const size_t row = rowOf(rows_, *node);
    if (row == rows_.size())
        bench.document.selectNode(std::nullopt);
    else
        bench.document.selectNode(
            document::SelectedNode{{rows_[row].span.begin, rows_[row].span.end}, rows_[row].kind});
    return row;
}

void RulesPanel::newRule(Workbench& bench, size_t selected) {
    const FieldWithButton row{
        .field = "rule.new",
        .empty = "Name -> body, or start Name -> body",
        .button = "rule.add",
        .label = "Add rule",
        .buttonHint = "A new rule, behind the selected one or the last of its shape; 'start Name -> body' adds a start",
    };
    if (fieldWithButton(bench.report, row, newRule_, [&] { return newRule_.find("->") != std::string::npos; })) {
        const syntax::RuleDecl* after = selected < rows_.size() ? rows_[selected].rule : nullptr;
        bench.edit(document::edits::addDeclaration(*listed_, newRule_, after), "Add " + newRule_);
    }
}

void RulesPanel::row(Workbench& bench, size_t index) {
    const document::RuleRow& row = rows_[index];
    ImGui::PushID(static_cast<int>(index));
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const bool isHead = row.depth == 0;
    if (ImGui::Selectable("##row", index == selected_, 0, {0, ImGui::GetTextLineHeight() + 4})) {
        bench.panels.reveal = {row.span.begin, row.span.end};
        selectRow(bench, row);
        bench.panels.revealRow = true;  // the fields below come, and take room
    }
    bench.report.mark(fmt::format("rule.{}.{}", listed_->source->place(row.span.begin).line, row.text));
    if (row.kind == Kind::Rule) dragRule(row, low);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* font = isHead ? strongFont() : codeFont();
    const float x = low.x + 4 + static_cast<float>(row.depth) * 14;
    const std::string text = (row.first && row.sibling > 0 ? ", " : "") + row.text;
    list.AddText(font, font->FontSize, {x, low.y + 2}, colorOf(row), text.c_str());
    ImGui::PopID();
}

/// Rules are dragged by their head rows, above the upper half of another or below its lower half.
void RulesPanel::dragRule(const document::RuleRow& row, ImVec2 low) {
    const auto at = static_cast<size_t>(row.rule - listed_->rules.data());
    if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoDisableHover)) {
        ImGui::SetDragDropPayload("rule", &at, sizeof at);
        ImGui::TextUnformatted(row.text.c_str());
        ImGui::EndDragDropSource();
    }
    if (!ImGui::BeginDragDropTarget()) return;
    constexpr ImGuiDragDropFlags quiet =
        ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect;
    if (const ImGuiPayload* dragged = ImGui::AcceptDragDropPayload("rule", quiet)) {
        const float height = ImGui::GetTextLineHeight() + 6;
        const bool below = ImGui::GetIO().MousePos.y > low.y + height / 2;
        const float y = low.y + (below ? height : 0) - 1;
        ImGui::GetWindowDrawList()->AddLine({low.x, y}, {low.x + ImGui::GetContentRegionAvail().x, y}, tint::accent, 2);
        if (dragged->IsDelivery()) drop_ = Drop{*static_cast<const size_t*>(dragged->Data), at + below};
    }
    ImGui::EndDragDropTarget();
}

template <class Commit>
void RulesPanel::part(Workbench& bench, const char* name, const std::string& value, Commit commit) {
    float left = 0;
    label(name, left);
    const std::string id = std::string("edit.") + name;
    if (refused_ && (refused_->row != selected_ || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false))) refused_.reset();
    const bool wasRefused = refused_ && refused_->field == id;
    std::string text = holding_ == id ? held_ : wasRefused ? refused_->text : value;
    ImGui::BeginGroup();
    ImGui::PushFont(codeFont());
    const bool done = field(bench.report, id, text);
    ImGui::PopFont();
    const bool escaped = ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
    if (ImGui::IsItemActive()) {
        holding_ = id;
        held_ = text;
    } else if (holding_ == id) {
        holding_.clear();
    }
    if (done && !escaped) {
        if (wasRefused) refused_.reset();
        if (text != value) {
            const document::edits::Edit edit = commit(text);
            if (!edit) refused_ = Refused{selected_, id, text, edit.error().message};
            bench.edit(edit, fmt::format("Change {}", name));
        }
    }
    if (refused_ && refused_->field == id) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(tint::error), "%s", refused_->why.c_str());
        ImGui::PopTextWrapPos();
        bench.report.mark("refused");
    }
    ImGui::EndGroup();
}

void RulesPanel::inspector(Workbench& bench, const document::RuleRow& row) {
    const syntax::Ast& ast = *listed_;
    if (row.kind == Kind::Element || row.kind == Kind::Attribute)
        elementInspector(bench, row);
    else if (row.kind == Kind::Case)
        partInspector(bench, *row.part);
    else if (row.rule)
        ruleInspector(bench, row);
    else if (row.start)
        part(bench, "body", std::string(row.start->body.span.text()),
             [&](const std::string& t) { return document::edits::setBody(ast, row.start->body, t); });
}

void RulesPanel::ruleInspector(Workbench& bench, const document::RuleRow& row) {
    const syntax::Ast& ast = *listed_;
    const syntax::RuleDecl& rule = *row.rule;
    const std::string called = rule.name.empty() ? rule.symbol.text : rule.name.text;
    if (button(bench.report, "rule.duplicate", "Duplicate"))
        bench.edit(document::edits::duplicateRule(ast, rule), "Duplicate rule " + called);
    ImGui::SameLine();
    if (button(bench.report, "rule.delete", "Delete"))
        bench.edit(document::edits::removeRule(ast, rule), "Delete rule " + called);
    const auto at = static_cast<size_t>(&rule - ast.rules.data());
    ImGui::SameLine();
    if (button(bench.report, "rule.up", "Up", nullptr, at > 0))
        bench.edit(document::edits::moveRule(ast, rule, &ast.rules[at - 1]), "Move rule " + called);
    ImGui::SameLine();
    if (button(bench.report, "rule.down", "Down", nullptr, at + 1 < ast.rules.size()))
        bench.edit(document::edits::moveRule(ast, rule, at + 2 < ast.rules.size() ? &ast.rules[at + 2] : nullptr),
                   "Move rule " + called);
    part(bench, "name", rule.name.text, [&](const std::string& t) { return document::edits::setName(ast, rule, t); });
    part(bench, "shape", rule.symbol.text,
         [&](const std::string& t) { return document::edits::setSymbol(ast, rule, t); });
    part(bench, "when", textOf(rule.when),
         [&](const std::string& t) { return document::edits::setGuard(ast, rule, t); });
    part(bench, "repeat", textOf(rule.repeat),
         [&](const std::string& t) { return document::edits::setRepeat(ast, rule, t); });
    part(bench, "weight", textOf(rule.weight),
         [&](const std::string& t) { return document::edits::setWeight(ast, rule, t); });
    part(bench, "beside", rule.beside.text,
         [&](const std::string& t) { return document::edits::setBeside(ast, rule, t); });
}

void RulesPanel::elementInspector(Workbench& bench, const document::RuleRow& row) {
    const syntax::Ast& ast = *listed_;
    const Element& element = *row.element;
    constexpr std::array operators{"content", "+", "-", "&", "morph"};
    int op = static_cast<int>(element.op);
    if (oneOf(bench.report, "op", operators, op))
        bench.edit(document::edits::setOperator(ast, element, static_cast<Operator>(op)),
                   fmt::format("{} becomes {}", operators[static_cast<size_t>(element.op)], operators[size_t(op)]));
    if (const syntax::Case* whole = onlyShapeOf(rows_, selected_))
        partButtons(bench, *whole);
    else
        elementButtons(bench, element);
    if (element.kind == Element::Kind::Shape || element.kind == Element::Kind::Group) {
        ImGui::SameLine();
        addAttribute(bench, element);
    }
    if (element.kind == Element::Kind::Shape && element.solid) {
        std::string word;
        if (pick(
                bench.report, "solid.words", "…",
                [&] { return document::placeableWords(bench.shown() ? bench.shown()->grammar.get() : nullptr); }, word))
            bench.edit(document::edits::setSolid(ast, element, word), "Change solid");
        hint("Solids, terminals and shapes with rules");
        ImGui::SameLine();
        part(bench, "solid", textOf(element.solid),
             [&](const std::string& t) { return document::edits::setSolid(ast, element, t); });
        part(bench, "live", element.live.text,
             [&](const std::string& t) { return document::edits::setLive(ast, element, t); });
    } else if (element.over) {
        part(bench, "over", textOf(element.over),
             [&](const std::string& t) { return document::edits::setExpression(ast, *element.over, t); });
    }
    if (row.attribute && row.attribute->operation->hasBlock()) return divisionInspector(bench, row);
    if (!element.cases.empty()) blockInspector(bench, element.cases, nullptr);
    attributes(bench, element);
}

void RulesPanel::elementButtons(Workbench& bench, const Element& element) {
    const syntax::Ast& ast = *listed_;
    if (button(bench.report, "element.duplicate", "Duplicate"))
        bench.edit(document::edits::duplicateElement(ast, element), "Duplicate a shape");
    ImGui::SameLine();
    if (button(bench.report, "element.delete", "Delete"))
        bench.edit(document::edits::removeElement(ast, element), "Delete a shape");
    ImGui::SameLine();
    if (button(bench.report, "element.up", "Up"))
        bench.edit(document::edits::moveElement(ast, element, -1), "Move a shape");
    ImGui::SameLine();
    if (button(bench.report, "element.down", "Down"))
        bench.edit(document::edits::moveElement(ast, element, 1), "Move a shape");
}

void RulesPanel::attributes(Workbench& bench, const Element& element) {
    const syntax::Ast& ast = *listed_;
    const auto find = [&](const Operation& operation) -> const syntax::Attribute* {
        for (const auto* list : {&element.before, &element.after})
            for (const syntax::Attribute& a : *list)
                if (a.operation == &operation) return &a;
        return nullptr;
    };
    // Joints have a row of buttons: retargeting one is whin works do most.
    if (element.op != Operator::None) {
        const syntax::Attribute* at = find(operations::at);
        constexpr std::array joints{"+x", "-x", "+y", "-y", "+z", "-z", "centre"};
        int joint = -1;
        for (size_t i = 0; i < joints.size(); ++i)
            if (at && argumentsOf(*at) == joints[i]) joint = static_cast<int>(i);
        float left = 0;
        label("joint", left);
        if (oneOf(bench.report, "joint", joints, joint))
            bench.edit(document::edits::setAttribute(ast, element, operations::at, joints[size_t(joint)]),
                       fmt::format("Join at {}", joints[size_t(joint)]));
    }
    for (const Operation* row : ast.operations->rows()) {
        const Operation& operation = *row;
        const syntax::Attribute* there = operation.hasBlock() ? nullptr : find(operation);
        if (!there) continue;
        const std::string name(operation.name);
        const auto set = [&](const std::string& t) {
            return t.empty() ? document::edits::removeAttribute(ast, element, operation)
                             : document::edits::setAttribute(ast, element, operation, t);
        };
        argumentHelp(bench, *there, set);
        part(bench, name.c_str(), argumentsOf(*there), set);
        hint(std::string(operation.doc).c_str());
    }
}

void RulesPanel::addAttribute(Workbench& bench, const Element& element) {
    const syntax::Ast& ast = *listed_;
    std::string chosen;
    if (!pick(
            bench.report, "attribute.add", "Add …", [&] { return document::attributeWords(ast, element); }, chosen))
        return;
    if (!ast.operations->find(chosen) || ast.operations->find(chosen)->hasBlock())
        return bench.edit(document::edits::divide(ast, element, chosen), fmt::format("Add {}", chosen));
    // The row's own example shows how its argument is written.
    const Operation& operation = *ast.operations->find(chosen);
    std::string_view example = operation.example;
    const size_t from = example.find(operation.name);
    example = from == std::string_view::npos ? std::string_view("1") : example.substr(from + operation.name.size());
    const std::string arguments = operation.arguments.size() > 1 ? std::string(example) : firstArgument(example);
    bench.edit(document::edits::setAttribute(ast, element, operation, arguments),
               fmt::format("Add {}", operation.name));
}

}  // namespace sgm::window
