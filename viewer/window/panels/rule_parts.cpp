// The Rules panel's fields for what divides a scope, a split or its like and its parts, and helps to fill fields.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {

using namespace widgets;
using document::edits::Edit;
using syntax::Case;

namespace {

/// What stands before the colon.
std::string labelOf(const Case& part) {
    if (!part.tag.empty()) return "tag " + part.tag.text;
    return part.label ? std::string(part.label->span.text()) : std::string();
}

/// "*", "+" or the count behind the braces.
std::string timesOf(const Case& part) {
    return part.times ? std::string(part.times->span.text()) : part.atLeastOnce ? "+" : "*";
}

/// "#rrggbb" of sRGB shares.
std::string hexOf(const float (&rgb)[3]) {
    const auto byte = [](float v) { return static_cast<int>(std::lround(v * 255)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(rgb[0]), byte(rgb[1]), byte(rgb[2]));
}

/// The numbers above 0 in an expression, in the order of the text.
void addNumbers(const syntax::Expr& e, std::vector<const syntax::Expr*>& numbers) {
    if (e.kind == syntax::Expr::Kind::Number && e.number > 0) numbers.push_back(&e);
    for (const syntax::Expr& arg : e.args) addNumbers(arg, numbers);
}

document::edits::Quantity quantityOf(syntax::ArgumentType type) {
    using Type = syntax::ArgumentType;
    const bool isLength = type == Type::Length || type == Type::Size || type == Type::Vector || type == Type::Point;
    return isLength ? document::edits::Quantity::Metres : document::edits::Quantity::Real;
}

std::string bodyOf(const Case& part) { return part.body ? std::string(part.body->span.text()) : std::string(); }

}  // namespace

void RulesPanel::partField(Workbench& bench, const std::string& id, const std::string& value, float width,
                           const std::function<Edit(const std::string&)>& commit, const char* label) {
    std::string text = holding_ == id ? held_ : value;
    ImGui::PushFont(codeFont());
    const bool done = field(bench.report, id, text, nullptr, width);
    ImGui::PopFont();
    if (ImGui::IsItemActive()) {
        holding_ = id;
        held_ = text;
    } else if (holding_ == id) {
        holding_.clear();
    }
    if (done && text != value) bench.edit(commit(text), label);
}

void RulesPanel::argumentHelp(Workbench& bench, const syntax::Attribute& attribute,
                              const std::function<Edit(const std::string&)>& set) {
    if (attribute.args.empty()) return;
    const syntax::Expr& written = attribute.args[0];
    parameterButton(bench, attribute.name.text, written, quantityOf(attribute.operation->arguments[0].type));
    const bool isMaterial = attribute.operation->arguments[0].type == syntax::ArgumentType::Material;
    if (attribute.args.size() == 1 && written.kind == syntax::Expr::Kind::Color) {
        const auto bits = static_cast<uint32_t>(written.number);
        float rgb[3];
        for (int i = 0; i < 3; ++i) rgb[i] = static_cast<float>(bits >> (16 - 8 * i) & 255) / 255;
        ImGui::PushID(attribute.name.text.c_str());
        const bool changed = ImGui::ColorEdit3("##swatch", rgb, ImGuiColorEditFlags_NoInputs);
        ImGui::PopID();
        bench.report.mark("swatch." + attribute.name.text);
        if (ImGui::IsItemActivated()) bench.document.beginDrag();
        if (changed) bench.edit(set(hexOf(rgb)), fmt::format("Change {}", attribute.name.text));
        if (ImGui::IsItemDeactivated()) bench.document.endDrag();
        ImGui::SameLine();
    } else if (isMaterial) {
        std::string word;
        if (pick(
                bench.report, attribute.name.text + ".words", "…",
                [&] { return document::materialWords(bench.shown() ? bench.shown()->grammar.get() : nullptr); }, word))
            bench.edit(set(word), fmt::format("Change {}", attribute.name.text));
        ImGui::SameLine();
    }
}

void RulesPanel::parameterButton(Workbench& bench, const std::string& id, const syntax::Expr& written,
                                 document::edits::Quantity quantity) {
    std::vector<const syntax::Expr*> numbers;
    addNumbers(written, numbers);
    if (numbers.empty()) return;
    const auto words = [&] {
        std::vector<document::ListedWord> list;
        for (const syntax::Expr* number : numbers)
            list.push_back(
                {std::string(number->span.text()), "Make it a parameter", "A slider from its half to its double"});
        return list;
    };
    std::string picked;
    if (pick(bench.report, id + ".parameter", "P", words, picked)) {
        const auto number = std::find_if(numbers.begin(), numbers.end(),
                                         [&](const syntax::Expr* n) { return n->span.text() == picked; });
        const document::RuleRow& row = rows_[selected_];
        std::string name = row.rule ? row.rule->symbol.text : row.start->symbol.text;
        name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
        std::string what = id.substr(id.rfind('.') + 1);
        what[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(what[0])));
        bench.edit(document::edits::makeParameter(*listed_, **number, name + what, quantity), "Make a parameter");
    }
    hint("Make a number of it a parameter with a slider");
    ImGui::SameLine();
}

