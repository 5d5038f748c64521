#include "viewer/document/document.h"

#include <fmt/format.h>

#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/syntax/parser.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/stopwatch.h"

namespace sgm::document {
namespace fs = std::filesystem;

Document::Document(std::string text) : saved_(text) { setText(std::move(text)); }

/// Why no grammar may begin as `path`; "" where it may.
static std::string whyNotBegun(const fs::path& path) {
    std::error_code failed;
    if (path.extension() != ".sgm") return "a new grammar's name ends with '.sgm'";
    const fs::path folder = path.parent_path();
    return folder.empty() || fs::is_directory(folder, failed) ? ""
                                                              : fmt::format("there is no folder '{}'", folder.string());
}

Result<Document> Document::open(const fs::path& path, bool mayBegin) {
    std::error_code failed;
    const bool begins = mayBegin && fs::symlink_status(path, failed).type() == fs::file_type::not_found;
    Document document;
    if (begins) {
        if (const std::string why = whyNotBegun(path); !why.empty())
            return Error{Error::Kind::Input, fmt::format("can't open '{}': {}", path.string(), why)};
    } else {
        const auto stamp = stampOf(path);
        const auto source = pipeline::readSource(path);
        if (!source.ok()) return source.error();
        document = Document{std::string((*source)->text())};
        document.stamp_ = stamp;
    }
    document.path_ = path;
    document.setText(document.text_);  // its source is called like the file from now on
    return document;
}

Document Document::recovered(const fs::path& path, std::string text) {
    auto opened = path.empty() ? Result<Document>(Document()) : open(path);
    Document document = opened.ok() ? std::move(*opened) : Document();
    document.path_ = path;
    if (!opened.ok()) document.saved_.reset();
    (void)document.apply(difference(document.text_, text), "Recover unsaved work");
    return document;
}

std::optional<Document::Stamp> Document::stampOf(const fs::path& path) {
    std::error_code failed;
    const auto time = fs::last_write_time(path, failed);
    if (failed) return std::nullopt;
    const uintmax_t size = fs::file_size(path, failed);
    return failed ? std::nullopt : std::optional(Stamp{time, size});
}

void Document::setText(std::string text) {
    text_ = std::move(text);
    ++revision_;
    const std::string name = path_.empty() ? "untitled.sgm" : path_.string();
    auto problems = std::make_shared<syntax::Diagnostics>();
    const Stopwatch watch;
    ast_ = std::make_shared<const syntax::Ast>(
        syntax::parse(std::make_shared<const syntax::Source>(name, text_), operations::table(), *problems));
    problems_ = std::move(problems);
    parseSeconds_ = watch.seconds();
}

/// Takes the selected node along.
static void follow(Choice& choice, std::string_view text, const TextEdit& edit) {
    if (!choice.node && edit.node) choice.node = SelectedNode{};
    if (!choice.node) return;
    const auto now = followed(choice.node->range, text, edit);
    now ? void(choice.node->range = *now) : choice.node.reset();
}

void History::push(Entry entry) {
    entries_.resize(at_);
    entries_.push_back(std::move(entry));
    at_ = entries_.size();
}

Status Document::apply(const TextEdit& edit, std::string label) {
    if (edit.begin > edit.end || edit.end > text_.size())
        return Error{Error::Kind::Input, fmt::format("'{}' was made for another text", label)};
    if (edit.empty() || std::string_view(text_).substr(edit.begin, edit.end - edit.begin) == edit.replacement)
        return Done{};
    Choice before = choice_;
    follow(choice_, text_, edit);
    if (drag_) {
        if (drag_->label.empty()) drag_->label = std::move(label);
    } else {
        history_.push({edit, inverse(text_, edit), std::move(before), choice_, std::move(label)});
    }
    setText(applied(text_, edit));
    return Done{};
}

/// A keystroke joins the one before it when it goes on where that one ended, on the same line.
static bool joins(History& history, const TextEdit& edit) {
    if (!history.canUndo() || history.canRedo() || !history.last().typed) return false;
    const TextEdit& last = history.last().forward;
    const bool typesOn = edit.begin == edit.end && edit.begin == last.begin + last.replacement.size() &&
                         !last.replacement.empty() && edit.replacement.find('\n') == std::string::npos;
    const bool erasesOn = edit.replacement.empty() && last.replacement.empty() && edit.end == last.begin;
    return typesOn || erasesOn;
}

void Document::type(std::string text) {
    const TextEdit edit = difference(text_, text);
    if (edit.empty()) return;
    if (!drag_ && joins(history_, edit)) {
        History::Entry& last = history_.last();
        follow(choice_, text_, edit);
        const std::string before = applied(text_, last.backward);
        last.forward = difference(before, text);
        last.backward = inverse(before, last.forward);
        last.after = choice_;
        setText(std::move(text));
        return;
    }
    (void)apply(edit, "Type");
    if (!drag_) history_.last().typed = true;
}

void Document::choose(Choice choice, std::string label) {
    Choice same = choice;
    same.selection = choice_.selection;
    same.node = choice_.node;
    if (same != choice_) {
        ++revision_;
        if (!drag_)
            history_.push({{}, {}, choice_, choice, std::move(label)});
        else if (drag_->label.empty())
            drag_->label = std::move(label);
    }
    choice_ = std::move(choice);
}

void Document::beginDrag() {
    if (!drag_) drag_ = Drag{text_, {}, choice_};
}

void Document::endDrag() {
    if (!drag_) return;
    const Drag drag = *std::exchange(drag_, std::nullopt);
    const TextEdit edit = difference(drag.text, text_);
    Choice same = drag.choice;
    same.selection = choice_.selection;
    same.node = choice_.node;
    if (!edit.empty() || same != choice_)
        history_.push({edit, inverse(drag.text, edit), drag.choice, choice_, drag.label});
}

void Document::undo() {
    endDrag();
    if (!history_.canUndo()) return;
    const History::Entry& entry = history_.back();
    choice_ = entry.before;
    setText(applied(text_, entry.backward));
}

void Document::redo() {
    endDrag();
    if (!history_.canRedo()) return;
    const History::Entry& entry = history_.forward();
    choice_ = entry.after;
    setText(applied(text_, entry.forward));
}

Status Document::write(const fs::path& path) {
    if (const Status written = writeFile(path, text_); !written.ok()) return written;
    saved_ = text_;
    stamp_ = stampOf(path);
    return Done{};
}

Status Document::save(bool overwrite) {
    if (path_.empty()) return Error{Error::Kind::Input, "the grammar has no file yet: save it under a name"};
    if (!overwrite && saved_ && stampOf(path_) != stamp_) {
        const auto now = pipeline::readSource(path_);
        if (now.ok() && (*now)->text() != *saved_)
            return Error{Error::Kind::Input,
                         fmt::format("'{}' was changed by another program: nothing was saved", path_.string())};
    }
    return write(path_);
}

Status Document::saveAs(const fs::path& path) {
    if (const Status written = write(path); !written.ok()) return written;
    path_ = path;
    setText(text_);
    return Done{};
}

Document::Outside Document::poll() {
    if (path_.empty()) return Outside::Same;
    const auto stamp = stampOf(path_);
    // A new document has no stamp, and its file isn't missed.
    if (stamp == stamp_ && (stamp || saved_)) return Outside::Same;
    const auto now = pipeline::readSource(path_);
    if (!now.ok()) {
        if (!saved_) return Outside::Same;  // said once
        saved_.reset();
        stamp_.reset();
        return Outside::Gone;
    }
    if (saved_ == (*now)->text()) {
        stamp_ = stamp;
        return Outside::Same;
    }
    if (dirty() && (*now)->text() != text_) return Outside::Conflict;
    (void)takeOutside();
    return Outside::Reloaded;
}

Status Document::takeOutside() {
    const auto stamp = stampOf(path_);
    const auto now = pipeline::readSource(path_);
    if (!now.ok()) return now.error();
    endDrag();
    saved_ = (*now)->text();
    stamp_ = stamp;
    return apply(difference(text_, *saved_), "Changed by another program");
}

Status Document::keepMine() {
    const auto stamp = stampOf(path_);
    const auto now = pipeline::readSource(path_);
    if (!now.ok()) return now.error();
    saved_ = (*now)->text();
    stamp_ = stamp;
    return Done{};
}

}  // namespace sgm::document
