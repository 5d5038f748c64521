// Grammars and short cuts for the tests of the document.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "grammar/syntax/parser.h"
#include "grammar/syntax/printer.h"
#include "tests/syntax/dump.h"
#include "viewer/document/document.h"
#include "viewer/document/edits.h"

namespace sgm::viewer::testing_ {

/// Comments and odd layout everywhere, so that an edit that touches too much is seen.
inline constexpr const char* tower =
    "grammar 1\n"
    "// A tower.\n"
    "param floors = 3 in 1..9 \"Storeys\" group House key f // how many\n"
    "param lean   = .1 in 0..1.0\n"
    "param bulge  = flat of flat, round\n"
    "\n"
    "start Tower -> cube  size (4, 1, 4) : Storey   // ground\n"
    "// grows upward\n"
    "rule Up: Storey repeat floors - 1\n"
    "  -> + cube size (4 ~> 2, 1, 4) at +y /* */ : Storey\n"
    "  finally + cone on last at +y   // roof\n"
    "\n"
    "rule Wing when floors > 2 weight 2 -> cube + sphere at +x shift (0, lean, 0) // ball\n"
    "     - cylinder size 50% to centre\n"
    "     morph torus by .3\n"
    "rule Wing weight 1 -> cube,\n"
    "     sphere\n"
    "style Tall for Tower { floors = 9 }\n"
    "derive once: Up\n"
    "// the end\n";

/// Without what the language has no comment for.
inline std::string towerText() {
    std::string text = tower;
    text.replace(text.find("/* */ "), 6, "");
    return text;
}

}  // namespace sgm::viewer::testing_
