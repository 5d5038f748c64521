// One selection for text and shapes: it survives edits, and goes where its text made nothing.
#include "viewer/document/selection.h"

#include "tests/document/shown.h"

namespace sgm::document {
namespace {

constexpr const char* pair =
    "grammar 2\n"
    "start A -> cube size 2 : Body\n"
    "rule Grow: Body -> + sphere size 1 at +x : Arm\n"
    "rule Arm weight 1 -> + cone size .5 at +y + torus size 1 at -y\n"
    "rule Arm weight 0 -> + cylinder size .5 at +z\n";

class Selections : public testing::Test {
protected:
    const derive::ShapeTree& tree() const { return model->model.derivation.tree; }
    std::string shape() const { return selection.shape() == derive::none ? "" : tree().path(selection.shape(), true); }
    /// What is selected in the text.
    std::string node() const {
        const auto& chosen = document.choice().node;
        const auto rows = ruleRows(*document.ast());
        const size_t row = chosen ? rowOf(rows, *chosen) : rows.size();
        return row == rows.size() ? "" : rows[row].text;
    }
    void click(std::string_view text) {
        const auto rows = ruleRows(*document.ast());
        for (const RuleRow& row : rows)
            if (row.text == text) return selection.selectRow(document, model.get(), row);
        FAIL() << "no row " << text;
    }
    void change(std::string_view from, std::string_view to) {
        const TextEdit edit = difference(document.text(), replaced(document.text(), from, to));
        ASSERT_TRUE(document.apply(edit, "Change").ok());
        remake();
    }
    void remake() {
        model = shown(document);
        selection.resolve(document, model.get());
    }

    Document document{pair};
    std::shared_ptr<const BuiltModel> model = shown(document);
    Selection selection;
};

TEST_F(Selections, TextAndShapeAreOne) {
    selection.selectShape(document, *model, tree().find("A/cone"));
    EXPECT_EQ(node(), "+ cone");
    click("at -y");
    EXPECT_EQ(shape(), "A/Body/Arm/torus") << "an attribute means its element";
    click("+ cylinder");
    EXPECT_EQ(shape(), "") << "it made nothing";
    EXPECT_EQ(node(), "+ cylinder");
    EXPECT_NE(selection.takeNotice().find("made no shape"), std::string::npos);
    EXPECT_EQ(selection.takeNotice(), "") << "said once";
    click("Arm");
    EXPECT_EQ(shape(), "A/Body/Arm/cone");
    click("Arm");
    EXPECT_EQ(shape(), "A/Body/Arm/torus") << "again: the next of several";
    selection.selectShape(document, *model, derive::none);
    EXPECT_EQ(node(), "");
}

TEST_F(Selections, SurviveEdits) {
    click("+ cone");
    change("cone", "sphere");
    EXPECT_EQ(shape(), "A/Body/Arm/sphere") << "by another name";
    EXPECT_EQ(node(), "+ sphere");
    change("grammar 2\n", "grammar 2\n// a comment above\n");
    EXPECT_EQ(node(), "+ sphere");
    change("+ sphere size .5 at +y", "- sphere size .5 at +y color #aa4422");
    EXPECT_EQ(node(), "- sphere");
    EXPECT_EQ(shape(), "A/Body/Arm/sphere");
    document.undo();
    remake();
    EXPECT_EQ(node(), "+ sphere");
    EXPECT_EQ(shape(), "A/Body/Arm/sphere");
    change(" + sphere size .5 at +y", "");
    EXPECT_EQ(node(), "") << "it is gone";
    EXPECT_EQ(shape(), "");
    document.undo();
    remake();
    EXPECT_EQ(node(), "+ sphere") << "and back";
    EXPECT_EQ(shape(), "A/Body/Arm/sphere");
}

TEST_F(Selections, WaitForTheModelOfTheText) {
    const TextEdit edit = difference(pair, replaced(replaced(pair, "weight 1", "weight 2"), "weight 0", "weight 1000"));
    ASSERT_TRUE(document.apply(edit, "Change").ok());
    click("+ cylinder");
    EXPECT_EQ(shape(), "") << "the model is of the text before";
    EXPECT_EQ(selection.takeNotice(), "");
    remake();
    EXPECT_EQ(shape(), "A/Body/Arm/cylinder");
    document.undo();
    click("+ cylinder");
    remake();
    EXPECT_EQ(shape(), "");
    EXPECT_NE(selection.takeNotice(), "") << "it says that there is none";
}

TEST(FollowedNodes, AreFoundBehindEditsThatBeginBeforeThem) {
    const std::string before = "head cube size (9, 3) tail";
    const TextRange cube{5, 21};
    const auto after = [&](const TextEdit& edit) -> std::string {
        const auto now = followed(cube, before, edit);
        return now ? applied(before, edit).substr(now->begin, 9) : "gone";
    };
    EXPECT_EQ(after({0, 0, "more "}), "cube size");
    EXPECT_EQ(after({16, 17, "wide"}), "cube size");
    EXPECT_EQ(after({4, 17, "er param\nhead cube size (wide"}), "cube size") << "a line above and a number in it";
    EXPECT_EQ(after({16, 26, "wide, 3) end"}), "cube size") << "a number in it, and what follows";
    EXPECT_EQ(after({0, 26, "tail cube size (9, 3) head"}), "cube size") << "moved with all around it";
    EXPECT_EQ(after({10, 26, "side (9, 3) end"}), "cube side") << "changed near its begin, and what follows";
    EXPECT_EQ(after({7, 26, "ne"}), "gone");
    EXPECT_EQ(after({5, 21, ""}), "gone");
    EXPECT_EQ(after({0, 26, "nothing"}), "gone");
}

TEST_F(Selections, GoWithWhatIsAddedOrMoved) {
    const syntax::Ast& ast = *document.ast();
    const auto added = edits::addRule(ast, "Arm", "+ torus at -z", &ast.rules[0]);
    ASSERT_TRUE(added.ok());
    ASSERT_TRUE(document.apply(*added, "Add").ok());
    auto rows = ruleRows(*document.ast());
    EXPECT_EQ(rowOf(rows, *document.choice().node),
              rowAt(rows, static_cast<uint32_t>(document.text().find("rule Arm -> + torus at -z"))));
    const auto moved = edits::moveRule(*document.ast(), document.ast()->rules[1], &document.ast()->rules[0]);
    ASSERT_TRUE(document.apply(*moved, "Move").ok());
    EXPECT_EQ(document.choice().node->range.begin, document.text().find("rule Arm -> + torus at -z"));
    // Another rule that is moved past the selected one leaves it selected.
    rows = ruleRows(*document.ast());
    selection.selectRow(document, nullptr, rows[rowAt(rows, static_cast<uint32_t>(document.text().find("+ cone")))]);
    TextEdit past = *edits::moveRule(*document.ast(), document.ast()->rules[3], &document.ast()->rules[0]);
    past.node.reset();
    ASSERT_TRUE(document.apply(past, "Move").ok());
    EXPECT_EQ(node(), "+ cone");
}

}  // namespace
}  // namespace sgm::document
