// The words that fields offer: those that may stand there, in groups, with help.
#include "viewer/document/word_lists.h"

#include "tests/document/shown.h"

namespace sgm::document {
namespace {

TEST(WordLists, OfferWhatMayStandThere) {
    const Document document(
        "grammar 2\nuse \"std/walls.sgm\"\nmaterial oak color #885522\nterminal post = cylinder\n"
        "start A -> stone size 2 of oak : B\nrule B -> + post at +x\n");
    const auto model = shown(document);
    const auto groupOf = [](const std::vector<ListedWord>& words, const std::string& name) -> std::string {
        for (const ListedWord& word : words)
            if (word.name == name) return word.group + (word.doc.empty() ? "" : ", told");
        return "";
    };
    const auto solids = placeableWords(model->grammar.get());
    EXPECT_EQ(groupOf(solids, "B"), "Shapes with rules");
    EXPECT_EQ(groupOf(solids, "post"), "Terminals");
    EXPECT_EQ(groupOf(solids, "stone"), "Terminals, told") << "of the file that is used";
    EXPECT_EQ(groupOf(solids, "sphere"), "Solids, told");
    EXPECT_EQ(groupOf(solids, "oak"), "");
    EXPECT_EQ(groupOf(materialWords(model->grammar.get()), "oak"), "Materials");
    EXPECT_FALSE(placeableWords(nullptr).empty());
    const syntax::Ast& ast = *document.ast();
    const auto more = attributeWords(ast, ast.rules[0].body.siblings[0][0]);
    EXPECT_EQ(groupOf(more, "size"), "Size and plan, told");
    EXPECT_EQ(groupOf(more, "color"), "Look, told");
    EXPECT_EQ(groupOf(more, "split"), "Divide it, told");
    EXPECT_EQ(groupOf(more, "at"), "") << "it is there";
    EXPECT_EQ(groupOf(attributeWords(ast, ast.starts[0].body.siblings[0][0]), "split"), "") << "a rule goes on with it";
}

}  // namespace
}  // namespace sgm::document
