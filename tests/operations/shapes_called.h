// The shapes of a derivation by the name of their symbol.
// Enters: a derivation. Leaves: its shapes, in the order of the tree's table. Assumes it outlives them.
#pragma once

#include <string>
#include <vector>

#include "grammar/derive/derive.h"

namespace sgm::testing_ {

inline std::vector<derive::Shape> shapesCalled(const derive::Derivation& d, const std::string& symbol) {
    std::vector<derive::Shape> found;
    for (const derive::Shape& s : d.tree.shapes)
        if (s.symbol != rules::none && d.grammar->symbols[s.symbol].name == symbol) found.push_back(s);
    return found;
}

}  // namespace sgm::testing_
