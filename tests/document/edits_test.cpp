// Every verb: what it does to the text, and that nothing else moves.
#include "viewer/document/edits.h"

#include "tests/document/texts.h"

namespace sgm::viewer {
namespace {

TEST(Edits, Begin) {}

}  // namespace
}  // namespace sgm::viewer
