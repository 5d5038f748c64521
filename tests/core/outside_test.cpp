// What comes from outside: files that are none, text that a terminal must not see.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "modeler/core/printable.h"
#include "modeler/core/regular_file.h"
#include "tests/scratch.h"

namespace sgm {
namespace {

TEST(RegularFile, IsReadWholeUpToTheLimit) {
    const Scratch scratch;
    const std::string text(3'000'000, 'x');
    const auto path = scratch.write("a", text);
    EXPECT_EQ(*readRegularFile(path, text.size()), text);
    EXPECT_EQ(*readRegularFile(scratch.write("empty", ""), 0), "");
    EXPECT_EQ(readRegularFile(path, 2 << 20).error().message, "it is larger than 2 MiB");
    EXPECT_TRUE(readRegularFile("/proc/self/status", 1 << 20).ok()) << "tells no size";
}

TEST(RegularFile, IsNoPipeDeviceOrFolder) {
    const Scratch scratch;
    ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(readRegularFile(scratch / "pipe", 9).error().message, "it is a pipe, not a file");
    EXPECT_EQ(readRegularFile("/dev/zero", 9).error().message, "it is a device, not a file");
    EXPECT_EQ(readRegularFile(scratch.path(), 9).error().message, "it is a folder, not a file");
    EXPECT_EQ(readRegularFile(scratch / "missing", 9).error().message, "No such file or directory");
}

TEST(RegularFile, IsLetGoWhenCancelled) {
    const Scratch scratch;
    Progress progress;
    progress.cancel();
    EXPECT_EQ(readRegularFile(scratch.write("a", "text"), 9, &progress).error().kind, Error::Kind::Cancelled);
}

TEST(Printable, KeepsTextAndNoControls) {
    EXPECT_EQ(printable("größer → 木 \t!"), "größer → 木 \t!");
    EXPECT_EQ(printable("\x1b[31mred\x07\x7f"), "?[31mred??");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "??31m")
        << "a control sequence in one character";
    EXPECT_EQ(printable("a\xe2\x80\xae"
                        "b"),
              "a???b")
        << "right to left";
    EXPECT_EQ(printable("\xff\xc0\x80\xed\xa0\x80"), "??????") << "no UTF-8, an overlong NUL, a surrogate";
    EXPECT_EQ(printable("\xe6\x9c"), "??") << "cut in two";
    EXPECT_EQ(printable("a\nb"), "a?b");
    EXPECT_EQ(printable("a\nb\r", true), "a\nb?");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
}

TEST(Shortened, CutsBetweenCharacters) {
    EXPECT_EQ(shortened("abc", 3), "abc");
    EXPECT_EQ(shortened("abcd", 3), "abc…");
    EXPECT_EQ(shortened("aöö", 4), "aö…");
}

}  // namespace
}  // namespace sgm
