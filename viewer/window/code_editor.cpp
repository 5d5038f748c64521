#include "viewer/window/code_editor.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

ImU32 tintOf(document::TextColour color) {
    switch (color) {
        case document::TextColour::Keyword:
            return IM_COL32(198, 146, 220, 255);
        case document::TextColour::Operation:
            return IM_COL32(110, 184, 200, 255);
        case document::TextColour::Solid:
        case document::TextColour::Terminal:
            return IM_COL32(232, 140, 120, 255);
        case document::TextColour::NonTerminal:
            return IM_COL32(110, 164, 236, 255);
        case document::TextColour::Parameter:
            return IM_COL32(226, 190, 120, 255);
        case document::TextColour::Number:
        case document::TextColour::Hex:
            return IM_COL32(150, 200, 130, 255);
        case document::TextColour::Text:
            return IM_COL32(178, 196, 120, 255);
        case document::TextColour::Comment:
            return IM_COL32(112, 120, 132, 255);
        case document::TextColour::Sign:
            return IM_COL32(176, 182, 192, 255);
        case document::TextColour::Wrong:
            return tint::error;
        case document::TextColour::Plain:
            break;
    }
    return tint::text;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }
uint32_t after(const std::string& text, uint32_t at) {
    if (at < text.size()) ++at;
    while (at < text.size() && continues(text[at])) ++at;
    return at;
}
uint32_t before(const std::string& text, uint32_t at) {
    if (at > 0) --at;
    while (at > 0 && continues(text[at])) --at;
    return at;
}
bool isWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || (static_cast<unsigned char>(c) & 0x80);
}

float widthOf(const std::string& text, uint32_t begin, uint32_t end) {
    return codeFont()->CalcTextSizeA(codeFont()->FontSize, FLT_MAX, 0, text.data() + begin, text.data() + end).x;
}

}  // namespace

void CodeEditor::reveal(uint32_t begin, uint32_t end) {
    anchor_ = begin;
    caret_ = end;
    follow_ = Follow::Selection;
}

uint32_t CodeEditor::lineOf(uint32_t offset) const {
    return static_cast<uint32_t>(std::upper_bound(starts_.begin(), starts_.end(), offset) - starts_.begin()) - 1;
}
uint32_t CodeEditor::endOf(const std::string& text, uint32_t line) const {
    return line + 1 < starts_.size() ? starts_[line + 1] - 1 : static_cast<uint32_t>(text.size());
}
float CodeEditor::xOf(const std::string& text, uint32_t line, uint32_t offset) const {
    return gutter_ + widthOf(text, starts_[line], offset);
}

uint32_t CodeEditor::offsetAt(const std::string& text, uint32_t line, float x) const {
    uint32_t at = starts_[line];
    const uint32_t end = endOf(text, line);
    float left = gutter_;
    while (at < end) {
        const uint32_t next = after(text, at);
        const float width = widthOf(text, at, next);
        if (x < left + width / 2) break;
        left += width;
        at = next;
    }
    return at;
}

