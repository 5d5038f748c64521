#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <cctype>
#include <cmath>

#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

using namespace widgets;

/// A padlock, shut or open.
bool lockButton(Report& report, const std::string& name, bool locked) {
    const float size = ImGui::GetFrameHeight();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(name.c_str(), {size * 0.8f, size});
    report.mark(name);
    hint(locked ? "A re-roll leaves it alone" : "Lock it against re-rolls");
    const ImU32 color =
        locked ? tint::selected : ImGui::GetColorU32(ImGuiCol_TextDisabled, ImGui::IsItemHovered() ? 1.0f : 0.45f);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 c(low.x + size * 0.4f, low.y + size * 0.5f);
    const float r = size * 0.13f;
    list.PathArcTo({c.x + (locked ? 0 : r * 0.9f), c.y - r * 0.6f}, r, -3.14159f, 0);
    list.PathStroke(color, 0, 1.5f);
    list.AddRectFilled({c.x - r * 1.5f, c.y - r * 0.5f}, {c.x + r * 1.5f, c.y + r * 1.7f}, color, 1.5f);
    return pressed;
}

std::string formatOf(const document::ParamRow& row) {
    const std::string unit = row.unit == "deg" ? "°" : row.unit == "%" ? "%%" : row.unit.empty() ? "" : " " + row.unit;
    if (row.kind == document::ParamRow::Kind::Integer) return "%.0f" + unit;
    const double span = row.lo.empty() ? 10 : row.hi[0] - row.lo[0];
    return fmt::format("%.{}f{}", span > 50 ? 1 : span > 3 ? 2 : 3, unit);
}

}  // namespace

void ParametersPanel::show(Workbench& bench) {
    ImGui::PushFont(strongFont());
    ImGui::TextUnformatted("Parameters");
    ImGui::PopFont();
    if (!bench.shown()) return faint("They come with the first model.");
    choices(bench);
    list(bench);
    if (ImGui::BeginChild("rows")) {
        // As wide as the longest label asks for, within what leaves the sliders room.
        float longest = 0;
        for (const document::ParamRow& r : rows_)
            if (r.number.size() < 3) longest = std::max(longest, ImGui::CalcTextSize(r.label.c_str()).x);
        labelShare_ = std::clamp((longest + 10) / ImGui::GetContentRegionAvail().x, 0.3f, 0.54f);
        std::string group;
        for (const document::ParamRow& r : rows_) {
            if (r.group != group && !r.group.empty()) heading(r.group.c_str());
            group = r.group;
            row(bench, r);
        }
        newParameter(bench);
        reports(bench);
        styles(bench);
    }
    ImGui::EndChild();
}

void ParametersPanel::newParameter(Workbench& bench) {
    const FieldWithButton row{
        .field = "param.new",
        .empty = "name = value in least..most",
        .fieldHint =
            "A parameter as it is written: 'name = value in least..most', 'name = brick of brick, stone', 'name = "
            "true'",
        .button = "param.add",
        .label = "Add",
        .buttonHint = "Add the parameter to the text",
        .isCode = true,
    };
    if (fieldWithButton(bench.report, row, newParameter_))
        bench.edit(document::edits::addParameter(*bench.document.ast(), newParameter_), "Add a parameter");
}

void ParametersPanel::reports(Workbench& bench) {
    if (reported_ != bench.session.model()) {
        reported_ = bench.session.model();
        reports_ = document::reportRows(reported_->model.derivation);
    }
    if (reports_.empty()) return;
    heading("Reports");
    for (const document::ReportRow& row : reports_) {
        ImGui::AlignTextToFramePadding();
        faint(row.name.c_str());
        ImGui::SameLine(labelShare_ * ImGui::GetContentRegionAvail().x);
        ImGui::TextUnformatted(row.sum.c_str());
        hint(row.details.c_str());
        bench.report.mark("reports." + row.name);
    }
}

void ParametersPanel::list(Workbench& bench) {
    rows_ = paramRows(*bench.shown()->grammar, bench.shown()->options, bench.document.choice());
    if (aheadRevision_ != bench.document.revision() || bench.shown()->revision == aheadRevision_) ahead_.clear();
    for (const document::ParamRow& row : ahead_)
        for (document::ParamRow& r : rows_)
            if (r.name == row.name) r = row;
}

void ParametersPanel::set(Workbench& bench, const document::ParamRow& row) {
    const bool goesOn = aheadRevision_ == bench.document.revision();
    bench.edit(setParams(*bench.document.ast(), bench.document.choice(), {row}), "Set " + row.name);
    if (!goesOn) ahead_.clear();
    std::erase_if(ahead_, [&](const document::ParamRow& r) { return r.name == row.name; });
    ahead_.push_back(row);
    aheadRevision_ = bench.document.revision();
}

