// Words for the edges of a footprint.
// Enters: an edge and a word. Leaves: whether it is called so. Assumes tags of several words are separated by blanks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "modeler/plan/polygon.h"

namespace sgm::plan {

/// Words that edges are called by without a tag.
inline constexpr std::string_view commonEdgeWords[] = {"side",  "front", "back", "left",
                                                       "right", "court", "cut",  "rest"};
bool isCommonEdgeWord(std::string_view word);

/// front (+z), back, left, right by its normal, side and rest for every edge, court, cut, or one of the words of its
/// tag.
bool isEdgeCalled(const Footprint& footprint, const PlacedEdge& edge, std::string_view word);

/// The words that an edge alone is called by, besides side and rest: front, court, those of its tag.
std::vector<std::string> edgeWords(const Footprint& footprint, const PlacedEdge& edge);

}  // namespace sgm::plan
