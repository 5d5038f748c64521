// The page that a .html is, written by embed_page.cmake from page/.
// Enters: nothing. Leaves: the text, with the places of a title and of packed data.
#pragma once

#include <string_view>

namespace sgm::exporter {

/// The page with @TITLE@ (twice) where its title goes and @DATA@ where base64 of packPage's bytes goes.
std::string_view pageText();

}  // namespace sgm::exporter