void RulesPanel::removePart(Workbench& bench, const Case& part) {
    const Edit edit = document::edits::removePart(*listed_, part);
    const std::vector<Case>* block = document::edits::partsAround(*listed_, part);
    if (edit.ok() && block) {  // the next part is selected, or the one before
        const Case& other = &part == &block->back() ? *(&part - 1) : *(&part + 1);
        bench.document.selectNode(
            document::SelectedNode{{other.span.begin, other.span.end}, document::RuleRow::Kind::Case});
    }
    bench.edit(edit, "Delete a part");
}

void RulesPanel::partButtons(Workbench& bench, const Case& part) {
    const syntax::Ast& ast = *listed_;
    const std::vector<Case>* block = document::edits::partsAround(ast, part);
    if (!block) return;
    if (button(bench.report, "part.duplicate", "Duplicate", "A copy of this part behind it"))
        bench.edit(document::edits::duplicatePart(ast, part), "Duplicate a part");
    ImGui::SameLine();
    if (button(bench.report, "part.delete", "Delete", "Take this part out of its block", block->size() > 1))
        removePart(bench, part);
    ImGui::SameLine();
    if (button(bench.report, "part.up", "Up", "Before the part above it", &part != &block->front()))
        bench.edit(document::edits::movePart(ast, part, -1), "Move a part");
    ImGui::SameLine();
    if (button(bench.report, "part.down", "Down", "Behind the part below it", &part != &block->back()))
        bench.edit(document::edits::movePart(ast, part, 1), "Move a part");
}

void RulesPanel::partInspector(Workbench& bench, const Case& part) {
    const syntax::Ast& ast = *listed_;
    partButtons(bench, part);
    const float left = ImGui::GetFontSize() * 5;
    const auto name = [&](const char* text) {
        ImGui::AlignTextToFramePadding();
        faint(text);
        ImGui::SameLine(left);
    };
    // The operation whose block it is, for a part that fits.
    const syntax::Attribute* attribute = nullptr;
    for (size_t i = selected_; i > 0 && rows_[i].depth > 0; --i)
        if (rows_[i].depth < rows_[selected_].depth && rows_[i].kind != document::RuleRow::Kind::Case) {
            attribute = rows_[i].attribute;
            break;
        }
    if (part.repeated) {
        name("times");
        partField(
            bench, "part.times", timesOf(part), 0,
            [&](const std::string& t) { return document::edits::setPartTimes(ast, part, t); }, "Change how often");
        hint("* as often as it fits, + at least once, or a count");
        return blockInspector(bench, part.cases, attribute);
    }
    if (part.label)
        parameterButton(bench, "part.size", *part.label,
                        part.label->kind == syntax::Expr::Kind::Floating ? document::edits::Quantity::Real
                                                                         : document::edits::Quantity::Metres);
    name("size");
    partField(
        bench, "part.size", labelOf(part), 0,
        [&](const std::string& t) { return document::edits::setPartLabel(ast, part, t); }, "Change a part's size");
    hint("1.5m, a share (30%), a floating share of what is left (~1), or the word of a face or a lot");
    if (part.body) {
        name("body");
        partField(
            bench, "part.body", bodyOf(part), 0,
            [&](const std::string& t) { return document::edits::setBody(ast, *part.body, t); }, "Change a part");
    }
    addPart(bench, part, attribute);
}