void CodeEditor::layOut(const std::string& text, const std::vector<LineNote>& notes) {
    starts_.assign(1, 0);
    for (uint32_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n') starts_.push_back(i + 1);
    const auto size = static_cast<uint32_t>(text.size());
    caret_ = std::min(caret_, size);
    anchor_ = std::min(anchor_, size);
    rows_.clear();
    rowOf_.clear();
    for (uint32_t line = 0; line < starts_.size(); ++line) {
        rowOf_.push_back(static_cast<uint32_t>(rows_.size()));
        rows_.push_back({line, -1});
        for (size_t n = 0; n < notes.size(); ++n)
            if (notes[n].line == line) rows_.push_back({line, static_cast<int>(n)});
    }
}

void CodeEditor::drawLine(const std::string& text, uint32_t line, const std::vector<document::Coloured>& colors,
                          const std::vector<LineNote>& notes, ImVec2 low) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* font = codeFont();
    const uint32_t start = starts_[line], end = endOf(text, line);
    const auto [from, to] = selection();
    if (from < to && from <= end && to > start) {
        const float right = xOf(text, line, std::min(to, end)) + (to > end ? 5 : 0);
        list.AddRectFilled({low.x + xOf(text, line, std::max(from, start)), low.y}, {low.x + right, low.y + height_},
                           ImGui::GetColorU32(ImGuiCol_TextSelectedBg));
    }
    const std::string number = fmt::format("{}", line + 1);
    list.AddText(font, font->FontSize,
                 {low.x + gutter_ - 14 - widthOf(number, 0, static_cast<uint32_t>(number.size())), low.y},
                 line == lineOf(caret_) ? tint::text : IM_COL32(92, 98, 108, 255), number.c_str());
    for (const document::Coloured& c : colors) {
        const uint32_t a = std::min(start + c.begin, end), b = std::min(start + c.end, end);
        if (a < b)
            list.AddText(font, font->FontSize, {low.x + xOf(text, line, a), low.y}, tintOf(c.colour), text.data() + a,
                         text.data() + b);
    }
    for (const LineNote& note : notes) {
        if (note.line != line) continue;
        const float a = low.x + xOf(text, line, std::min(start + note.begin, end)),
                    b = low.x + xOf(text, line, std::min(start + note.end, end));
        list.AddLine({a, low.y + height_ - 1}, {std::max(b, a + 6), low.y + height_ - 1}, note.color, 1.5f);
    }
    // The caret blinks with half a second, by the frames there are.
    if (active_ && line == lineOf(caret_))
        list.AddLine({low.x + xOf(text, line, caret_), low.y}, {low.x + xOf(text, line, caret_), low.y + height_},
                     tint::text, 1.5f);
}

void CodeEditor::mouse(const std::string& text, ImVec2 origin) {
    clicked_ = false;
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    if (ImGui::IsMouseClicked(0) && !hovered) active_ = false;
    if (!hovered && !(active_ && ImGui::IsMouseDown(0))) return;
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
    const auto row = static_cast<size_t>(
        std::clamp((io.MousePos.y - origin.y) / height_, 0.0f, static_cast<float>(rows_.size() - 1)));
    const uint32_t at = offsetAt(text, rows_[row].line, io.MousePos.x - origin.x);
    if (hovered && ImGui::IsMouseClicked(0)) {
        active_ = true;
        caret_ = at;
        if (!io.KeyShift) anchor_ = at;
        clicked_ = true;
        wantedX_ = -1;
    } else if (active_ && ImGui::IsMouseDragging(0, 2)) {
        caret_ = at;
        clicked_ = false;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(0)) {
        anchor_ = caret_ = at;
        while (anchor_ > 0 && isWord(text[anchor_ - 1])) --anchor_;
        while (caret_ < text.size() && isWord(text[caret_])) ++caret_;
    }
}

std::string CodeEditor::replaced(const std::string& text, uint32_t begin, uint32_t end, const std::string& by) {
    std::string changed = text;
    changed.replace(begin, end - begin, by);
    caret_ = anchor_ = begin + static_cast<uint32_t>(by.size());
    follow_ = Follow::Caret;
    wantedX_ = -1;
    return changed;
}

void CodeEditor::moveBy(const std::string& text) {
    const ImGuiIO& io = ImGui::GetIO();
    const uint32_t line = lineOf(caret_);
    const auto pressed = [](int key) { return ImGui::IsKeyPressed(key); };
    const auto [from, to] = selection();
    const bool drops = from < to && !io.KeyShift;  // what is selected: the caret goes to that side of it
    const int page = std::max(1, static_cast<int>(ImGui::GetWindowHeight() / height_) - 1);
    const int rows = (pressed(GLFW_KEY_DOWN) ? 1 : 0) - (pressed(GLFW_KEY_UP) ? 1 : 0) +
                     (pressed(GLFW_KEY_PAGE_DOWN) ? page : 0) - (pressed(GLFW_KEY_PAGE_UP) ? page : 0);
    const bool left = pressed(GLFW_KEY_LEFT), right = pressed(GLFW_KEY_RIGHT), home = pressed(GLFW_KEY_HOME),
               end = pressed(GLFW_KEY_END);
    if (rows == 0 && !left && !right && !home && !end) return;
    if (rows != 0) {
        if (wantedX_ < 0) wantedX_ = xOf(text, line, caret_);
        const int row = std::clamp(static_cast<int>(line) + rows, 0, static_cast<int>(starts_.size()) - 1);
        caret_ = offsetAt(text, static_cast<uint32_t>(row), wantedX_);
    } else {
        wantedX_ = -1;
    }
    if (left && drops && !io.KeyCtrl) {
        caret_ = from;
    } else if (left) {
        caret_ = before(text, caret_);
        while (io.KeyCtrl && caret_ > 0 && (isWord(text[caret_ - 1]) || !isWord(text[caret_]))) --caret_;
    }
    if (right && drops && !io.KeyCtrl) {
        caret_ = to;
    } else if (right) {
        caret_ = after(text, caret_);
        while (io.KeyCtrl && caret_ < text.size() && (isWord(text[caret_]) || !isWord(text[caret_ - 1]))) ++caret_;
    }
    if (home) caret_ = io.KeyCtrl ? 0 : starts_[line];
    if (end) caret_ = io.KeyCtrl ? static_cast<uint32_t>(text.size()) : endOf(text, line);
    if (!io.KeyShift) anchor_ = caret_;
    follow_ = Follow::Caret;
}

