// Parts of a split, of faces and of a choice: added, taken out, copied, moved and changed with their bars.
#include "tests/document/texts.h"

namespace sgm::document {
namespace {

using syntax::Element;

constexpr const char* bay =
    "grammar 2\n"
    "start Front -> size (9, 3, .3) Row\n"
    "rule Row -> split x { .5m: brick | { ~2m: Bay }* | .5m: brick } // one line\n"
    "rule Bay -> split y {\n"
    "    1m: brick   // the sill\n"
    "  | ~1: Window\n"
    "  | 20%: brick  // above\n"
    "}\n"
    "rule Window -> split x {\n"
    "    ~1: brick |  // left\n"
    "    ~2: glass |\n"
    "    ~1: choose { 2: brick | 1: glass }\n"
    "}\n";

class Parts : public testing::Test {
protected:
    using Cases = std::vector<syntax::Case>;
    const Cases& partsOf(size_t rule) const {
        const syntax::Element& element = ast.rules[rule].body.siblings[0][0];
        return element.before[0].cases;
    }

    void expectReplaced(const edits::Edit& edit, std::string_view from, std::string_view to) {
        ASSERT_TRUE(edit.ok()) << edit.error().message;
        EXPECT_EQ(applied(bay, *edit), replaced(bay, from, to));
    }
    static void expectRefused(const edits::Edit& edit, const std::string& why) {
        ASSERT_FALSE(edit.ok());
        EXPECT_NE(edit.error().message.find(why), std::string::npos) << edit.error().message;
    }
    /// The text at the node that the edit leaves selected.
    static std::string nodeOf(const edits::Edit& edit) {
        return applied(bay, *edit).substr(edit->begin + edit->node.value(), 9);
    }