void ParametersPanel::choices(Workbench& bench) {
    document::Choice choice = bench.document.choice();
    const rules::Grammar& grammar = *bench.shown()->grammar;
    const float room = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const std::vector<std::string> starts = document::startsOf(grammar);
    if (starts.size() > 1) {
        int at = 0;
        for (size_t i = 0; i < starts.size(); ++i)
            if (starts[i] == choice.start) at = static_cast<int>(i);
        if (widgets::choice(bench.report, "choice.start", starts, at)) {
            choice.start = starts[size_t(at)];
            choice.style.clear();
            bench.document.choose(choice, "Start " + choice.start);
        }
        hint("What the derivation starts from");
    }
    std::vector<std::string> styles = document::stylesFor(grammar, bench.shown()->options.start),
                             ways = document::waysOf(grammar);
    const auto oneOfNames = [&](const char* name, std::vector<std::string>& names, const char* none,
                                std::string& chosen, const char* why, float width) {
        int at = 0;
        names.insert(names.begin(), none);
        for (size_t i = 1; i < names.size(); ++i)
            if (names[i] == chosen) at = static_cast<int>(i);
        const bool changed = widgets::choice(bench.report, name, names, at, width);
        if (changed) chosen = at ? names[size_t(at)] : "";
        hint(why);
        return changed;
    };
    if (!styles.empty() &&
        oneOfNames("choice.style", styles, "No style", choice.style, "A named set of values; changes are written to it",
                   ways.empty() ? room : (room - gap) / 2))
        bench.document.choose(choice, "Style");
    if (!styles.empty() && !ways.empty()) ImGui::SameLine();
    if (!ways.empty() &&
        oneOfNames("choice.way", ways, "Automatic", choice.way, "A `derive` line, or the automatic derivation", 0))
        bench.document.choose(choice, "Way");
    const float button = buttonWidth("Re-roll");
    ImGui::AlignTextToFramePadding();
    faint("Seed");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - gap);
    ImGui::InputScalar("##seed", ImGuiDataType_U64, &choice.seed);
    if (ImGui::IsItemDeactivatedAfterEdit()) bench.document.choose(choice, fmt::format("Seed {}", choice.seed));
    bench.report.mark("seed");
    ImGui::SameLine();
    if (widgets::button(bench.report, "reroll", "Re-roll", "Another seed, and other values for what isn't locked")) {
        ++choice.seed;
        bench.document.beginDrag();  // both changes are one entry
        bench.document.choose(choice, "Re-roll");
        bench.edit(setParams(*bench.document.ast(), choice, rerolled(rows_, choice.seed)), "Re-roll");
        bench.document.endDrag();
    }
}

bool ParametersPanel::numbers(Workbench& bench, document::ParamRow& row) {
    const std::string name = "param." + row.name, format = formatOf(row);
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight(), gap = 3;
    const float each = (room + gap) / static_cast<float>(row.number.size()) - gap;
    bool changed = false;
    for (size_t i = 0; i < row.number.size(); ++i) {
        if (i > 0) ImGui::SameLine(0, gap);
        ImGui::SetNextItemWidth(each);
        ImGui::PushID(static_cast<int>(i));
        double value = row.number[i];
        const bool moved = row.lo.empty()
                               ? ImGui::DragScalar("##n", ImGuiDataType_Double, &value,
                                                   std::max(0.01f, std::abs(static_cast<float>(value)) * 0.01f),
                                                   nullptr, nullptr, format.c_str())
                               : ImGui::SliderScalar("##n", ImGuiDataType_Double, &value, &row.lo[i], &row.hi[i],
                                                     format.c_str(), ImGuiSliderFlags_AlwaysClamp);
        if (moved) row.number[i] = row.kind == document::ParamRow::Kind::Integer ? std::round(value) : value;
        changed |= moved;
        bench.report.mark(row.number.size() == 1 ? name : fmt::format("{}.{}", name, i));
        if (ImGui::IsItemActivated()) bench.document.beginDrag();
        if (ImGui::IsItemDeactivated()) {
            bench.document.endDrag();
            held_.reset();
        }
        ImGui::PopID();
    }
    return changed;
}

