// The L-systems of the Step panel: letters pass by pass, and the turtle's way letter by letter.
#include <fmt/format.h>
#include <imgui.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

using namespace widgets;
using document::DrawnPoint;
using document::LettersShown;
using document::LetterStep;

constexpr size_t mostDrawn = 20'000;                        // steps; more would only be a cloud of lines
constexpr size_t lettersBefore = 400, lettersBehind = 800;  // of the one that the turtle reads

/// From the turtle's plane to a rectangle of the screen, all of the way inside.
class Canvas {
public:
    Canvas(const std::vector<LetterStep>& steps, ImVec2 low, ImVec2 size) {
        DrawnPoint least{0, 0}, most{0, 0};
        for (const LetterStep& step : steps)
            for (const DrawnPoint p : {step.from, step.to}) {
                least = {std::min(least.right, p.right), std::min(least.up, p.up)};
                most = {std::max(most.right, p.right), std::max(most.up, p.up)};
            }
        constexpr float margin = 10;
        const double width = std::max(most.right - least.right, 1e-6), height = std::max(most.up - least.up, 1e-6);
        scale_ = std::min((size.x - 2 * margin) / width, (size.y - 2 * margin) / height);
        middle_ = {(least.right + most.right) / 2, (least.up + most.up) / 2};
        centre_ = {low.x + size.x / 2, low.y + size.y / 2};
    }
    ImVec2 operator()(DrawnPoint p) const {
        return {centre_.x + static_cast<float>((p.right - middle_.right) * scale_),
                centre_.y - static_cast<float>((p.up - middle_.up) * scale_)};
    }

private:
    double scale_ = 1;
    DrawnPoint middle_;
    ImVec2 centre_;
};

void drawWay(const LettersShown& shown, size_t letter) {
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 low = ImGui::GetCursorScreenPos(), size(width, std::floor(width * .62f));
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(14, 16, 20, 160), 4);
    const Canvas canvas(shown.steps, low, size);
    const size_t count = std::min(shown.steps.size(), mostDrawn);
    const LetterStep* last = nullptr;
    for (size_t i = 0; i < count; ++i) {
        const LetterStep& step = shown.steps[i];
        const bool isRead = step.at < letter;
        list.AddLine(canvas(step.from), canvas(step.to), isRead ? tint::nonTerminal : IM_COL32(120, 126, 138, 90),
                     isRead ? 2.0f : 1.0f);
        if (isRead) last = &step;
    }
    const float r = ImGui::GetFontSize() * .22f;
    list.AddCircleFilled(canvas(last                  ? last->to
                                : shown.steps.empty() ? DrawnPoint{}
                                                      : shown.steps[0].from),
                         r, tint::selected);
}

/// The letters around the one that is read next, in lines as wide as the panel: what is read bright, the next one lit.
void drawLetters(const LettersShown& shown, size_t letter) {
    ImGui::PushFont(codeFont());
    const float glyph = ImGui::CalcTextSize("M").x, line = ImGui::GetTextLineHeightWithSpacing();
    const auto columns = static_cast<size_t>(std::max(8.0f, ImGui::GetContentRegionAvail().x / glyph));
    const size_t all = shown.letters.text.size(), begin = letter > lettersBefore ? letter - lettersBefore : 0,
                 end = std::min(all, letter + lettersBehind);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    size_t column = 0, row = 0;
    const auto say = [&](const std::string& text, ImU32 color) {
        if (column > 0 && column + text.size() > columns) column = 0, ++row;
        list.AddText({low.x + glyph * static_cast<float>(column), low.y + line * static_cast<float>(row)}, color,
                     text.c_str());
        column += text.size();
    };
    if (begin > 0) say("…", tint::faint);
    for (size_t i = begin; i < end; ++i)
        say(document::textOf(shown.letters, i, 1), i == letter  ? tint::selected
                                                   : i < letter ? ImGui::GetColorU32(ImGuiCol_Text)
                                                                : ImGui::GetColorU32(ImGuiCol_TextDisabled));
    if (end < all) say("…", tint::faint);
    ImGui::PopFont();
    ImGui::Dummy({1, line * static_cast<float>(row + 1)});
}

}  // namespace

bool LettersView::take(Workbench& bench, const std::vector<uint32_t>& known) {
    if (std::find(known.begin(), known.end(), lsystem_) == known.end()) lsystem_ = known[0], passes_ = mostPasses;
    const auto& model = bench.session.model();
    if (of_ == model && made_.lsystem == lsystem_ && asked_ == passes_) return fault_.empty();
    of_ = model;
    asked_ = passes_;
    auto made = document::lettersAfter(*model, lsystem_, passes_);
    fault_ = made ? "" : made.error().message;
    made_ = made ? std::move(*made) : LettersShown{};
    made_.lsystem = lsystem_;
    letter_ = static_cast<int>(made_.letters.text.size());
    return fault_.empty();
}

void LettersView::show(Workbench& bench) {
    const std::vector<uint32_t> known = document::lettersRead(*bench.shown());
    if (known.empty()) return;
    heading("Letters");
    const bool isWhole = take(bench, known);
    if (known.size() > 1) {
        std::vector<std::string> names;
        for (const uint32_t lsystem : known) names.push_back(bench.shown()->grammar->lsystems[lsystem].name);
        int at = static_cast<int>(std::find(known.begin(), known.end(), lsystem_) - known.begin());
        if (choice(bench.report, "letters.lsystem", names, at)) lsystem_ = known[static_cast<size_t>(at)];
    }
    if (!isWhole) return faint(fault_);
    const uint32_t pass = made_.passes, all = made_.all;
    if (button(bench.report, "letters.fewer", "-", "A pass fewer", pass > 0)) passes_ = pass - 1;
    ImGui::SameLine();
    if (button(bench.report, "letters.more", "+", "Another pass", pass < all)) passes_ = pass + 1;
    ImGui::SameLine();
    const int letters = static_cast<int>(made_.letters.text.size());
    ImGui::TextUnformatted(fmt::format("{}: pass {} of {}, {} letters", bench.shown()->grammar->lsystems[lsystem_].name,
                                       pass, all, letters)
                               .c_str());
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderInt("##letter", &letter_, 0, letters, "letter %d");
    bench.report.mark("letters.letter");
    hint("How far the turtle reads; the letters stay as the grammar makes them");
    if (bench.report.active())
        bench.report.state()["letters"] = {{"pass", pass}, {"count", letters}, {"read", letter_}};
    drawWay(made_, static_cast<size_t>(letter_));
    if (ImGui::BeginChild("letters")) drawLetters(made_, static_cast<size_t>(letter_));
    ImGui::EndChild();
}

}  // namespace sgm::window
