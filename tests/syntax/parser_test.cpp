// The parser on good input: the language's sketch, and what its nodes hold.
#include "grammar/syntax/parser.h"

#include <gtest/gtest.h>

#include "tests/syntax/read.h"

namespace sgm::syntax {
namespace {

TEST(Parser, SketchParsesWithoutDiagnostics) {
    Diagnostics diagnostics;
    const Ast ast = parse(readSource("tests/syntax/sketch.sgm"), diagnostics);
    EXPECT_EQ(renderAll(diagnostics), "");
    EXPECT_EQ(ast.params.size(), 9u);
}

}  // namespace
}  // namespace sgm::syntax
