// The parser on bad input: exactly what the user sees, problem by problem.
#include <gtest/gtest.h>

#include "grammar/operations/operations.h"
#include "grammar/syntax/parser.h"
#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

std::string problems(const std::string& text) {
    Diagnostics diagnostics;
    const Ast ast = parse(makeSource(text), operations::table(), diagnostics);
    return renderAll(diagnostics);
}

// Each piece of the file is a grammar, a line of '-' and its problems; a line of '=' ends it.
TEST(Diagnostics, ReadAsWritten) {
    const std::string golden(readSource("tests/syntax/diagnostics.golden")->text());
    const std::string middle = "\n-----\n", last = "=====\n";
    size_t pieces = 0;
    for (size_t begin = 0; begin < golden.size(); ++pieces) {
        const size_t split = golden.find(middle, begin), end = golden.find(last, begin);
        ASSERT_NE(split, std::string::npos);
        ASSERT_NE(end, std::string::npos);
        const std::string text = golden.substr(begin, split - begin);
        EXPECT_EQ(problems(text), golden.substr(split + middle.size(), end - split - middle.size())) << text;
        begin = end + last.size();
    }
    EXPECT_GE(pieces, 16u);
}

TEST(Diagnostics, NestingAndLengthAreBounded) {
    const auto repeated = [](const std::string& unit, int times) {
        std::string out;
        for (int i = 0; i < times; ++i) out += unit;
        return out;
    };
    const auto messages = [](const std::string& text) {
        Diagnostics diagnostics;
        parse(makeSource("grammar 1\n" + text), operations::table(), diagnostics);
        std::string out;
        for (const Diagnostic& d : diagnostics.all()) out += d.message + '\n';
        return out;
    };
    EXPECT_EQ(messages("param a = " + repeated("(", 90) + "1" + repeated(")", 90)), "");
    EXPECT_EQ(messages("param a = " + repeated("(", 5000) + "1" + repeated(")", 5000)), "nested more than 100 deep\n");
    EXPECT_EQ(messages("param a = " + repeated("- ", 5000) + "1"), "nested more than 100 deep\n");
    EXPECT_EQ(messages("start A -> " + repeated("(", 5000) + "cube"), "nested more than 100 deep\n");
    EXPECT_EQ(messages("start A -> " + repeated("split x { 1: ", 5000)), "nested more than 100 deep\n");
    EXPECT_EQ(messages("start A -> split x " + repeated("{ ", 5000)), "nested more than 100 deep\n");
    EXPECT_EQ(messages("param a = 1" + repeated(" + 1", 400)), "");
    EXPECT_EQ(messages("param a = 1" + repeated(" + 1", 401)), "more than 400 operators in one expression\n");
    EXPECT_EQ(messages("param a = b" + repeated("[0]", 401)), "more than 400 operators in one expression\n");
}

TEST(Diagnostics, LongLinesAreShownAroundTheirPlace) {
    const std::string shown = problems("grammar 1\nparam a = \"" + std::string(500, 'x') + "\" " + "5\n");
    EXPECT_EQ(shown, "t.sgm:2:514: error: unexpected '5'\n  " + std::string(78, 'x') + "\" 5\n  " +
                         std::string(80, ' ') + "^\n");
}

TEST(Diagnostics, AFragmentIsReadToItsEnd) {
    Diagnostics diagnostics;
    const SourcePtr source = makeSource("1 + 2 cube", "--set");
    parseExpression(source, diagnostics);
    EXPECT_EQ(renderAll(diagnostics), "--set:1:7: error: unexpected 'cube'\n  1 + 2 cube\n        ^~~~\n");
}

}  // namespace
}  // namespace sgm::syntax
