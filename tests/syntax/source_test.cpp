// Places, rendered problems, their JSON, nearest words, and the lexer's promise to lose nothing.
#include "grammar/syntax/source.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grammar/syntax/lexer.h"
#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

TEST(Source, PlacesCountFromOne) {
    const Source source("a.sgm", "ab\n\ncd");
    EXPECT_EQ(source.place(0).line, 1u);
    EXPECT_EQ(source.place(0).column, 1u);
    EXPECT_EQ(source.place(2).column, 3u);  // the line end belongs to its line
    EXPECT_EQ(source.place(3).line, 2u);
    EXPECT_EQ(source.place(5).line, 3u);
    EXPECT_EQ(source.place(5).column, 2u);
    EXPECT_EQ(source.place(99).line, 3u);
    EXPECT_EQ(source.place(99).column, 3u);
    EXPECT_EQ(source.line(1), "ab");
    EXPECT_EQ(source.line(2), "");
    EXPECT_EQ(source.line(3), "cd");
    EXPECT_EQ(source.line(0), "");
    EXPECT_EQ(source.line(4), "");
    EXPECT_EQ(Source("crlf", "ab\r\ncd\r\n").line(1), "ab");
}

TEST(Source, JoinedSpansHoldBoth) {
    const Source source("a.sgm", "one two three");
    const SourceSpan all = join({&source, 8, 13}, {&source, 0, 3});
    EXPECT_EQ(all.text(), "one two three");
    EXPECT_EQ(join({}, {&source, 4, 7}).text(), "two");
    EXPECT_EQ(join({&source, 4, 7}, {}).text(), "two");
    EXPECT_EQ(SourceSpan().text(), "");
}

TEST(Source, CaretsStandUnderTheirSpan) {
    const Source source("a.sgm", "\tü = siz\t2\n");
    const Diagnostic problem{Severity::Warning, {&source, 6, 9}, "unknown word 'siz'", "did you mean 'size'?"};
    EXPECT_EQ(render(problem),
              "a.sgm:1:7: warning: unknown word 'siz'\n  \tü = siz\t2\n  \t    ^~~\n  did you mean 'size'?\n");
}

TEST(Source, CaretsStayInTheirLine) {
    const Source source("a.sgm", "ab\ncd");
    EXPECT_EQ(render({Severity::Error, {&source, 1, 5}, "m", ""}), "a.sgm:1:2: error: m\n  ab\n   ^\n");
    EXPECT_EQ(render({Severity::Error, {&source, 5, 5}, "m", ""}), "a.sgm:2:3: error: m\n  cd\n    ^\n");
    EXPECT_EQ(render({Severity::Error, {}, "nowhere", ""}), "error: nowhere\n");
}

TEST(Source, JsonIsSortedByPlaceAndAlwaysUtf8) {
    const Source source("a.sgm", "one\ntwo \xff");
    Diagnostics diagnostics;
    diagnostics.warning({&source, 4, 7}, "later \xff", "hint");
    diagnostics.error({&source, 0, 3}, "first");
    EXPECT_TRUE(diagnostics.hasErrors());
    const nlohmann::json list = nlohmann::json::parse(toJson(diagnostics));
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0]["message"], "first");
    EXPECT_EQ(list[0]["severity"], "error");
    EXPECT_EQ(list[0]["endColumn"], 4);
    EXPECT_EQ(list[1]["file"], "a.sgm");
    EXPECT_EQ(list[1]["line"], 2);
    EXPECT_EQ(list[1]["column"], 1);
    EXPECT_EQ(list[1]["hint"], "hint");
    EXPECT_EQ(toJson(Diagnostics()), "[]");
}

TEST(Source, DidYouMeanFindsTheNearest) {
    const std::vector<std::string> words = {"size", "shift", "split", "sphere", "Wing", "x"};
    EXPECT_EQ(didYouMean("siz", words), "size");
    EXPECT_EQ(didYouMean("szie", words), "size");
    EXPECT_EQ(didYouMean("shpere", words), "sphere");
    EXPECT_EQ(didYouMean("wing", words), "Wing");
    EXPECT_EQ(didYouMean("facade", words), "");
    EXPECT_EQ(didYouMean("over", {"cover", "overhang"}), "overhang") << "what was begun is no slip of a letter";
    EXPECT_EQ(didYouMean("hip", {"ship", "hipRoof"}), "hipRoof");
    EXPECT_EQ(didYouMean("y", words), "");
    EXPECT_EQ(didYouMean("", words), "");
    EXPECT_EQ(didYouMean(std::string(1000, 's'), words), "");
}

TEST(Lexer, TokensJoinedGiveTheTextBack) {
    for (const SourcePtr& source :
         {readSource("tests/syntax/sketch.sgm"), makeSource("\xef\xbb\xbf\"a\\\"b\n#12 .5.5..6 \x01\xc3\xbc/")}) {
        std::string joined;
        for (const Token& token : lex(*source)) {
            EXPECT_EQ(token.begin, joined.size());
            joined += textOf(*source, token);
        }
        EXPECT_EQ(joined, source->text());
    }
}

}  // namespace
}  // namespace sgm::syntax
