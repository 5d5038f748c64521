// Where the program and the library lie, to find what is installed beside them.
// Enters: nothing. Leaves: folders. Assumes Linux.
#pragma once

#include <filesystem>
#include <vector>

namespace sgm {

/// The folders of the running program and of the binary that holds this function, which is libsgm.so where a program is
/// linked to that; each once.
std::vector<std::filesystem::path> binaryFolders();

}  // namespace sgm