bool ParametersPanel::color(Workbench& bench, document::ParamRow& row) {
    // ImGui's swatch speaks sRGB.
    const auto curve = [](double v, bool back) {
        return back ? (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4))
                    : (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
    };
    float rgb[3];
    for (size_t i = 0; i < 3; ++i) rgb[i] = static_cast<float>(curve(row.color[i], false));
    const bool changed = ImGui::ColorEdit3("##color", rgb, ImGuiColorEditFlags_NoInputs);
    bench.report.mark("param." + row.name);
    for (size_t i = 0; changed && i < 3; ++i) row.color[i] = curve(rgb[i], true);
    if (ImGui::IsItemActivated()) bench.document.beginDrag();
    if (ImGui::IsItemDeactivated()) bench.document.endDrag();
    return changed;
}

bool ParametersPanel::control(Workbench& bench, document::ParamRow& row) {
    const std::string name = "param." + row.name;
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight();
    bool changed = false;
    switch (row.kind) {
        case document::ParamRow::Kind::Integer:
        case document::ParamRow::Kind::Real:
            return numbers(bench, row);
        case document::ParamRow::Kind::Choice: {
            int at = 0;
            for (size_t i = 0; i < row.choices.size(); ++i)
                if (row.choices[i] == row.word) at = static_cast<int>(i);
            changed = choice(bench.report, name, row.choices, at, room);
            if (changed) row.word = row.choices[size_t(at)];
            break;
        }
        case document::ParamRow::Kind::Color:
            return color(bench, row);
        case document::ParamRow::Kind::Truth: {
            bool truth = row.number[0] != 0;
            changed = toggle(bench.report, name, "", truth);
            row.number[0] = truth;
            break;
        }
        case document::ParamRow::Kind::Text:
            changed = field(bench.report, name, row.word, nullptr, room);
            break;
    }
    return changed;
}

void ParametersPanel::row(Workbench& bench, document::ParamRow row) {
    if (held_ && held_->name == row.name) row = *held_;
    ImGui::PushID(row.name.c_str());
    const float width = ImGui::GetContentRegionAvail().x, left = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    // Many numbers get a line of their own.
    const bool wide = row.number.size() >= 3;
    const float labelWidth = wide ? 0 : labelShare_ * width;
    ImGui::TextUnformatted(shortened(row.label, (wide ? width - ImGui::GetFrameHeight() : labelWidth) - 6).c_str());
    const std::string why =
        fmt::format("{} ({}){}", row.label, row.name, row.key ? fmt::format(", key {}", row.key) : "");
    hint(why.c_str());
    if (!wide) ImGui::SameLine(left + labelWidth);
    const bool active = held_.has_value();
    if (control(bench, row)) {
        if (row.kind == document::ParamRow::Kind::Integer || row.kind == document::ParamRow::Kind::Real) held_ = row;
        set(bench, row);
    }
    if (active && !ImGui::IsMouseDown(0) && !ImGui::GetIO().WantTextInput) held_.reset();
    ImGui::SameLine(left + width - ImGui::GetFrameHeight() * 0.8f);
    if (lockButton(bench.report, "lock." + row.name, row.locked)) {
        document::Choice choice = bench.document.choice();
        if (!choice.locked.erase(row.name)) choice.locked.insert(row.name);
        bench.document.choose(choice, row.locked ? "Unlock " + row.name : "Lock " + row.name);
    }
    ImGui::PopID();
}

void ParametersPanel::styles(Workbench& bench) {
    if (rows_.empty()) return faint("The grammar has no parameters.");
    heading("Keep these values");
    const FieldWithButton row{.field = "style.name",
                              .empty = "Name of a style",
                              .button = "style.save",
                              .label = "Save style",
                              .buttonHint = "Write a `style` with all values into the text"};
    if (!fieldWithButton(bench.report, row, styleName_, [&] { return !styleName_.empty(); })) return;
    std::vector<document::edits::NamedValue> values;
    for (const document::ParamRow& r : rows_) values.push_back({r.name, valueText(r)});
    const rules::Grammar& grammar = *bench.shown()->grammar;
    const std::string& start = grammar.symbols[grammar.starts[bench.shown()->options.start].symbol].name;
    bench.edit(document::edits::saveStyle(*bench.document.ast(), styleName_, start, values),
               "Save style " + styleName_);
}

void ParametersPanel::keys(Workbench& bench) {
    bench.panels.hotkeys.clear();
    for (const document::ParamRow& r : rows_)
        if (r.key) bench.panels.hotkeys += r.key;
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl || io.KeyAlt || io.KeySuper) return;
    for (const ImWchar c : io.InputQueueCharacters) {
        if (c > 127) continue;
        const document::ParamRow* row = rowOfKey(rows_, static_cast<char>(std::tolower(c)));
        if (!row) continue;
        set(bench, stepped(*row, std::isupper(c)));
        list(bench);  // the next letter steps on from here
    }
}

}  // namespace sgm::window
