// Grammars and short cuts for the tests of the document.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "grammar/operations/operations.h"
#include "grammar/syntax/parser.h"
#include "grammar/syntax/printer.h"
#include "tests/syntax/dump.h"
#include "viewer/document/document.h"
#include "viewer/document/edits.h"

namespace sgm::document {

/// Comments and odd layout everywhere, so that an edit that touches too much is seen.
inline constexpr const char* tower =
    "grammar 1\n"
    "// A tower.\n"
    "param floors = 3 in 1..9 \"Storeys\" group House key f // how many\n"
    "param lean   = .1 in 0..1.0\n"
    "param bulge  = flat of flat, round\n"
    "\n"
    "start Tower -> cube  size (4, 1, 4) : Storey   // ground\n"
    "\n"
    "// grows upward\n"
    "rule Up: Storey repeat floors - 1\n"
    "  -> + cube size (4 ~> 2, 1, 4) at +y : Storey\n"
    "  finally + cone on last at +y : Wing   // roof\n"
    "\n"
    "rule Wing when floors > 2   weight 2 -> cube + sphere at +x shift (0, lean, 0) // ball\n"
    "     - cylinder size 50% at +z to centre // hole\n"
    "     morph torus by .3\n"
    "rule Wing weight 1 -> cube when bulge == round { + cone at +y },\n"
    "     sphere\n"
    "style Tall for Tower { floors = 9 }\n"
    "derive once: Up\n"
    "// the end\n";

/// `text` with the only `from` replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "no '" << from << "'";
    EXPECT_EQ(text.find(from, at + 1), std::string::npos) << "'" << from << "' twice";
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline syntax::Ast parsed(const std::string& text) {
    syntax::Diagnostics problems;
    syntax::Ast ast =
        syntax::parse(std::make_shared<const syntax::Source>("t.sgm", text), operations::table(), problems);
    for (const auto& d : problems.all()) ADD_FAILURE() << syntax::render(d);
    return ast;
}

inline std::string meaning(const syntax::Ast& ast) { return syntax::Dump(ast).text(); }

}  // namespace sgm::document
