// The page of a baked city: index.html and the script that draws it, which lie beside the tileset.
// Enters: nothing. Leaves: two files. Assumes that a server shows the folder, for browsers read no tiles from disks.
#pragma once

#include <filesystem>
#include <string_view>

#include "modeler/core/result.h"

namespace sgm::tiles {

/// The texts, from integrations/city_page.
std::string_view pageText();
std::string_view pageScript();
/// Writes both into the folder.
Status writePage(const std::filesystem::path& folder);

}  // namespace sgm::tiles
