#include "viewer/window/dialogs.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "viewer/document/typed_path.h"
#include "viewer/window/style.h"
#include "viewer/window/widgets.h"

namespace sgm::window {
namespace {

namespace fs = std::filesystem;
using namespace widgets;

constexpr const char *openTitle = "Open a grammar", *saveTitle = "Save as", *questionTitle = "Question";

bool escaped() { return ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false); }

/// A sentence in the colour of errors, wrapped at the dialog's edge.
void complain(const std::string& text) {
    ImGui::PushTextWrapPos(0);
    ImGui::PushStyleColor(ImGuiCol_Text, tint::error);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
}

}  // namespace

void Dialogs::show(Workbench& bench) {
    openDialog(bench);
    saveDialog(bench);
    questions(bench);
}

void Dialogs::files(Workbench& bench, const fs::path& folder, const std::string& prefix) {
    std::error_code failed;
    std::vector<fs::path> folders, grammars;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with('.') || !name.starts_with(prefix)) continue;
        if (entry.is_directory(failed))
            folders.push_back(entry.path());
        else if (entry.path().extension() == ".sgm")
            grammars.push_back(entry.path());
    }
    std::sort(folders.begin(), folders.end());
    std::sort(grammars.begin(), grammars.end());
    if (ImGui::Selectable("..", false, ImGuiSelectableFlags_DontClosePopups)) path_ = folder.parent_path().string();
    for (const fs::path& path : folders)
        if (ImGui::Selectable((path.filename().string() + "/").c_str(), false, ImGuiSelectableFlags_DontClosePopups))
            path_ = path.string();
    for (const fs::path& path : grammars) {
        if (ImGui::Selectable(path.filename().c_str())) {
            bench.drop(path);
            ImGui::CloseCurrentPopup();
        }
        bench.report.mark("open." + path.filename().string());
    }
}

void Dialogs::openDialog(Workbench& bench) {
    if (std::exchange(opening_, false)) {
        const fs::path here =
            bench.document.path().empty() ? fs::current_path() : fs::absolute(bench.document.path()).parent_path();
        path_ = here.lexically_normal().string();
        fault_.clear();
        ImGui::OpenPopup(openTitle);
    }
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 34, ImGui::GetFontSize() * 30});
    if (!ImGui::BeginPopupModal(openTitle, nullptr, ImGuiWindowFlags_NoSavedSettings)) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    field(bench.report, "open.folder", path_, "A folder, or a grammar's file");
    const bool done = entered();
    if (ImGui::IsItemEdited()) fault_.clear();
    const fs::path typed = document::typedPath(path_);
    std::error_code failed;
    const bool isFolder = fs::is_directory(typed, failed), isFile = fs::is_regular_file(typed, failed);
    if (done && !isFolder && !isFile) fault_ = fmt::format("There is no file '{}'", typed.string());
    const float below = ImGui::GetFrameHeightWithSpacing() * (fault_.empty() ? 1 : 2) + 4;
    if (ImGui::BeginChild("files", {0, -below}, true))
        files(bench, isFolder ? typed : typed.parent_path(), isFolder ? "" : typed.filename().string());
    ImGui::EndChild();
    if (!fault_.empty()) complain(fault_);
    if (button(bench.report, "open.open", "Open", nullptr, isFile) || (done && isFile)) {
        bench.drop(typed);
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (button(bench.report, "open.cancel", "Cancel") || escaped()) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void Dialogs::saveUnderName(Workbench& bench, bool replacing) {
    const fs::path path = document::typedPath(name_);
    std::error_code failed;
    fault_.clear();
    if (fs::is_directory(path, failed)) {
        fault_ = fmt::format("'{}' is a folder", path.string());
        return;
    }
    // Its own file is no other: saving it again tells what another program did to it.
    const bool isOwn = !bench.document.path().empty() && fs::equivalent(path, bench.document.path(), failed);
    if (!isOwn && !replacing && fs::exists(path, failed)) {
        replaces_ = name_;
        return;
    }
    if (const Status s = isOwn ? bench.document.save() : bench.document.saveAs(path); !s) {
        fault_ = s.error().message;
        replaces_.clear();
        return;
    }
    bench.say("Saved " + path.string());
    const Naming naming = *std::exchange(bench.panels.naming, std::nullopt);
    if (naming.then) naming.then();
}

void Dialogs::saveDialog(Workbench& bench) {
    if (bench.panels.naming && !ImGui::IsPopupOpen(saveTitle)) {
        name_ = bench.document.path().empty() ? (fs::current_path() / "untitled.sgm").string()
                                              : fs::absolute(bench.document.path()).lexically_normal().string();
        replaces_.clear();
        fault_.clear();
        ImGui::OpenPopup(saveTitle);
    }
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 34, 0});
    if (!ImGui::BeginPopupModal(saveTitle, nullptr, ImGuiWindowFlags_NoSavedSettings)) return;
    const bool again = escaped() && !replaces_.empty();
    if (ImGui::IsWindowAppearing() || again) ImGui::SetKeyboardFocusHere();
    field(bench.report, "save.name", name_);
    bool save = entered(), close = escaped() && !again;
    if (again || replaces_ != name_) replaces_.clear();
    if (ImGui::IsItemEdited()) fault_.clear();
    if (!fault_.empty()) complain(fault_);
    if (!replaces_.empty()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(
            fmt::format("{} exists; replace it?", document::typedPath(name_).filename().string()).c_str());
        ImGui::PopTextWrapPos();
        if (button(bench.report, "save.replace", "Replace")) saveUnderName(bench, true);
        ImGui::SameLine();
        if (button(bench.report, "save.keep", "Cancel")) replaces_.clear();
    } else {
        save |= button(bench.report, "save.save", "Save", nullptr, !name_.empty());
        ImGui::SameLine();
        close |= button(bench.report, "save.cancel", "Cancel");
        if (close)
            bench.panels.naming.reset();
        else if (save && !name_.empty())
            saveUnderName(bench, false);
    }
    if (!bench.panels.naming) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void Dialogs::questions(Workbench& bench) {
    // It waits for another dialog to be done, which it would close.
    if (bench.panels.question && !ImGui::GetTopMostPopupModal()) ImGui::OpenPopup(questionTitle);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(
            questionTitle, nullptr,
            ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize))
        return;
    if (bench.panels.question) {
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
        ImGui::TextUnformatted(bench.panels.question->text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::Dummy({0, 4});
        const auto answers = bench.panels.question->answers;
        for (size_t i = 0; i < answers.size(); ++i) {
            if (i > 0) ImGui::SameLine();
            const bool pressed = button(bench.report, "answer." + answers[i].first, answers[i].first.c_str());
            // Esc is the answer that changes nothing, where there is one.
            if (!pressed && (answers[i].second || !escaped())) continue;
            bench.panels.question.reset();
            if (answers[i].second) answers[i].second();
            ImGui::CloseCurrentPopup();
            break;
        }
    } else {
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace sgm::window
