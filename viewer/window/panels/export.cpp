#include <fmt/format.h>
#include <imgui.h>

#include "viewer/document/typed_path.h"
#include "viewer/window/panels.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {

using namespace widgets;

void ExportPanel::option(Workbench& bench, document::ExportRow& row) {
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

void ExportPanel::take(size_t format) {
    format_ = format;
    options_ = document::exportRows(exporter::exporters()[format]);
}

void ExportPanel::chooseFormat(Workbench& bench) {
    const auto formats = exporter::exporters();
    std::vector<std::string> names;
    for (const exporter::Exporter& f : formats)
        names.push_back(fmt::format("{}  {}", f.extension, f.doc.substr(0, f.doc.find(':'))));
    const std::filesystem::path document = bench.document.path().empty() ? "untitled" : bench.document.path();
    heading("Format");
    int format = static_cast<int>(format_);
    const bool chosen = choice(bench.report, "export.format", names, format), another = document_ != document;
    if (another) file_ = (document_ = document).string();
    if (chosen || another) {
        const exporter::Exporter* before = exporter::exporterFor(file_);
        if (before) file_.resize(file_.size() - before->extension.size());
        take(size_t(format));
        file_ = (before ? file_ : std::filesystem::path(file_).replace_extension().string())
                    .append(formats[format_].extension);
    }
    ImGui::PushTextWrapPos(0);
    faint(std::string(formats[format_].doc));
    ImGui::PopTextWrapPos();
}

void ExportPanel::chooseMesh(Workbench& bench) {
    const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    const auto name = [&](const char* text, const char* doc) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(text);
        hint(doc);
        ImGui::SameLine(left + width * 0.4f);
    };
    constexpr const char* cells = "Cells along the longest side of the model";
    name("cells", cells);
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::SliderInt("##cells", &resolution_, 32, 1024, "%d",
                     ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    bench.report.mark("export.cells");
    hint(cells);
    constexpr const char* solids =
        "Which separate solids are written: all, those that stand and aren't debris, or the largest one; the latter "
        "two fill closed cavities";
    name("keep", solids);
    const std::string kept[] = {"all", "grounded", "largest"};  // by mesh::Keep
    choice(bench.report, "export.keep", kept, keep_);
    hint(solids);
    if (!exporter::exporters()[format_].holdsObjects) return;
    constexpr const char* divided =
        "Into which objects the surface is divided: none, material, shape, or the shapes of symbols: Storey,Window";
    name("objects", divided);
    field(bench.report, "export.objects", objects_);
    hint(divided);
}

void ExportPanel::show(Workbench& bench) {
    chooseFormat(bench);
    heading("Options");
    chooseMesh(bench);
    for (document::ExportRow& row : options_) option(bench, row);
    heading("File");
    // The ending says the format, whichever of the two is changed, and while it is typed: later, the button would move
    // away from a click that ends the typing.
    const auto formats = exporter::exporters();
    field(bench.report, "export.file", file_);
    const bool done = entered();
    if (const exporter::Exporter* named = exporter::exporterFor(file_); named && named != &formats[format_])
        take(static_cast<size_t>(named - formats.data()));
    ImGui::Dummy({0, 4});
    const bool isPossible = bench.shown() && !bench.exporting.running();
    if (button(bench.report, "export.export", "Export", nullptr, isPossible) || (done && isPossible)) {
        document::ExportRequest request;
        request.file = document::typedPath(file_);
        request.resolution = resolution_;
        request.keep = static_cast<mesh::Keep>(keep_);
        request.objects = objects_;
        for (const document::ExportRow& row : options_) request.options[row.name] = row.value;
        start(bench, std::move(request));
    }
}

void ExportPanel::start(Workbench& bench, document::ExportRequest request) {
    const std::filesystem::path file = request.file;
    std::error_code failed;
    // What this window has written it may write again.
    if (written_.contains(file) || !std::filesystem::exists(file, failed)) {
        written_.insert(file);
        return bench.exportTo(std::move(request));
    }
    bench.panels.question = Question{file.string() + " exists; replace it?",
                                     {{"Replace",
                                       [this, &bench, request = std::move(request)] {
                                           written_.insert(request.file);
                                           bench.exportTo(request);
                                       }},
                                      {"Cancel", {}}}};
}

}  // namespace sgm::window
