// Files of a baked city as what they were written from, for those who make other formats of them.
// Enters: .glb files of cells and of the library. Leaves: content in metres. Assumes files that writeCell and
// writeObject made; packed positions and normals come back rounded as they are stored, skirts don't come back.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "modeler/tiles/cell_content.h"

namespace sgm::tiles {

/// A cell with the places that its objects point at.
struct ReadCell {
    CellContent content;     ///< centre and grid are unset, for a file doesn't hold them
    std::deque<Part> parts;  ///< path, rule, file, line and pose of each place
};

/// Error::Input for a file that can't be read or isn't of a library.
Result<LibraryObject> readObject(const std::filesystem::path& path);
/// Objects are named as in the file: relative to it, with the paths that follow. Error::Input likewise.
Result<ReadCell> readCell(const std::filesystem::path& path, Library& library);

/// The box of a cell's ground about the cell's centre, as its file says; nothing where it has none. Error::Input
/// likewise.
Result<std::optional<Box3d>> groundBounds(const std::filesystem::path& path);

}  // namespace sgm::tiles
