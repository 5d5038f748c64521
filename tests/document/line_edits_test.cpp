#include "viewer/document/line_edits.h"

#include <gtest/gtest.h>

namespace sgm::document {
namespace {

TEST(LineEdits, IndentWhatTheSelectionReachesInto) {
    const EditedText lines{"a\n  b\n\nc\nd", 8, 0};
    EXPECT_EQ(indented(lines, false), (EditedText{"  a\n    b\n\n  c\nd", 14, 0}));
    EXPECT_EQ(indented(indented(lines, false), true).text, lines.text);
    EXPECT_EQ(indented({"a\nb\n", 2, 0}, false).text, "  a\nb\n") << "the selection ends where a line starts";
    EXPECT_EQ(indented({"abc", 1, 2}, false), (EditedText{"  abc", 3, 4})) << "a part of a line";
    EXPECT_EQ(indented({" a\n\tb\nc", 0, 6}, true).text, "a\nb\nc") << "no more than there is";
    EXPECT_EQ(indented({"    a", 5, 5}, true), (EditedText{"  a", 3, 3}));
    EXPECT_EQ(indented({"", 0, 0}, false).text, "");
    EXPECT_EQ(indented({"a\n", 2, 2}, true).text, "a\n");
}

TEST(LineEdits, CommentsComeAndGo) {
    const EditedText lines{"  a\n    b\n\n  c", 14, 0};
    const EditedText comments = commented(lines);
    EXPECT_EQ(comments.text, "  // a\n  //   b\n\n  // c");
    EXPECT_EQ(commented(comments).text, lines.text);
    EXPECT_EQ(commented({"a\n// b", 0, 6}).text, "// a\n// // b") << "not all of them are comments";
    EXPECT_EQ(commented({"//", 1, 1}).text, "");
    EXPECT_EQ(commented({"//a", 3, 3}), (EditedText{"a", 1, 1}));
    EXPECT_EQ(commented({"\n\n", 1, 1}).text, "\n\n");
}

TEST(LineEdits, WordsAreFoundRoundTheEnd) {
    using Found = std::optional<std::pair<uint32_t, uint32_t>>;
    EXPECT_EQ(occurrence("Cave cell cave", "cave", 1, false), Found({10, 14}));
    EXPECT_EQ(occurrence("Cave cell cave", "cave", 11, false), Found({0, 4}));
    EXPECT_EQ(occurrence("Cave cell cave", "cave", 10, true), Found({0, 4}));
    EXPECT_EQ(occurrence("Cave cell cave", "cave", 0, true), Found({10, 14}));
    EXPECT_EQ(occurrence("Cave", "cell", 0, false), std::nullopt);
    EXPECT_EQ(occurrence("Cave", "", 0, true), std::nullopt);
}

}  // namespace
}  // namespace sgm::document