std::string CodeEditor::taken(document::EditedText edited) {
    caret_ = edited.caret;
    anchor_ = edited.anchor;
    follow_ = Follow::Caret;
    wantedX_ = -1;
    return std::move(edited.text);
}

std::optional<std::string> CodeEditor::keys(const std::string& text) {
    ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [](int key) { return ImGui::IsKeyPressed(key); };
    if (pressed(GLFW_KEY_ESCAPE)) active_ = false;
    moveBy(text);
    const auto [from, to] = selection();
    const bool selected = from < to;
    if (io.KeyCtrl && !io.KeyAlt) {
        if (pressed(GLFW_KEY_A)) anchor_ = 0, caret_ = static_cast<uint32_t>(text.size());
        if ((pressed(GLFW_KEY_C) || pressed(GLFW_KEY_X)) && selected)
            ImGui::SetClipboardText(text.substr(from, to - from).c_str());
        if (pressed(GLFW_KEY_X) && selected) return replaced(text, from, to, "");
        if (pressed(GLFW_KEY_V))
            if (const char* clip = ImGui::GetClipboardText()) return replaced(text, from, to, clip);
        if (pressed(GLFW_KEY_SLASH) || pressed(GLFW_KEY_KP_DIVIDE))
            return taken(document::commented({text, caret_, anchor_}));
        return std::nullopt;
    }
    if (pressed(GLFW_KEY_BACKSPACE)) return replaced(text, selected ? from : before(text, from), to, "");
    if (pressed(GLFW_KEY_DELETE)) return replaced(text, from, selected ? to : after(text, to), "");
    if (pressed(GLFW_KEY_TAB) && (selected || io.KeyShift))
        return taken(document::indented({text, caret_, anchor_}, io.KeyShift));
    if (pressed(GLFW_KEY_TAB)) return replaced(text, from, to, "  ");
    if (pressed(GLFW_KEY_ENTER) || pressed(GLFW_KEY_KP_ENTER)) {
        // The new line begins below the old one.
        const uint32_t start = starts_[lineOf(from)];
        uint32_t indent = start;
        while (indent < from && text[indent] == ' ') ++indent;
        return replaced(text, from, to, "\n" + text.substr(start, indent - start));
    }
    std::string typed;
    for (const ImWchar c : io.InputQueueCharacters) {
        char bytes[5] = "";
        if (c >= 32 && c != 127) typed += ImTextCharToUtf8(bytes, c);
    }
    if (typed.empty()) return std::nullopt;
    return replaced(text, from, to, typed);
}

void CodeEditor::follow(const std::string& text) {
    const auto size = static_cast<uint32_t>(text.size());
    const uint32_t caret = std::min(caret_, size), at = follow_ == Follow::Caret ? caret : std::min(anchor_, caret);
    follow_ = Follow::No;
    const float y = static_cast<float>(rowOf_[lineOf(at)]) * height_;
    if (y < ImGui::GetScrollY() + height_ || y > ImGui::GetScrollY() + ImGui::GetWindowHeight() - 3 * height_)
        ImGui::SetScrollY(std::max(0.0f, y - ImGui::GetWindowHeight() * 0.35f));
    // Sideways: all of a word that is shown, or its first part where it is wider than the window.
    const float margin = height_ * 2, width = ImGui::GetWindowWidth() - margin, begin = xOf(text, lineOf(at), at);
    const float end = lineOf(caret) == lineOf(at) ? std::max(begin, xOf(text, lineOf(at), caret)) : begin;
    float x = ImGui::GetScrollX();
    if (end > x + width) x = end - width;
    if (begin < x + gutter_) x = begin < width ? 0 : begin - gutter_ - margin;
    if (x != ImGui::GetScrollX()) ImGui::SetScrollX(x);
}

