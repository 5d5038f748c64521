#include <fmt/format.h>
#include <imgui.h>

#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::viewer {

using namespace widgets;

void ExportPanel::option(Workbench& bench, ExportRow& row) {
    const std::string name = "export." + row.name;
    const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(row.name.c_str());
    hint(row.doc.c_str());
    ImGui::SameLine(left + width * 0.4f);
    if (!row.choices.empty()) {
        int at = 0;
        for (size_t i = 0; i < row.choices.size(); ++i)
            if (row.choices[i] == row.value) at = static_cast<int>(i);
        if (choice(bench.report, name, row.choices, at)) row.value = row.choices[size_t(at)];
    } else {
        field(bench.report, name, row.value);
    }
    hint(row.doc.c_str());
}

void ExportPanel::show(Workbench& bench) {
    const auto formats = exporter::exporters();
    std::vector<std::string> names;
    for (const exporter::Exporter& f : formats) names.push_back(fmt::format("{}  {}", f.extension, f.doc.substr(0, f.doc.find(':'))));
    const bool first = format_ < 0;
    int format = std::max(format_, 0);
    heading("Format");
    if (choice(bench.report, "export.format", names, format) || first) {
        format_ = format;
        options_ = exportRows(formats[size_t(format)]);
        std::filesystem::path file = bench.document.path().empty() ? "untitled" : bench.document.path();
        file_ = file.replace_extension(formats[size_t(format)].extension).string();
    }
    ImGui::PushTextWrapPos(0);
    faint(std::string(formats[size_t(std::max(format_, 0))].doc));
    ImGui::PopTextWrapPos();
    heading("Options");
    const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("cells");
    ImGui::SameLine(left + width * 0.4f);
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::SliderInt("##cells", &resolution_, 32, 1024, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    bench.report.mark("export.cells");
    hint("Cells along the longest side of the model");
    for (ExportRow& row : options_) option(bench, row);
    heading("File");
    field(bench.report, "export.file", file_);
    ImGui::Dummy({0, 4});
    if (job_.running()) {
        ImGui::ProgressBar(static_cast<float>(job_.fraction()), {ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 5, 0}, std::string(job_.stage()).c_str());
        ImGui::SameLine();
        if (button(bench.report, "export.cancel", "Cancel")) job_.cancel();
    } else if (button(bench.report, "export.export", "Export", nullptr, bench.shown() != nullptr)) {
        ExportRequest request;
        request.file = file_;
        request.resolution = resolution_;
        for (const ExportRow& row : options_) request.options[row.name] = row.value;
        if (const Status s = job_.start(bench.session.model(), std::move(request), wake_); !s) bench.say(s.error().message, true);
    }
    if (const auto outcome = job_.take()) *outcome ? bench.say("Wrote " + file_) : bench.say(outcome->error().message, true);
}

}  // namespace sgm::viewer
