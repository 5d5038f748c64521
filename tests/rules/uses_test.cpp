// `use`: declarations of other files, once each, without circles.
#include <gtest/gtest.h>

#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

TEST(Uses, MergeDeclarationsBeforeTheirUser) {
    const Checked c =
        checked("grammar 1\nuse \"a.sgm\"\nuse \"b.sgm\"\nstart S -> wall : Cell\nrule Cell -> + wall at +y\n",
                {{"a.sgm", "grammar 1\nuse \"b.sgm\"\nrule Cell when scope.x > 9 -> nil\n"},
                 {"b.sgm", "grammar 1\nterminal wall\n"}});
    ASSERT_TRUE(c.grammar) << c.messages();
    EXPECT_EQ(c.messages(), "");
    ASSERT_EQ(c.grammar->sources.size(), 3u);
    EXPECT_EQ(c.grammar->sources[0]->name(), "test.sgm");
    EXPECT_EQ(c.grammar->rules.at(0).name, "Cell#1");
    EXPECT_EQ(c.grammar->rules[0].span.source->name(), "a.sgm");
    EXPECT_EQ(c.grammar->symbols.at(0).name, "wall") << "b.sgm is read once";
}

TEST(Uses, RefuseCircles) {
    const Checked c = checked("grammar 1\nuse \"a.sgm\"\nstart S -> cube\n",
                              {{"a.sgm", "grammar 1\nuse \"b.sgm\"\n"}, {"b.sgm", "grammar 1\nuse \"a.sgm\"\n"}});
    EXPECT_FALSE(c.grammar);
    EXPECT_EQ(c.messages(), "files use each other in a circle: a.sgm -> b.sgm -> a.sgm\n");
    EXPECT_EQ(c.diagnostics.all()[0].span.source->name(), "b.sgm");
}

TEST(Uses, RefuseAFileThatUsesItself) {
    const Checked c = checked("grammar 1\nuse \"test.sgm\"\nstart S -> cube\n", {{"test.sgm", "grammar 1\n"}});
    EXPECT_EQ(c.messages(), "files use each other in a circle: test.sgm -> test.sgm\n");
}

TEST(Uses, SayWhatTheLoaderSaysAndNoMore) {
    const Checked c = checked("grammar 1\nuse \"gone.sgm\"\nstart S -> brick\n");
    EXPECT_EQ(c.messages(), "can't use \"gone.sgm\": there is no such file\n") << "'brick' may be declared there";
}

TEST(Uses, PointIntoTheUsedFile) {
    const Checked c =
        checked("grammar 1\nuse \"a.sgm\"\nstart S -> cube\n", {{"a.sgm", "grammar 1\nrule Wall -> cubee\n"}});
    ASSERT_EQ(c.diagnostics.all().size(), 1u);
    EXPECT_EQ(syntax::render(c.diagnostics.all()[0]).rfind("a.sgm:2:14: error: unknown solid 'cubee'", 0), 0u);
}

TEST(Uses, DontWarnOfWhatALibraryOffers) {
    const Checked c = checked("grammar 1\nuse \"a.sgm\"\nstart S -> cube\n",
                              {{"a.sgm", "grammar 1\nparam depth = 1\nrule Wall -> cube\n"}});
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(), "");
}

}  // namespace
}  // namespace sgm::rules
