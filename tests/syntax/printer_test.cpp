// The formatter: canonical layout that keeps every token, every comment and the meaning.
#include "grammar/syntax/printer.h"
#include "grammar/operations/operations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "grammar/syntax/parser.h"
#include "tests/syntax/dump.h"
#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

std::string formatted(const std::string& text) { return format(*makeSource(text), operations::table()); }

/// Tokens and comments in order, a line each.
std::string contents(const Source& source) {
    std::string out;
    for (const Token& token : lex(source)) {
        if (token.kind == Token::Kind::Blank) continue;
        std::string text(textOf(source, token));
        while (token.kind == Token::Kind::Comment && (text.back() == ' ' || text.back() == '\r')) text.pop_back();
        out += text + '\n';
    }
    return out;
}

void expectSafe(const SourcePtr& source) {
    Diagnostics diagnostics;
    const Ast ast = parse(source, operations::table(), diagnostics);
    ASSERT_FALSE(diagnostics.hasErrors()) << source->name() << renderAll(diagnostics);
    const SourcePtr once = makeSource(format(*source, operations::table()));
    EXPECT_EQ(contents(*once), contents(*source)) << source->name();
    EXPECT_EQ(format(*once, operations::table()), once->text()) << source->name();
    EXPECT_EQ(Dump(parse(once, operations::table(), diagnostics)).text(), Dump(ast).text()) << source->name();
}

TEST(Printer, SketchKeepsTokensCommentsAndMeaning) { expectSafe(readSource("tests/syntax/sketch.sgm")); }

TEST(Printer, ExamplesKeepTokensCommentsAndMeaning) {
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator("examples")) {
        if (entry.path().extension() != ".sgm") continue;
        expectSafe(readSource(entry.path().string()));
        ++files;
    }
    EXPECT_GT(files, 0u);
}

TEST(Printer, BlanksAreCanonical) {
    EXPECT_EQ(formatted("grammar   1\nstart A->cube size(1,2,3)at +x   to centre:B,nil\n"),
              "grammar 1\nstart A -> cube size (1, 2, 3) at +x to centre : B, nil\n");
    EXPECT_EQ(formatted("grammar 1\nrule R : A when(a+b*-c)>=d [ 1 ]and not e . x->choose{8:cube|2 : nil}\n"),
              "grammar 1\nrule R: A when (a + b * -c) >= d[1] and not e.x -> choose { 8: cube | 2: nil }\n");
    EXPECT_EQ(formatted("grammar 1\nstart A -> cube size choose{a[0]:1m|2 : 2m+b}\n"),
              "grammar 1\nstart A -> cube size choose { a[0]: 1m | 2: 2m + b }\n");
    EXPECT_EQ(formatted("grammar 1\nstart A -> split y{{ ~ 3m:Row } * | - .2...2: morph( cube,a : - x,b:-x )}\n"),
              "grammar 1\nstart A -> split y { { ~3m: Row }* | -.2 .. .2: morph(cube, a: - x, b: -x) }\n");
    EXPECT_EQ(formatted("grammar 1\nderive d:R0=>R1 at A / B[ 3 ]\nstyle S{a=1   b= - 2}\n"),
              "grammar 1\nderive d: R0 => R1 at A/B[3]\nstyle S { a = 1 b = -2 }\n");
}

TEST(Printer, LinesStayAndAreIndented) {
    EXPECT_EQ(formatted("grammar 1\n\n\n\nrule A repeat n\n-> + cube\nat +x : A // grows\n // alone\n"
                        "      finally for d in axes {\n+ cube at d }\nrule B ->\n cube +\n   cone"),
              "grammar 1\n\nrule A repeat n\n  -> + cube\n     at +x : A  // grows\n     // alone\n"
              "  finally for d in axes {\n            + cube at d }\nrule B ->\n    cube +\n    cone\n");
}

TEST(Printer, ParametersAndCommentsStandInColumns) {
    EXPECT_EQ(
        formatted(
            "grammar 1\nparam a = 1 in 1..60 \"Ä\" group G key k // one\nparam long = .25 \"B\" group Long // two\n"
            "\nparam c = flat of flat, round\n"),
        "grammar 1\n"
        "param a    = 1   in 1..60 \"Ä\" group G    key k  // one\n"
        "param long = .25          \"B\" group Long        // two\n"
        "\nparam c = flat of flat, round\n");
}

TEST(Printer, ParametersMayBeCalledLikeTheirParts) {
    EXPECT_EQ(formatted("grammar 1\nparam a = key in group..of group in key key\nparam b = 1\n"),
              "grammar 1\nparam a = key in group..of group in key key\nparam b = 1\n");
}

TEST(Printer, TextWithProblemsStaysAsItIs) {
    const std::string broken = "grammar 1\nstart  A ->   cube siz 2\n";
    EXPECT_EQ(formatted(broken), broken);
    EXPECT_EQ(formatted(""), "");
}

TEST(Printer, EndsLinesAsTheProjectDoes) {
    EXPECT_EQ(formatted("\xef\xbb\xbfgrammar 1 // a \r\n\r\n\r\nstart A -> cube\r\n\r\n"),
              "grammar 1  // a\n\nstart A -> cube\n");
}

}  // namespace
}  // namespace sgm::syntax
