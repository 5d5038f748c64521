// The document: history, drags, typing, its file and other programs.
#include "viewer/document/document.h"

#include <filesystem>
#include <fstream>

#include "tests/document/shown.h"
#include "tests/scratch.h"

namespace sgm::document {
namespace {

TextEdit edit(const Document& document, std::string_view from, std::string_view to) {
    return difference(document.text(), replaced(document.text(), from, to));
}

TEST(Documents, UndoAndRedoWithChoiceAndSelection) {
    Document document(tower);
    document.select("Tower/Storey");
    ASSERT_TRUE(document.apply(edit(document, "floors = 3", "floors = 5"), "Set floors").ok());
    const std::string edited = document.text();
    document.select("Tower/Storey[2]");
    Choice choice = document.choice();
    choice.seed = 7;
    choice.locked = {"floors"};
    document.choose(choice, "New seed");
    EXPECT_EQ(document.history().undoLabel(), "New seed");
    document.undo();
    EXPECT_EQ(document.choice().seed, 1u);
    EXPECT_TRUE(document.choice().locked.empty());
    EXPECT_EQ(document.choice().selection, "Tower/Storey[2]");
    EXPECT_EQ(document.history().undoLabel(), "Set floors");
    EXPECT_EQ(document.history().redoLabel(), "New seed");
    document.undo();
    EXPECT_EQ(document.text(), tower);
    EXPECT_EQ(document.choice().selection, "Tower/Storey");
    EXPECT_FALSE(document.history().canUndo());
    EXPECT_FALSE(document.dirty());
    document.undo();
    document.redo();
    document.redo();
    EXPECT_EQ(document.text(), edited);
    EXPECT_EQ(document.choice().seed, 7u);
    // A new edit after an undo forgets what was undone.
    document.undo();
    ASSERT_TRUE(document.apply(edit(document, "// the end", "// end"), "Cut").ok());
    EXPECT_FALSE(document.history().canRedo());
}

TEST(Documents, ANewOneShowsABox) {
    const Document document;
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(document.ast()->version, 2);
    const auto model = shown(document);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->model.derivation.tree.shapes[1].scope.size, (Vec3d{6, 3, 4}));
}

TEST(Documents, TheTreeIsAlwaysOfTheText) {
    Document document(tower);
    const uint64_t before = document.revision();
    ASSERT_TRUE(document.apply(edit(document, "rule Up: Storey", "rule Up: Storey when"), "Break").ok());
    EXPECT_GT(document.revision(), before);
    EXPECT_TRUE(document.syntaxProblems().hasErrors());
    EXPECT_EQ(document.ast()->source->text(), document.text());
    document.undo();
    EXPECT_FALSE(document.syntaxProblems().hasErrors());
    EXPECT_EQ(document.ast()->rules.size(), 3u);
    EXPECT_FALSE(document.apply({5, 100'000, "x"}, "Beyond").ok());
    EXPECT_FALSE(document.apply({6, 5, "x"}, "Backward").ok());
    EXPECT_EQ(document.text(), tower);
}

TEST(Documents, ADragIsOneEntry) {
    Document document(tower);
    document.beginDrag();
    std::string last = "3";
    for (const char* value : {"4", "6", "9", "7"}) {
        ASSERT_TRUE(document
                        .apply(edit(document, "floors = " + last + " in", std::string("floors = ") + value + " in"),
                               "Set floors")
                        .ok());
        last = value;
    }
    document.endDrag();
    EXPECT_EQ(document.text(), replaced(tower, "floors = 3", "floors = 7"));
    EXPECT_EQ(document.history().undoLabel(), "Set floors");
    document.undo();
    EXPECT_EQ(document.text(), tower);
    EXPECT_FALSE(document.history().canUndo());
    document.redo();
    EXPECT_EQ(document.text(), replaced(tower, "floors = 3", "floors = 7"));
    // There and back leaves no trace, and undo in the middle takes the drag back.
    document.beginDrag();
    ASSERT_TRUE(document.apply(edit(document, "lean   = .1", "lean   = .2"), "Set lean").ok());
    ASSERT_TRUE(document.apply(edit(document, "lean   = .2", "lean   = .1"), "Set lean").ok());
    document.endDrag();
    EXPECT_EQ(document.history().undoLabel(), "Set floors");
    document.beginDrag();
    ASSERT_TRUE(document.apply(edit(document, "lean   = .1", "lean   = .2"), "Set lean").ok());
    document.undo();
    EXPECT_EQ(document.text(), replaced(tower, "floors = 3", "floors = 7"));
}

TEST(Documents, TypingOnALineIsOneEntry) {
    Document document("grammar 1\n");
    std::string text = document.text();
    for (const char c : std::string("start A -> cube")) document.type(text += c);
    document.type(text += "\n");
    for (const char c : std::string("// x")) document.type(text += c);
    document.undo();
    EXPECT_EQ(document.text(), "grammar 1\nstart A -> cube") << "a line end begins an entry";
    document.undo();
    EXPECT_EQ(document.text(), "grammar 1\n");
    document.redo();
    EXPECT_EQ(document.text(), "grammar 1\nstart A -> cube");
    // Backspaces join too, and a stroke elsewhere doesn't.
    text = document.text();
    for (int i = 0; i < 4; ++i) text.pop_back(), document.type(text);
    document.type("// " + text);
    document.undo();
    EXPECT_EQ(document.text(), "grammar 1\nstart A -> ");
    document.undo();
    EXPECT_EQ(document.text(), "grammar 1\nstart A -> cube");
}

TEST(Documents, SaveAndOpen) {
    const Scratch scratch;
    const auto path = scratch.write("a.sgm", tower);
    auto document = Document::open(path);
    ASSERT_TRUE(document.ok());
    EXPECT_FALSE(document->dirty());
    ASSERT_TRUE(document->apply(edit(*document, "floors = 3", "floors = 4"), "Set").ok());
    EXPECT_TRUE(document->dirty());
    EXPECT_EQ(scratch.read("a.sgm"), tower);
    ASSERT_TRUE(document->save().ok());
    EXPECT_FALSE(document->dirty());
    EXPECT_EQ(scratch.read("a.sgm"), document->text());
    document->undo();
    EXPECT_TRUE(document->dirty());
    ASSERT_TRUE(document->saveAs(scratch / "b.sgm").ok());
    EXPECT_EQ(scratch.read("b.sgm"), tower);
    EXPECT_EQ(document->ast()->source->name(), (scratch / "b.sgm").string());
    EXPECT_FALSE(document->saveAs(scratch / "none" / "c.sgm").ok());
    EXPECT_EQ(document->path(), scratch / "b.sgm");
    EXPECT_FALSE(Document::open(scratch / "none.sgm").ok());
    EXPECT_FALSE(Document().save().ok());
}

TEST(Documents, BeginAFileThatNobodyHasWritten) {
    const Scratch scratch;
    const auto path = scratch / "new.sgm";
    Document document = *Document::open(path, true);
    EXPECT_EQ(document.path(), path);
    EXPECT_EQ(document.text(), newGrammar);
    EXPECT_EQ(document.ast()->source->name(), path.string());
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(document.poll(), Document::Outside::Same) << "its file isn't missed";
    EXPECT_FALSE(std::filesystem::exists(path));
    document.type(document.text() + "\n");
    EXPECT_TRUE(document.dirty());
    ASSERT_TRUE(document.save().ok());
    EXPECT_EQ(scratch.read("new.sgm"), document.text());
    std::filesystem::remove(path);
    EXPECT_EQ(document.poll(), Document::Outside::Gone);

    Document other = *Document::open(scratch / "other.sgm", true);
    scratch.write("other.sgm", tower);
    EXPECT_EQ(other.poll(), Document::Outside::Reloaded) << "another program wrote it";
    EXPECT_EQ(other.text(), tower);
    Document edited = *Document::open(scratch / "edited.sgm", true);
    edited.type("grammar 2\n");
    scratch.write("edited.sgm", tower);
    EXPECT_FALSE(edited.save().ok());
    EXPECT_EQ(edited.poll(), Document::Outside::Conflict);
    EXPECT_EQ(scratch.read("edited.sgm"), tower);

    EXPECT_EQ(Document::open(scratch / "edited.sgm", true)->text(), tower) << "what is there is read";
    EXPECT_FALSE(Document::open(scratch / "picture.png", true).ok());
    EXPECT_FALSE(Document::open(scratch / "none" / "a.sgm", true).ok());
    EXPECT_FALSE(Document::open(scratch / "c.sgm").ok());
}

TEST(Documents, TakeOverWhatAnotherProgramWrote) {
    const Scratch scratch;
    const auto path = scratch.write("a.sgm", tower);
    Document document = *Document::open(path);
    EXPECT_EQ(document.poll(), Document::Outside::Same);
    document.select("Tower/Storey");
    scratch.write("a.sgm", replaced(tower, "floors = 3", "floors = 6"));
    EXPECT_EQ(document.poll(), Document::Outside::Reloaded);
    EXPECT_EQ(document.text(), scratch.read("a.sgm"));
    EXPECT_EQ(document.choice().selection, "Tower/Storey");
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(document.poll(), Document::Outside::Same);
    document.undo();
    EXPECT_EQ(document.text(), tower);
    EXPECT_TRUE(document.dirty());
    document.redo();
    // Touched, but the same.
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now());
    EXPECT_EQ(document.poll(), Document::Outside::Same);
}

TEST(Documents, AskWhenBothHaveChanged) {
    const Scratch scratch;
    const auto path = scratch.write("a.sgm", tower);
    const std::string theirs = replaced(tower, "floors = 3", "floors = 6666"),
                      mine = replaced(tower, "// the end", "// mine");
    for (const bool take : {true, false}) {
        scratch.write("a.sgm", tower);
        Document document = *Document::open(path);
        document.type(mine);
        scratch.write("a.sgm", theirs);
        EXPECT_EQ(document.poll(), Document::Outside::Conflict);
        EXPECT_EQ(document.text(), mine);
        EXPECT_FALSE(document.save().ok());
        EXPECT_EQ(scratch.read("a.sgm"), theirs);
        if (take) {
            ASSERT_TRUE(document.takeOutside().ok());
            EXPECT_EQ(document.text(), theirs);
            EXPECT_FALSE(document.dirty());
            document.undo();
            EXPECT_EQ(document.text(), mine);
        } else {
            ASSERT_TRUE(document.keepMine().ok());
            EXPECT_EQ(document.poll(), Document::Outside::Same);
            EXPECT_TRUE(document.dirty());
            ASSERT_TRUE(document.save().ok());
            EXPECT_EQ(scratch.read("a.sgm"), mine);
        }
    }
    Document document = *Document::open(path);
    std::filesystem::remove(path);
    EXPECT_EQ(document.poll(), Document::Outside::Gone);
    EXPECT_EQ(document.poll(), Document::Outside::Same);
    EXPECT_TRUE(document.dirty());
    EXPECT_TRUE(document.save().ok());
}

}  // namespace
}  // namespace sgm::document
