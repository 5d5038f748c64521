// What shapes report, as rows that a panel shows.
// Enters: a derivation. Leaves: names and texts. Assumes nothing.
#pragma once

#include <string>
#include <vector>

#include "grammar/derive/derive.h"

namespace sgm::document {

/// One word that shapes report under.
struct ReportRow {
    std::string name;
    std::string sum;      ///< with its unit, "1204 m²"
    std::string details;  ///< how many reported, the least and the greatest
};

/// A row a word, in the order of the text. O(shapes) for each.
std::vector<ReportRow> reportRows(const derive::Derivation& derivation);

}  // namespace sgm::document
