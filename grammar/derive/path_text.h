// Paths in a shape tree as texts.
// Enters: the shapes from one up to the root, and what each is called. Leaves: "Cave/Cell[3]". Assumes nothing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/derive/shapes.h"

namespace sgm::derive {

/// Parts of a very deep path that are told at either end.
inline constexpr size_t shownPathParts = 12;

/// A shape's part of a path.
struct PathPart {
    std::string_view label;
    uint32_t occurrence = 1;  ///< among the children of its parent that have the label; told from 2 on
};

/// The path of the first of `up`, the last of which is the root; of deeper ones `shown` parts at either end.
/// `partOf` gives the PathPart of a shape. O(shapes).
template <class PartOf>
std::string pathText(const std::vector<ShapeId>& up, size_t shown, const PartOf& partOf) {
    std::string text;
    for (size_t depth = 0; depth < up.size(); ++depth) {
        const size_t below = up.size() - 1 - depth;
        if (depth >= shown && below >= shown) continue;
        if (depth > 0) text += '/';
        if (depth > shown && below == shown - 1) text += "…/";
        const PathPart part = partOf(up[below]);
        text += part.label;
        if (part.occurrence > 1) text += '[' + std::to_string(part.occurrence) + ']';
    }
    return text;
}

}  // namespace sgm::derive
