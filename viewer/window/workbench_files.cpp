#include <fmt/format.h>

#include <algorithm>

#include "viewer/window/workbench.h"

namespace sgm::window {
namespace {

/// The same file by whatever name; one that is gone, by its name.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code failed;
    return std::filesystem::equivalent(a, b, failed) || (failed && a.lexically_normal() == b.lexically_normal());
}

/// Saves, under a name to be chosen where there is none, and goes on once that is done.
void saveThen(Workbench& bench, const std::function<void()>& then) {
    if (bench.document.path().empty()) {
        bench.panels.naming = Naming{then};
        return;
    }
    bench.save();
    if (!bench.document.dirty()) then();
}

}  // namespace

void Workbench::offerAbandoned() {
    const std::vector<document::Abandoned> left = document::abandonedWork();
    if (left.empty()) return;
    std::error_code ignored;
    const std::filesystem::path here = std::filesystem::absolute(document.path(), ignored);
    const auto about = document.path().empty()
                           ? left.begin()
                           : std::find_if(left.begin(), left.end(),
                                          [&](const document::Abandoned& a) { return sameFile(a.document, here); });
    const auto nameOf = [](const document::Abandoned& a) {
        return a.document.empty() ? "a grammar without a name" : a.document.filename().string();
    };
    if (about == left.end() && !panels.notice.empty()) return;
    if (about == left.end())
        return say(fmt::format("Unsaved work on {} is kept; {} to go on with it", nameOf(left.front()),
                               left.front().document.empty() ? "start without a file" : "open it"));
    const document::Abandoned work = *about;
    const std::string name = nameOf(work);
    panels.question = Question{fmt::format("The window was closed by force; unsaved work on {} was kept.", name),
                               {{"Go on with it",
                                 [this, work] {
                                     show(document::Document::recovered(work.document, work.text));
                                     recovery_.keep(document);
                                     discard(work);
                                 }},
                                {"Throw it away", [work] { discard(work); }},
                                {"Later", {}}}};
}

void Workbench::drop(const std::filesystem::path& path, const std::function<void()>& then) {
    const auto go = [this, path, then] {
        if (const Status s = open(path); !s) return say(s.error().message, true);
        if (then) then();
        offerAbandoned();
    };
    if (!document.dirty()) return go();
    panels.question = Question{
        fmt::format("{} isn't saved.", document.path().empty() ? "This grammar" : document.path().filename().string()),
        {{"Save and open", [this, go] { saveThen(*this, go); }}, {"Open without saving", go}, {"Stay", {}}}};
}

bool Workbench::mayClose() {
    if (!document.dirty()) return true;
    panels.question = Question{
        fmt::format("{} isn't saved.", document.path().empty() ? "This grammar" : document.path().filename().string()),
        {{"Save and close", [this] { saveThen(*this, [this] { panels.leaving = true; }); }},
         {"Close without saving", [this] { panels.leaving = true; }},
         {"Stay", {}}}};
    return false;
}

bool Workbench::lookAtFiles() {
    if (session.usedFilesChanged()) asked_.revision = ~uint64_t(0);
    const bool wasNew = panels.fileIsNew;
    std::error_code ignored;
    panels.fileIsNew = wasNew && !std::filesystem::exists(document.path(), ignored);
    switch (document.poll()) {
        case document::Document::Outside::Same:
            return asked_.revision == ~uint64_t(0) || panels.fileIsNew != wasNew;
        case document::Document::Outside::Reloaded:
            say("The file was changed by another program, and is read again");
            break;
        case document::Document::Outside::Gone:
            say("The file can't be read any more; save to write it again", true);
            break;
        case document::Document::Outside::Conflict:
            if (panels.question) return false;
            panels.question = Question{"Another program has changed the file, and so have you.",
                                       {{"Take the file", [this] { (void)document.takeOutside(); }},
                                        {"Keep mine", [this] { (void)document.keepMine(); }}}};
    }
    return true;
}

}  // namespace sgm::window