    syntax::Ast ast = parsed(bay);
    const Cases &row = partsOf(0), &floors = partsOf(1), &window = partsOf(2);
};

TEST_F(Parts, AreTakenOut) {
    expectReplaced(edits::removePart(ast, row[0]), "{ .5m: brick | { ~2m", "{ { ~2m");
    expectReplaced(edits::removePart(ast, row[1]), " { ~2m: Bay }* |", "");
    expectReplaced(edits::removePart(ast, row[2]), " | .5m: brick } // one", " } // one");
    expectReplaced(edits::removePart(ast, floors[0]), "1m: brick   // the sill\n  | ~1", "// the sill\n  ~1");
    expectReplaced(edits::removePart(ast, floors[1]), "  | ~1: Window\n", "");
    expectReplaced(edits::removePart(ast, floors[2]), "| 20%: brick  // above", "// above");
    expectReplaced(edits::removePart(ast, window[1]), "    ~2: glass |\n", "");
    expectReplaced(edits::removePart(ast, window[2]), " |\n    ~1: choose { 2: brick | 1: glass }", "");
    expectRefused(edits::removePart(ast, row[1].cases[0]), "only part");
}

TEST_F(Parts, AreAddedAndCopied) {
    expectReplaced(edits::addPart(ast, row[2], "~1: cube"), "brick } // one", "brick | ~1: cube } // one");
    expectReplaced(edits::duplicatePart(ast, row[1]), "{ ~2m: Bay }*", "{ ~2m: Bay }* | { ~2m: Bay }*");
    expectReplaced(edits::addPart(ast, row[1].cases[0], "1m: brick"), "~2m: Bay }", "~2m: Bay | 1m: brick }");
    expectReplaced(edits::addPart(ast, floors[0], "{ ~1m: cube }*"), "// the sill\n",
                   "// the sill\n  | { ~1m: cube }*\n");
    expectReplaced(edits::duplicatePart(ast, floors[2]), "  // above\n", "  // above\n  | 20%: brick\n");
    expectReplaced(edits::duplicatePart(ast, window[1]), "~2: glass |", "~2: glass |\n    ~2: glass |");
    expectReplaced(edits::addPart(ast, window[2].body->siblings[0][0].cases[1], edits::samplePart(nullptr)),
                   "1: glass }", "1: glass | 1: cube }");
    expectRefused(edits::addPart(ast, row[2], "cube"), "label");
    expectRefused(edits::addPart(ast, row[2], "1m: cube }"), "}");
    EXPECT_EQ(nodeOf(edits::addPart(ast, row[2], "~1: torus")), "~1: torus") << "what is added is selected";
}

TEST_F(Parts, ChangePlaces) {
    expectReplaced(edits::movePart(ast, row[0], 1), ".5m: brick | { ~2m: Bay }*", "{ ~2m: Bay }* | .5m: brick");
    expectReplaced(edits::movePart(ast, floors[2], -1), "~1: Window\n  | 20%: brick", "20%: brick\n  | ~1: Window");
    EXPECT_EQ(nodeOf(edits::movePart(ast, row[0], 1)), ".5m: bric");
    EXPECT_EQ(nodeOf(edits::movePart(ast, floors[2], -1)), "20%: bric");
    expectRefused(edits::movePart(ast, row[0], -1), "no part");
    expectRefused(edits::movePart(ast, row[2], 1), "no part");
}

TEST(Parameters, AreAddedAndMadeOfNumbers) {
    const std::string text =
        "grammar 2\n\nstart A -> cube size (9, 3, 50%) turn 30deg : B // whole\nrule B -> + sphere at +y\n";
    const syntax::Ast ast = parsed(text);
    const auto after = [&](const edits::Edit& edit) { return edit.ok() ? applied(text, *edit) : edit.error().message; };
    EXPECT_EQ(after(edits::addParameter(ast, "wide = 2m in 1m..4m")),
              replaced(text, "grammar 2\n", "grammar 2\nparam wide = 2m in 1m..4m\n"));
    EXPECT_NE(after(edits::addParameter(ast, "wide 2m")), "");
    EXPECT_FALSE(edits::addParameter(ast, "wide 2m").ok());
    EXPECT_FALSE(edits::addParameter(ast, "a = 1\nrule C -> cube").ok());
    EXPECT_FALSE(edits::addParameter(parsed("grammar 2\nparam a = 1\nstart A -> cube\n"), "a = 2").ok());
    const Element& cube = ast.starts[0].body.siblings[0][0];
    const auto& size = cube.after[0].args[0].args;
    EXPECT_EQ(after(edits::makeParameter(ast, size[0], "wide", edits::Quantity::Metres)),
              replaced(replaced(text, "(9,", "(wide,"), "grammar 2\n", "grammar 2\nparam wide = 9m in 4.5m..18m\n"));
    EXPECT_EQ(after(edits::makeParameter(ast, size[2], "deep", edits::Quantity::Metres)),
              replaced(replaced(text, "50%", "deep"), "grammar 2\n", "grammar 2\nparam deep = 50% in 25%..100%\n"));
    EXPECT_EQ(after(edits::makeParameter(ast, size[1], "n", edits::Quantity::Count)),
              replaced(replaced(text, " 3,", " n,"), "grammar 2\n", "grammar 2\nparam n = 3 in 1..6\n"));
    const std::string taken = "grammar 2\nparam n = 1.0\nstart A -> cube size 2\n";
    const syntax::Ast other = parsed(taken);
    EXPECT_EQ(applied(taken, *edits::makeParameter(other, other.starts[0].body.siblings[0][0].after[0].args[0], "n",
                                                   edits::Quantity::Real)),
              "grammar 2\nparam n = 1.0\nparam n2 = 2.0 in 1.0..4.0\nstart A -> cube size n2\n");
}

TEST(Divisions, KeepWhatIsSaidOfTheWhole) {
    const auto divided = [](const std::string& body, std::string_view name) {
        const std::string text = "grammar 2\nstart A -> " + body + " // whole\n";
        const syntax::Ast ast = parsed(text);
        const auto edit = edits::divide(ast, ast.starts[0].body.siblings[0].back(), name);
        if (!edit.ok()) return edit.error().message;
        const std::string after = applied(text, *edit);
        (void)parsed(after);
        EXPECT_EQ(after.substr(edit->begin + edit->node.value(), 3), std::string(name).substr(0, 3)) << "selected";
        return after.substr(21, after.find(" //") - 21);
    };
    EXPECT_EQ(divided("cube", "split"), "split x { ~1: cube | ~1: cube }");
    EXPECT_EQ(divided("size 2 sphere", "split { }*"), "size 2 split x { { ~1m: sphere }* }");
    EXPECT_EQ(divided("cube size (4, 3, 2) color #aa4422", "faces"),
              "size (4, 3, 2) color #aa4422 faces .3m { side: cube | rest: nil }");
    EXPECT_EQ(divided("cube + torus(.2) at +x", "row"), "cube + at +x row 3 along x { torus(.2) }");
    for (const edits::Division& division : edits::divisions())
        EXPECT_NE(divided("cube size 2", division.name).find("{"), std::string::npos) << division.name;
    EXPECT_NE(divided("cube : B", "split").find("divide it in its rule"), std::string::npos);
    EXPECT_NE(divided("cube", "size").find("doesn't divide"), std::string::npos);
}

TEST_F(Parts, TakeSizesAndCounts) {
    expectReplaced(edits::setPartLabel(ast, floors[0], "100% - 2m"), "1m: brick   //", "100% - 2m: brick   //");
    expectReplaced(edits::setPartLabel(ast, window[1], "~3"), "~2: glass", "~3: glass");
    expectReplaced(edits::setPartTimes(ast, row[1], "3"), "}*", "}3");
    expectReplaced(edits::setPartTimes(ast, row[1], "+"), "}*", "}+");
    expectReplaced(edits::setPartTimes(ast, row[1], "2 + 1"), "}*", "}(2 + 1)");
    expectRefused(edits::setPartTimes(ast, row[0], "3"), "repeats");
    expectRefused(edits::setPartLabel(ast, row[1], "3m"), "no label");
    EXPECT_FALSE(edits::setPartLabel(ast, floors[0], "").ok());
}

}  // namespace
}  // namespace sgm::document