void CodeEditor::drawNote(const LineNote& note, ImVec2 low) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 left(ImGui::GetWindowPos().x, low.y), right(left.x + ImGui::GetWindowWidth(), low.y + height_);
    list.AddRectFilled(left, right, (note.color & 0x00ffffff) | 0x24000000);
    // Where the line is scrolled sideways its note stays in sight, a wide one with its end.
    const float farthest = std::min(left.x + 8, right.x - 8 - ImGui::CalcTextSize(note.text.c_str()).x);
    list.AddText({std::max(low.x + gutter_, farthest), low.y + 1}, note.color, note.text.c_str());
    if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(left, right)) widgets::tooltip(note.text.c_str());
}

std::optional<std::string> CodeEditor::show(Report& report, const std::string& text,
                                            const std::vector<std::vector<document::Coloured>>& colors,
                                            const std::vector<LineNote>& notes) {
    height_ = std::round(codeFont()->FontSize * 1.32f);
    layOut(text, notes);
    gutter_ = widthOf("99999", 0, starts_.size() > 999 ? 5 : 4) + 14;
    std::optional<std::string> changed;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, IM_COL32(27, 28, 31, 255));
    if (ImGui::BeginChild("code", {0, 0}, false,
                          ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove)) {
        report.mark(
            "text", ImGui::GetWindowPos(),
            {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
        const ImVec2 origin = ImGui::GetCursorScreenPos();
        mouse(text, origin);
        if (active_ && !ImGui::GetTopMostPopupModal()) {  // a dialog takes the keys
            changed = keys(text);
            ImGui::GetCurrentContext()->WantTextInputNextFrame = 1;
        }
        const auto first = static_cast<size_t>(std::max(0.0f, ImGui::GetScrollY() / height_));
        const size_t last = std::min(rows_.size(), first + static_cast<size_t>(ImGui::GetWindowHeight() / height_) + 2);
        float widest = 0;
        for (uint32_t line = 0; line < starts_.size(); ++line)
            widest = std::max(widest, xOf(text, line, endOf(text, line)));
        ImDrawList& list = *ImGui::GetWindowDrawList();
        static const std::vector<document::Coloured> plain;
        for (size_t i = first; i < last; ++i) {
            const Row& row = rows_[i];
            const ImVec2 low(origin.x, origin.y + static_cast<float>(i) * height_);
            if (row.note < 0) {
                if (row.line ==
                        rows_[rowOf_[lineOf(std::min<uint32_t>(caret_, static_cast<uint32_t>(text.size())))]].line &&
                    active_)
                    list.AddRectFilled({ImGui::GetWindowPos().x, low.y},
                                       {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), low.y + height_},
                                       IM_COL32(255, 255, 255, 8));
                drawLine(text, row.line, row.line < colors.size() ? colors[row.line] : plain, notes, low);
                report.mark(fmt::format("line.{}", row.line + 1), {low.x + gutter_, low.y},
                            {low.x + xOf(text, row.line, endOf(text, row.line)), low.y + height_});
            } else {
                const LineNote& note = notes[size_t(row.note)];
                drawNote(note, low);
                report.mark(fmt::format("note.{}", row.note), {ImGui::GetWindowPos().x, low.y},
                            {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), low.y + height_});
                widest = std::max(widest, gutter_ + ImGui::CalcTextSize(note.text.c_str()).x);
            }
        }
        ImGui::Dummy({widest + 20, static_cast<float>(rows_.size()) * height_ + ImGui::GetWindowHeight() * 0.3f});
        scrolled_ = ImGui::GetScrollX();
        if (follow_ != Follow::No && !changed) follow(text);  // lines that have changed are laid out in the next frame
    }
    ImGui::EndChild();
    ImGui::PopStyleColor();
    return changed;
}

}  // namespace sgm::window