void RulesPanel::divisionInspector(Workbench& bench, const document::RuleRow& row) {
    const syntax::Attribute& attribute = *row.attribute;
    const syntax::Ast& ast = *listed_;
    const auto change = [&](const std::string& text) {
        return document::edits::setAttribute(ast, *row.element, *attribute.operation, text);
    };
    if (!attribute.args.empty()) {
        const std::string_view all = ast.source->text();
        const std::string written(all.substr(attribute.args.front().span.begin,
                                             attribute.args.back().span.end - attribute.args.front().span.begin));
        constexpr std::array axes{"x", "y", "z"};
        const auto axis = std::find(axes.begin(), axes.end(), written);
        ImGui::AlignTextToFramePadding();
        faint(attribute.name.text);
        ImGui::SameLine(ImGui::GetFontSize() * 5);
        int value = static_cast<int>(axis - axes.begin());
        if (axis != axes.end()) {
            if (oneOf(bench.report, "split.axis", axes, value))
                bench.edit(change(axes[size_t(value)]), fmt::format("Split along {}", axes[size_t(value)]));
        } else {
            partField(bench, "split.arguments", written, 0, change, "Change a division");
        }
        hint(std::string(attribute.operation->doc).c_str());
    }
    if (!attribute.operation->block.isBody) blockInspector(bench, attribute.cases, &attribute);
}

void RulesPanel::blockInspector(Workbench& bench, const std::vector<Case>& parts, const syntax::Attribute* attribute) {
    const syntax::Ast& ast = *listed_;
    const float em = ImGui::GetFontSize(), buttons = em * 5.6f;
    for (size_t i = 0; i < parts.size(); ++i) {
        const Case& part = parts[i];
        const std::string id = fmt::format("part.{}", i);
        const auto named = [&](const char* what) { return id + "." + what; };
        if (part.repeated) {
            ImGui::SetNextItemWidth(em * 4);
            ImGui::AlignTextToFramePadding();
            faint("{ }");
            ImGui::SameLine();
            partField(
                bench, named("times"), timesOf(part), em * 2.6f,
                [&](const std::string& t) { return document::edits::setPartTimes(ast, part, t); }, "Change how often");
        } else {
            partField(
                bench, named("size"), labelOf(part), em * 4.4f,
                [&](const std::string& t) { return document::edits::setPartLabel(ast, part, t); },
                "Change a part's size");
        }
        ImGui::SameLine();
        const float room = std::max(em * 3, ImGui::GetContentRegionAvail().x - buttons);
        if (part.body) {
            partField(
                bench, named("body"), bodyOf(part), room,
                [&](const std::string& t) { return document::edits::setBody(ast, *part.body, t); }, "Change a part");
        } else {
            const float x = ImGui::GetCursorPosX();
            faint(shortened(std::string(part.span.text()), room));
            ImGui::SameLine(x + room);
        }
        ImGui::SameLine();
        if (quietButton(bench.report, named("up"), "Up", "Before the part above it", i > 0))
            bench.edit(document::edits::movePart(ast, part, -1), "Move a part");
        ImGui::SameLine(0, 0);
        if (quietButton(bench.report, named("delete"), "Delete", "Take it out", parts.size() > 1))
            bench.edit(document::edits::removePart(ast, part), "Delete a part");
    }
    addPart(bench, parts.back(), attribute);
}

void RulesPanel::addPart(Workbench& bench, const Case& after, const syntax::Attribute* attribute) {
    const std::string sample = document::edits::samplePart(attribute);
    if (samplePart_ != sample) newPart_ = samplePart_ = sample;
    const FieldWithButton row{
        .field = "part.new",
        .empty = "size: body",
        .fieldHint = "A part as it is written: 'size: body', or '{ size: body }*' for as often as it fits",
        .button = "part.add",
        .label = "Add part",
        .buttonHint = "Behind the selected part, or the last one",
        .isCode = true,
    };
    if (fieldWithButton(bench.report, row, newPart_))
        bench.edit(document::edits::addPart(*listed_, after, newPart_), "Add a part");
}

}  // namespace sgm::window
