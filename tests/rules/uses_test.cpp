// `use`: declarations of other files, once each, without circles.
#include <gtest/gtest.h>

#include "grammar/operations/operations.h"
#include "grammar/rules/params.h"
#include "tests/rules/read.h"

namespace sgm::rules {
namespace {

TEST(Uses, MergeDeclarationsBeforeTheirUser) {
    const Checked c =
        checked("grammar 1\nuse \"a.sgm\"\nuse \"b.sgm\"\nstart S -> wall : Cell\nrule Cell -> + wall at +y\n",
                {{"a.sgm", "grammar 1\nuse \"b.sgm\"\nrule Cell when scope.x > 9 -> nil\n"},
                 {"b.sgm", "grammar 1\nterminal wall\n"}});
    ASSERT_TRUE(c.grammar) << c.messages();
    EXPECT_EQ(c.messages(),
              "warning: there is already a rule for 'Cell' in a.sgm, line 3, of which this one is another alternative: "
              "an error in 'grammar 2'\n");
    ASSERT_EQ(c.grammar->sources.size(), 3u);
    EXPECT_EQ(c.grammar->sources[0]->name(), "test.sgm");
    EXPECT_EQ(c.grammar->rules.at(0).name, "Cell#1");
    EXPECT_EQ(c.grammar->rules[0].span.source->name(), "a.sgm");
    EXPECT_EQ(c.grammar->symbols.at(0).name, "wall") << "b.sgm is read once";
}

TEST(Uses, RefuseRulesOfTwoFilesForOneSymbol) {
    const std::map<std::string, std::string> files{
        {"a.sgm", "grammar 2\nrule Court -> cube, Yard\nrule Court -> sphere\n"}};
    const auto said = [&](const std::string& rules) {
        return checked("grammar 2\nuse \"a.sgm\"\nstart S -> Court\n" + rules, files).messages();
    };
    EXPECT_EQ(said("rule Court -> cube\nrule Court -> cone\nrule Yard -> nil\n"),
              "there is already a rule for 'Court' in a.sgm, line 2: the rules of two files for one shape would be "
              "alternatives\n")
        << "once a file";
    EXPECT_EQ(said("rule Yard -> cube\n"), "") << "what a file leaves without a rule is another's to fill";
}

TEST(Uses, BeginWithTheFilesOwnStart) {
    const Checked c = checked("grammar 1\nuse \"a.sgm\"\nstart Town -> cube\nstart Other -> cube\n",
                              {{"a.sgm", "grammar 1\nstart House -> cube\n"}});
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto nameOf = [&](size_t i) { return c.grammar->symbols[c.grammar->starts[i].symbol].name; };
    EXPECT_EQ(nameOf(0), "Town");
    EXPECT_EQ(nameOf(1), "Other");
    EXPECT_EQ(nameOf(2), "House");
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

TEST(Uses, RefuseChainsWithoutEnd) {
    Loader endless([](const std::string&, const syntax::Source& from, std::string&) {
        const int next = std::stoi(from.name() == "test.sgm" ? "0" : from.name()) + 1;
        return std::make_shared<const syntax::Source>(std::to_string(next), "grammar 1\nuse \"next\"\n");
    });
    syntax::Diagnostics diagnostics;
    EXPECT_FALSE(load(std::make_shared<const syntax::Source>("test.sgm", "grammar 1\nuse \"next\"\nstart S -> cube\n"),
                      operations::table(), endless, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.all()[0].message, "more than 100 files use each other in a row");
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

TEST(Uses, GiveOtherDefaults) {
    const std::map<std::string, std::string> files{
        {"a.sgm",
         "grammar 1\nuse \"b.sgm\" { far = 2m }\nparam near = 1m in 0m..9m\nparam kind = flat of flat, steep\nterminal "
         "wall color #000000 rough even\n"},
        {"b.sgm", "grammar 1\nparam far = 3m in 0m..9m\nparam even = .5 in 0..1\n"}};
    const Checked c = checked(
        "grammar 1\nuse \"a.sgm\" { near = 4 kind = steep even = .25 }\nstart S -> wall size (near + far)\n", files);
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto value = [&](const char* name) -> const Param& {
        for (const Param& p : c.grammar->params)
            if (p.name == name) return p;
        return c.grammar->params.at(99);
    };
    EXPECT_EQ(toText(value("near").value), "4m");
    EXPECT_EQ(toText(value("far").value), "2m");
    EXPECT_EQ(value("kind").value.text, "steep");
    EXPECT_EQ(value("near").valueSpan.text(), "4") << "what a slider rewrites";
    EXPECT_EQ(value("near").valueSpan.source->name(), "test.sgm");
    EXPECT_FLOAT_EQ(c.grammar->materials.back().roughness, .25f);
}

TEST(Uses, RefuseDefaultsThatDontFit) {
    const std::map<std::string, std::string> files{{"a.sgm", "grammar 1\nparam near = 1m in 0m..9m\n"}};
    const auto said = [&](const std::string& settings) {
        return checked("grammar 1\nuse \"a.sgm\" { " + settings +
                           " }\nparam own = 1 in 0..9\nstart S -> cube size (near * own)\n",
                       files)
            .messages();
    };
    EXPECT_EQ(said("near = 10m"), "'near' is 10m, outside its range 0m..9m\n");
    EXPECT_EQ(said("naer = 1m"), "there is no parameter 'naer'\n");
    EXPECT_EQ(said("own = 2"), "'own' is this file's own parameter\n");
    EXPECT_EQ(said("near = 1m near = 2m"), "'near' is set twice\n");
    EXPECT_EQ(said("near = own"), "'own' is a parameter, but a plain value must stand here\n");
}

TEST(Styles, ADefaultOneCountsForItsStart) {
    const Checked c = checkedBody(
        "param n = 1 in 0..9\nparam m = 1 in 0..9\nstart A -> cube size (n, m, 1)\nstart B -> cube\nstart C -> cube\n"
        "style default for A { n = 2 }\nstyle default for B { n = 3 }\nstyle default { m = 4 }\nstyle Big for A { n = "
        "9 }\n");
    ASSERT_TRUE(c.grammar) << c.messages();
    const auto values = [&](uint32_t start) {
        return toText(valuesOf(*c.grammar, start)[0]) + " " + toText(valuesOf(*c.grammar, start)[1]);
    };
    EXPECT_EQ(values(0), "2 1");
    EXPECT_EQ(values(1), "3 1");
    EXPECT_EQ(values(2), "1 4");
    EXPECT_EQ(checkedBody("start A -> cube\nstyle default for A { }\nstyle default for A { }\n").messages(),
              "there is already a style 'default for A' in test.sgm, line 3\n");
}

TEST(Uses, DontWarnOfWhatALibraryOffers) {
    const Checked c = checked("grammar 1\nuse \"a.sgm\"\nstart S -> cube\n",
                              {{"a.sgm", "grammar 1\nparam depth = 1\nrule Wall -> cube\n"}});
    EXPECT_TRUE(c.grammar);
    EXPECT_EQ(c.messages(), "");
}

}  // namespace
}  // namespace sgm::rules
