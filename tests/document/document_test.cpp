// The document: history, drags, typing, its file and other programs.
#include "viewer/document/document.h"

#include <fstream>

#include "tests/document/texts.h"
#include "viewer/document/files.h"

namespace sgm::viewer {
namespace {

TEST(Documents, Begin) { EXPECT_EQ(Document().text(), "grammar 1\n"); }

}  // namespace
}  // namespace sgm::viewer
