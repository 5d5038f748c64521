// Every verb of the panels: what it does to the text, and that nothing else moves.
#include "viewer/document/edits.h"
#include "grammar/operations/operations.h"

#include "tests/document/texts.h"

namespace sgm::document {
namespace {

using edits::Edit;
using syntax::Element;
using syntax::Operator;

class Edits : public testing::Test {
protected:
    const syntax::RuleDecl& rule(size_t i) const { return ast.rules[i]; }
    /// An element of the second rule, the first Wing: cube, sphere, cylinder, torus.
    const Element& wing(size_t i) const { return ast.rules[1].body.siblings[0][i]; }

    /// The edit does to the text what replacing `from` by `to` does.
    void expectReplaced(const Edit& edit, std::string_view from, std::string_view to) {
        ASSERT_TRUE(edit.ok()) << edit.error().message;
        EXPECT_EQ(applied(tower, *edit), replaced(tower, from, to));
    }
    static void expectRefused(const Edit& edit, const std::string& why) {
        ASSERT_FALSE(edit.ok());
        EXPECT_NE(edit.error().message.find(why), std::string::npos) << edit.error().message;
    }

    syntax::Ast ast = parsed(tower);
};

TEST_F(Edits, AddARule) {
    expectReplaced(edits::addRule(ast, "Storey", "cone"), "// roof\n", "// roof\nrule Storey -> cone\n");
    expectReplaced(edits::addRule(ast, "Door", "cone"), "     sphere\n", "     sphere\nrule Door -> cone\n");
    expectReplaced(edits::addRule(ast, "Door", "cone", &rule(0)), "// roof\n", "// roof\nrule Door -> cone\n");
    expectRefused(edits::addRule(ast, "Door", "cone size"), "'size' needs");
    expectRefused(edits::addRule(ast, "two words", "cone"), "two words");
    const syntax::Ast bare = parsed("grammar 1\nstart A -> cube");
    EXPECT_EQ(applied("grammar 1\nstart A -> cube", *edits::addRule(bare, "A", "cone")),
              "grammar 1\nstart A -> cube\nrule A -> cone\n");
}

TEST_F(Edits, AddARuleOrStartAsItIsWritten) {
    expectReplaced(edits::addDeclaration(ast, "Door -> cone", &rule(0)), "// roof\n", "// roof\nrule Door -> cone\n");
    expectReplaced(edits::addDeclaration(ast, " rule D: Door when lean > 0 -> cone", &rule(0)), "// roof\n",
                   "// roof\nrule D: Door when lean > 0 -> cone\n");
    expectReplaced(edits::addDeclaration(ast, "start House -> cube"), "// ground\n",
                   "// ground\nstart House -> cube\n");
    expectRefused(edits::addDeclaration(ast, "Up: Door -> cone"), "another rule is called 'Up'");
    expectRefused(edits::addDeclaration(ast, "Door -> cone size"), "'size' needs");
    expectRefused(edits::addDeclaration(ast, "start -> cone"), "expected");
    // What a text begins with is its start.
    EXPECT_EQ(applied("grammar 2\n", *edits::addDeclaration(parsed("grammar 2\n"), "Name -> sphere")),
              "grammar 2\nstart Name -> sphere\n");
    const std::string ruled = "grammar 2\n\n// walls\nrule A -> cube\n";
    EXPECT_EQ(applied(ruled, *edits::addDeclaration(parsed(ruled), "rule B -> A")),
              "grammar 2\n\nstart B -> A\n// walls\nrule A -> cube\n");
}

TEST_F(Edits, RemoveARule) {
    expectReplaced(edits::removeRule(ast, rule(2)),
                   "rule Wing weight 1 -> cube when bulge == round { + cone at +y },\n     sphere\n", "");
    // Between two empty lines one goes too; the comment above stays.
    expectReplaced(edits::removeRule(ast, rule(0)),
                   "rule Up: Storey repeat floors - 1\n  -> + cube size (4 ~> 2, 1, 4) at +y : Storey\n  finally + "
                   "cone on last at +y : Wing   // roof\n",
                   "");
    const std::string last = "grammar 1\nstart A -> cube\nrule A -> cone";
    EXPECT_EQ(applied(last, *edits::removeRule(parsed(last), parsed(last).rules[0])), "grammar 1\nstart A -> cube");
}

TEST_F(Edits, DuplicateARule) {
    expectReplaced(edits::duplicateRule(ast, rule(0)), "// roof\n",
                   "// roof\nrule Upb: Storey repeat floors - 1\n  -> + cube size (4 ~> 2, 1, 4) at +y : Storey\n  "
                   "finally + cone on last at +y : Wing   // roof\n");
    expectReplaced(edits::duplicateRule(ast, rule(2)), "     sphere\n",
                   "     sphere\nrule Wing weight 1 -> cube when bulge == round { + cone at +y },\n     sphere\n");
}

TEST_F(Edits, ReorderRules) {
    const Edit up = edits::moveRule(ast, rule(2), &rule(1));
    ASSERT_TRUE(up.ok());
    const syntax::Ast moved = parsed(applied(tower, *up));
    ASSERT_EQ(moved.rules.size(), 3u);
    EXPECT_EQ(moved.rules[1].span.text(), rule(2).span.text());
    EXPECT_EQ(moved.rules[2].span.text(), rule(1).span.text());
    // The comment above goes along; to its own place nothing happens.
    const Edit down = edits::moveRule(ast, rule(0), nullptr);
    ASSERT_TRUE(down.ok());
    const std::string text = applied(tower, *down);
    EXPECT_NE(text.find("     sphere\n// grows upward\nrule Up: Storey"), std::string::npos) << text;
    EXPECT_TRUE(edits::moveRule(ast, rule(0), &rule(1))->empty());
    EXPECT_TRUE(edits::moveRule(ast, rule(2), nullptr)->empty());
}

TEST(Ways, GoOnMeaningTheSameRules) {
    const std::string text =
        "grammar 1\nstart A -> cube : Cell\nrule Cell -> cone\nrule Up: Cell -> sphere\nrule Cell -> cube\nderive w: "
        "Cell#1 => Up => Cell#2\n";
    const syntax::Ast ast = parsed(text);
    const auto wayAfter = [&](const Edit& edit) {
        EXPECT_TRUE(edit.ok()) << edit.error().message;
        const std::string now = applied(text, *edit);
        return now.substr(now.find("derive w: ") + 10);
    };
    EXPECT_EQ(wayAfter(edits::addRule(ast, "Cell", "torus", &ast.rules[0])), "Cell#1 => Up => Cell#3\n");
    EXPECT_EQ(wayAfter(edits::addRule(ast, "Other", "torus", &ast.rules[0])), "Cell#1 => Up => Cell#2\n");
    EXPECT_EQ(wayAfter(edits::duplicateRule(ast, ast.rules[0])), "Cell#1 => Up => Cell#3\n");
    EXPECT_EQ(wayAfter(edits::moveRule(ast, ast.rules[2], &ast.rules[0])), "Cell#2 => Up => Cell#1\n");
    EXPECT_EQ(wayAfter(edits::moveRule(ast, ast.rules[0], nullptr)), "Cell#2 => Up => Cell#1\n");
    EXPECT_EQ(wayAfter(edits::setName(ast, ast.rules[0], "First")), "First => Up => Cell#1\n");
    EXPECT_EQ(wayAfter(edits::setName(ast, ast.rules[1], "")), "Cell#1 => Cell#2 => Cell#3\n");
    EXPECT_EQ(wayAfter(edits::setSymbol(ast, ast.rules[0], "Other")), "Other#1 => Up => Cell#1\n");
    // A rule that is gone leaves a number that no rule has.
    EXPECT_EQ(wayAfter(edits::removeRule(ast, ast.rules[0])), "Cell#2 => Up => Cell#1\n");
}

TEST_F(Edits, NamesAndSymbols) {
    const Edit renamed = edits::setName(ast, rule(0), "Rise");
    ASSERT_TRUE(renamed.ok());
    EXPECT_EQ(applied(tower, *renamed), replaced(replaced(tower, "rule Up: Storey", "rule Rise: Storey"),
                                                 "derive once: Up", "derive once: Rise"));
    const Edit nameless = edits::setName(ast, rule(0), "");
    ASSERT_TRUE(nameless.ok());
    EXPECT_EQ(applied(tower, *nameless),
              replaced(replaced(tower, "rule Up: Storey", "rule Storey"), "derive once: Up", "derive once: Storey#1"));
    expectReplaced(edits::setName(ast, rule(1), "W"), "rule Wing when", "rule W: Wing when");
    expectRefused(edits::setName(ast, rule(1), "Up"), "another rule is called 'Up'");
    expectRefused(edits::setName(ast, rule(1), "rule"), "word of the language");
    expectReplaced(edits::setSymbol(ast, rule(0), "Wing"), "rule Up: Storey", "rule Up: Wing");
}

TEST_F(Edits, GuardWeightRepeatBeside) {
    expectReplaced(edits::setGuard(ast, rule(1), "floors > 5 and bulge == flat"), "when floors > 2 ",
                   "when floors > 5 and bulge == flat ");
    expectReplaced(edits::setGuard(ast, rule(1), ""), " when floors > 2", "");
    expectReplaced(edits::setGuard(ast, rule(0), "floors > 2"), "floors - 1\n", "floors - 1 when floors > 2\n");
    expectReplaced(edits::setWeight(ast, rule(2), "7"), "weight 1", "weight 7");
    expectReplaced(edits::setWeight(ast, rule(1), ""), "   weight 2", "");
    expectReplaced(edits::setRepeat(ast, rule(0), "floors * 2"), "repeat floors - 1", "repeat floors * 2");
    expectReplaced(edits::setRepeat(ast, rule(2), "3"), "weight 1 ->", "weight 1 repeat 3 ->");
    expectReplaced(edits::setBeside(ast, rule(2), "Storey"), "weight 1 ->", "weight 1 beside Storey ->");
    expectRefused(edits::setGuard(ast, rule(1), "floors >"), "can't be read");
    expectRefused(edits::setGuard(ast, rule(1), "true -> cube\nrule X"), "line end");
    expectRefused(edits::setGuard(ast, rule(1), "true // so"), "no comment");
}

TEST_F(Edits, Operators) {
    expectReplaced(edits::setOperator(ast, wing(1), Operator::Difference), "+ sphere", "- sphere");
    expectReplaced(edits::setOperator(ast, wing(1), Operator::Intersection), "+ sphere", "& sphere");
    expectReplaced(edits::setOperator(ast, wing(2), Operator::Morph), "- cylinder", "morph cylinder");
    // `by` belongs to the morph.
    expectReplaced(edits::setOperator(ast, wing(3), Operator::Sum), "morph torus by .3", "+ torus");
    expectReplaced(edits::setOperator(ast, wing(0), Operator::Sum), "-> cube + sphere", "-> + cube + sphere");
    expectReplaced(edits::setOperator(ast, rule(0).body.siblings[0][0], Operator::None), "-> + cube size",
                   "-> cube size");
    expectRefused(edits::setOperator(ast, wing(1), Operator::None), "only the first");
    expectRefused(edits::setOperator(ast, rule(2).body.siblings[0][1], Operator::Sum), "has no operator");
    EXPECT_TRUE(edits::setOperator(ast, wing(1), Operator::Sum)->empty());
}

TEST_F(Edits, ElementsComeAndGo) {
    expectReplaced(edits::removeElement(ast, wing(1)), " + sphere at +x shift (0, lean, 0)", "");
    expectReplaced(edits::removeElement(ast, wing(2)), "- cylinder size 50% at +z to centre // hole", "// hole");
    expectReplaced(edits::removeElement(ast, wing(3)), "\n     morph torus by .3", "");
    expectReplaced(edits::removeElement(ast, wing(0)), "-> cube + sphere", "-> sphere");
    expectReplaced(edits::removeElement(ast, rule(2).body.siblings[1][0]), ",\n     sphere\n", "\n");
    expectReplaced(edits::removeElement(ast, ast.starts[0].body.siblings[0][0]), "cube  size (4, 1, 4) : Storey",
                   "nil");
    expectRefused(edits::removeElement(ast, rule(0).body.siblings[0][0]), "all that this body does");

    expectReplaced(edits::addElement(ast, wing(1), "+ torus"), "// ball", "+ torus // ball");
    expectReplaced(edits::addElement(ast, wing(2), "- torus"), "// hole\n", "// hole\n     - torus\n");
    expectRefused(edits::addElement(ast, wing(1), "torus"), "can't follow");
    expectRefused(edits::addElement(ast, wing(1), "+ torus sise 3"), "did you mean");

    expectReplaced(edits::duplicateElement(ast, wing(0)), "-> cube + sphere", "-> cube + cube + sphere");
    expectReplaced(edits::duplicateElement(ast, wing(3)), "morph torus by .3",
                   "morph torus by .3\n     morph torus by .3");
}

TEST_F(Edits, ElementsChangePlaces) {
    expectReplaced(edits::moveElement(ast, wing(0), 1), "cube + sphere at +x shift (0, lean, 0)",
                   "sphere at +x shift (0, lean, 0) + cube");
    expectReplaced(edits::moveElement(ast, wing(1), -1), "cube + sphere at +x shift (0, lean, 0)",
                   "sphere at +x shift (0, lean, 0) + cube");
    expectReplaced(edits::moveElement(ast, wing(2), 1),
                   "- cylinder size 50% at +z to centre // hole\n     morph torus by .3",
                   "morph torus by .3 // hole\n     - cylinder size 50% at +z to centre");
    expectRefused(edits::moveElement(ast, wing(3), 1), "no neighbour");
    expectRefused(edits::moveElement(ast, wing(0), -1), "no neighbour");
}

TEST_F(Edits, SolidsAndLiveNames) {
    expectReplaced(edits::setSolid(ast, wing(1), "morph(cube, sphere, lean)"), "+ sphere at",
                   "+ morph(cube, sphere, lean) at");
    expectRefused(edits::setSolid(ast, wing(1), "morph(cube"), "can't be read");
    expectReplaced(edits::setLive(ast, wing(1), "Ball"), "(0, lean, 0) //", "(0, lean, 0) : Ball //");
    expectReplaced(edits::setLive(ast, rule(0).body.siblings[0][0], ""), "at +y : Storey\n  finally",
                   "at +y\n  finally");
    expectReplaced(edits::setLive(ast, rule(0).body.siblings[0][0], "Wing"), "at +y : Storey\n  finally",
                   "at +y : Wing\n  finally");
    expectRefused(edits::setLive(ast, rule(2).body.siblings[0][1], "A"), "can't be live");
}

TEST_F(Edits, Attributes) {
    expectReplaced(edits::setAttribute(ast, wing(1), operations::shift, "(0, .2, 0)"), "(0, lean, 0)", "(0, .2, 0)");
    expectReplaced(edits::setAttribute(ast, wing(1), operations::shift, "lean + .1"), "shift (0, lean, 0)",
                   "shift (lean + .1)");
    expectReplaced(edits::setAttribute(ast, wing(1), operations::shift, "(lean + .1)"), "shift (0, lean, 0)",
                   "shift (lean + .1)");
    expectReplaced(edits::setAttribute(ast, wing(1), operations::size, "2 ~> 1.5"), "(0, lean, 0) //",
                   "(0, lean, 0) size 2 ~> 1.5 //");
    expectReplaced(edits::setAttribute(ast, rule(0).body.siblings[0][0], operations::color, "#ff8800"),
                   "at +y : Storey\n  finally", "at +y color #ff8800 : Storey\n  finally");
    expectReplaced(edits::setAttribute(ast, wing(3), operations::by, ".7"), "by .3", "by .7");
    expectReplaced(edits::removeAttribute(ast, wing(1), operations::shift), " shift (0, lean, 0)", "");
    expectRefused(edits::removeAttribute(ast, wing(1), operations::color), "no 'color'");
    expectRefused(edits::setAttribute(ast, wing(1), operations::size, ""), "");
    expectReplaced(edits::setExpression(ast, *rule(0).repeat, "floors"), "repeat floors - 1", "repeat floors");
    expectReplaced(edits::setBody(ast, rule(1).body, "cone"),
                   "-> cube + sphere at +x shift (0, lean, 0) // ball\n     - cylinder size 50% at +z to centre // "
                   "hole\n     morph torus by .3",
                   "-> cone");
}

TEST_F(Edits, AttachToAJoint) {
    expectReplaced(edits::attach(ast, wing(1), "-z"), "at +x shift", "at -z shift");
    expectReplaced(edits::attach(ast, wing(2), "+y"), "at +z to centre //", "at +y to centre //");
    const std::string text = "grammar 1\nstart A -> cube + cone at +x to -y\n";
    const syntax::Ast faces = parsed(text);
    expectReplaced(edits::attach(ast, wing(3), "+y"), "by .3", "by .3 at +y");
    EXPECT_EQ(applied(text, *edits::attach(faces, faces.starts[0].body.siblings[0][1], "+z")),
              "grammar 1\nstart A -> cube + cone at +z\n");
    expectRefused(edits::attach(ast, wing(0), "+x"), "joined to nothing");
}

TEST_F(Edits, Values) {
    expectReplaced(edits::setValues(ast, "Tower", "", {{"floors", "5"}}), "floors = 3", "floors = 5");
    expectReplaced(edits::setValues(ast, "Tower", "Tall", {{"floors", "5"}}), "floors = 9", "floors = 5");
    expectReplaced(edits::setValues(ast, "Tower", "Tall", {{"lean", ".5"}, {"bulge", "round"}}), "floors = 9 }",
                   "floors = 9 lean = .5 bulge = round }");
    const Edit two = edits::setValues(ast, "Tower", "", {{"bulge", "round"}, {"floors", "4"}});
    ASSERT_TRUE(two.ok());
    EXPECT_EQ(applied(tower, *two), replaced(replaced(tower, "floors = 3", "floors = 4"), "= flat of", "= round of"));
    expectRefused(edits::setValues(ast, "Tower", "", {{"flors", "5"}}), "no parameter 'flors'");
    expectRefused(edits::setValues(ast, "Tower", "Flat", {{"floors", "5"}}), "no style 'Flat'");
    expectRefused(edits::setValues(ast, "Tower", "", {{"floors", "5 in 1..6"}}), "");
}

TEST_F(Edits, ValuesOfUsedFilesAndDefaultStyles) {
    const auto set = [](const std::string& text, const std::string& value) {
        const auto edit = edits::setValues(parsed(text), "A", "", {{"n", value}});
        return edit.ok() ? applied(text, *edit) : edit.error().message;
    };
    EXPECT_EQ(set("grammar 1\nuse \"a.sgm\" // x\nstart A -> B\n", "2"),
              "grammar 1\nuse \"a.sgm\" { n = 2 } // x\nstart A -> B\n");
    EXPECT_EQ(set("grammar 1\nuse \"a.sgm\" { }\nstart A -> B\n", "2"),
              "grammar 1\nuse \"a.sgm\" { n = 2 }\nstart A -> B\n");
    EXPECT_EQ(set("grammar 1\nuse \"a.sgm\" { m = 1 }\nstart A -> B\n", "2"),
              "grammar 1\nuse \"a.sgm\" { m = 1 n = 2 }\nstart A -> B\n");
    EXPECT_EQ(set("grammar 1\nuse \"a.sgm\" { n = 1 }\nstart A -> B\n", "2"),
              "grammar 1\nuse \"a.sgm\" { n = 2 }\nstart A -> B\n");
    EXPECT_EQ(set("grammar 1\nuse \"a.sgm\" { n = 1 }\nstart A -> B\nstyle default for A { n = 3 }\n", "2"),
              "grammar 1\nuse \"a.sgm\" { n = 1 }\nstart A -> B\nstyle default for A { n = 2 }\n");
    EXPECT_EQ(
        set("grammar 1\nparam n = 1\nstart A -> B\nstyle default { n = 3 }\nstyle default for Z { n = 4 }\n", "2"),
        "grammar 1\nparam n = 1\nstart A -> B\nstyle default { n = 2 }\nstyle default for Z { n = 4 }\n");
}

TEST_F(Edits, Styles) {
    expectReplaced(edits::saveStyle(ast, "Tall", "Tower", {{"floors", "7"}, {"lean", ".5"}}), "{ floors = 9 }",
                   "{ floors = 7 lean = .5 }");
    expectReplaced(edits::saveStyle(ast, "Low", "", {{"floors", "1"}}), "floors = 9 }\n",
                   "floors = 9 }\nstyle Low { floors = 1 }\n");
    expectReplaced(edits::removeStyle(ast, "Tall", "Tower"), "style Tall for Tower { floors = 9 }\n", "");
    expectReplaced(edits::removeSetting(ast, "Tower", "Tall", "floors"), " floors = 9", "");
    expectRefused(edits::removeStyle(ast, "Tall", ""), "no style");
    std::vector<edits::NamedValue> many;
    for (int i = 0; i < 30; ++i) many.push_back({"parameter" + std::to_string(i), "1.25m"});
    const Edit wide = edits::saveStyle(ast, "Wide", "", many);
    ASSERT_TRUE(wide.ok());
    const syntax::Ast styled = parsed(applied(tower, *wide));
    EXPECT_EQ(styled.styles[1].settings.size(), 30u);
    for (uint32_t line = 1; line < 40; ++line) EXPECT_LE(styled.source->line(line).size(), 100u);
}

TEST(TextEdits, DifferenceInverseAndMerge) {
    for (const auto& [a, b] : {std::pair("abc", "abc"), std::pair("aaa", "aaaa"), std::pair("", "x"),
                               std::pair("hello world", "help word"), std::pair("abab", "ab")}) {
        const TextEdit edit = difference(a, b);
        EXPECT_EQ(applied(a, edit), b);
        EXPECT_EQ(applied(b, inverse(a, edit)), a);
    }
    EXPECT_EQ(difference("one two", "one 2 two"), (TextEdit{4, 4, "2 "}));
    EXPECT_EQ(applied("0123456789", merged("0123456789", {{8, 9, "x"}, {1, 3, ""}, {5, 5, "y"}})), "034y567x9");
}

}  // namespace
}  // namespace sgm::document
