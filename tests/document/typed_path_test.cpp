#include "viewer/document/typed_path.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace sgm::document {
namespace {

TEST(TypedPath, TheHomeFolderHasAShortName) {
    const char* home = std::getenv("HOME");
    const std::string before = home ? home : "";
    setenv("HOME", "/home/me", 1);
    EXPECT_EQ(typedPath("~/models/a.glb"), "/home/me/models/a.glb");
    EXPECT_EQ(typedPath(" ~ "), "/home/me");
    EXPECT_EQ(typedPath("~/"), "/home/me");
    EXPECT_EQ(typedPath("~you/a"), "~you/a");
    EXPECT_EQ(typedPath("a/~b.sgm\n"), "a/~b.sgm");
    EXPECT_EQ(typedPath(" \t"), "");
    unsetenv("HOME");
    EXPECT_EQ(typedPath("~/a"), "~/a");
    if (home) setenv("HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace sgm::document
