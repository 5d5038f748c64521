// The file that a user means by what was typed or pasted into a field.
// Enters: text. Leaves: a path. Assumes nothing.
#pragma once

#include <filesystem>
#include <string_view>

namespace sgm::document {

/// `text` without blanks around it, where "~" and "~/…" stand for the home folder (`HOME`) as in a shell. Homes of
/// other users ("~name") stay as they are written.
std::filesystem::path typedPath(std::string_view text);

}  // namespace sgm::document
