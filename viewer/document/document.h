// The document: a grammar's text, its history and its file.
// Enters: edits of the text. Leaves: the text with its syntax tree, always of one another. Assumes one thread (the
// window's). A GUI edit is a minimal text edit, so comments and layout survive; what was undone comes back byte for
// byte.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grammar/syntax/ast.h"
#include "modeler/core/result.h"
#include "viewer/document/rule_rows.h"
#include "viewer/document/text_edit.h"

namespace sgm::document {

/// What is chosen besides the text: it decides which model of the grammar is shown, and is undone with the text.
struct Choice {
    std::string start;  ///< symbol; "" for the first `start`
    std::string style;  ///< "" for none
    std::string way;    ///< of a `derive` line; "" derives automatically
    uint64_t seed = 1;
    std::set<std::string> locked;           ///< parameters that a re-roll leaves alone
    std::string selection;                  ///< path of the selected shape in the tree, "Cave/Cell[3]"; "" for none
    std::optional<SelectedNode> node = {};  ///< what is selected in the text: edits take it along
    friend bool operator==(const Choice&, const Choice&) = default;
};

/// What was done to a document, in order.
class History {
public:
    /// One entry of the history; either edit may be empty, where only the choice changed.
    struct Entry {
        TextEdit forward, backward;
        Choice before, after;
        std::string label;
        bool typed = false;
    };

    bool canUndo() const { return at_ > 0; }
    bool canRedo() const { return at_ < entries_.size(); }
    /// What undo would take back, "" where there is nothing.
    std::string_view undoLabel() const {
        return canUndo() ? std::string_view(entries_[at_ - 1].label) : std::string_view();
    }
    std::string_view redoLabel() const {
        return canRedo() ? std::string_view(entries_[at_].label) : std::string_view();
    }
    /// The entry that undo would take back.
    Entry& last() { return entries_[at_ - 1]; }
    /// Adds an entry; those that were undone are gone.
    void push(Entry entry);
    /// Goes one entry back or forward: that entry.
    const Entry& back() { return entries_[--at_]; }
    const Entry& forward() { return entries_[at_++]; }

private:
    std::vector<Entry> entries_;
    size_t at_ = 0;  ///< entries before it are done, the others undone
};

/// What a new document says: a box, with the standard library's solids for walls at hand.
inline constexpr const char* newGrammar =
    "grammar 2\n"
    "use \"std/walls.sgm\"\n"
    "\n"
    "start House -> stone size (6m, 3m, 4m)\n";

class Document {
public:
    /// A new one without a file. Counts as saved until it is edited.
    explicit Document(std::string text = newGrammar);
    /// Error::Input when the file can't be read. With `mayBegin` a file that isn't there begins a new grammar of that
    /// name, which counts as saved until it is edited, and which saving writes; Error::Input then where the name
    /// doesn't end with ".sgm" or its folder isn't there.
    static Result<Document> open(const std::filesystem::path& path, bool mayBegin = false);
    /// A document whose unsaved text was recovered: `text` is one edit of what the file holds now, or all of a new
    /// document.
    static Document recovered(const std::filesystem::path& path, std::string text);

    const std::string& text() const { return text_; }
    /// Empty while it has no file.
    const std::filesystem::path& path() const { return path_; }
    /// The text as parsed; always of the present text. Never null.
    const std::shared_ptr<const syntax::Ast>& ast() const { return ast_; }
    /// What the parser says of the present text.
    const syntax::Diagnostics& syntaxProblems() const { return *problems_; }
    /// How long the parser took for it.
    double parseSeconds() const { return parseSeconds_; }
    const Choice& choice() const { return choice_; }
    /// Changes whenever text or choice does; the selection doesn't count.
    uint64_t revision() const { return revision_; }
    /// The text isn't what the file holds, as far as is known.
    bool dirty() const { return !saved_ || *saved_ != text_; }

    /// Edits the text; one undo entry called `label` ("Delete rule"). Nothing happens for an edit that changes nothing.
    /// Error::Input for an edit beyond the text.
    Status apply(const TextEdit& edit, std::string label);
    /// The Text panel's way: the whole text anew. Keystrokes that follow each other on a line are one undo entry.
    void type(std::string text);
    /// Chooses another start, style, way, seed or other locks; one undo entry, none where only the selection differs.
    void choose(Choice choice, std::string label);
    /// Selects a shape by its path; no undo entry.
    void select(std::string path) { choice_.selection = std::move(path); }
    /// Selects a node of the present text; no undo entry. Every edit takes it along, or forgets it with what it takes
    /// out.
    void selectNode(std::optional<SelectedNode> node) { choice_.node = node; }

    /// Between these two all edits are one undo entry: a slider that is dragged. Calls don't nest; a drag that changes
    /// nothing leaves no entry.
    void beginDrag();
    void endDrag();

    bool dragging() const { return drag_.has_value(); }

    /// What can be undone and done again.
    const History& history() const { return history_; }
    /// Takes the last entry back, or does it again, with the selection of that time. Ends a drag.
    void undo();
    void redo();

    /// Writes the file beside its place and renames it there. Error::Input where it can't be written, where there is no
    /// path yet, and, unless `overwrite`, where the file was changed by another program since it was read.
    Status save(bool overwrite = false);
    /// The same under another name, which is the document's from then on. Overwrites: the file dialog asks.
    Status saveAs(const std::filesystem::path& path);

    enum class Outside {
        Same,      ///< the file is as it was read or saved
        Reloaded,  ///< it had changed, and is taken over: one undo entry; the choice and selection stay
        Conflict,  ///< it has changed, and so has the document: `takeOutside` or `keepMine` decides
        Gone,      ///< it can't be read any more; the document counts as unsaved
    };
    /// Looks whether another program has changed the file: cheap while its time and size stay the same.
    Outside poll();
    /// Takes what the file holds now over the unsaved text: one undo entry, so nothing is lost.
    Status takeOutside();
    /// Goes on with the unsaved text; `save` overwrites what the file holds now.
    Status keepMine();

private:
    struct Stamp {
        std::filesystem::file_time_type time;
        uintmax_t size = 0;
        friend bool operator==(const Stamp&, const Stamp&) = default;
    };
    static std::optional<Stamp> stampOf(const std::filesystem::path& path);
    void setText(std::string text);
    Status write(const std::filesystem::path& path);

    std::filesystem::path path_;
    std::string text_;
    std::optional<std::string> saved_;  ///< what the file holds, as far as is known
    std::optional<Stamp> stamp_;
    std::shared_ptr<const syntax::Ast> ast_;
    std::shared_ptr<const syntax::Diagnostics> problems_;
    Choice choice_;
    History history_;
    uint64_t revision_ = 0;
    double parseSeconds_ = 0;

    struct Drag {
        std::string text, label;
        Choice choice;
    };
    std::optional<Drag> drag_;
};

}  // namespace sgm::document
