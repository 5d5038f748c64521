// Binary glTF files as their two chunks.
// Enters: a .glb file. Leaves: its JSON and its bytes, and where those bytes lie in the file. Assumes a file of one
// JSON and at most one binary chunk, as our own writer makes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm::tiles {

struct Glb {
    nlohmann::ordered_json json;
    std::vector<uint8_t> bytes;  ///< of the binary chunk, a multiple of four
    uint64_t bytesAt = 0;        ///< where they begin in the file that was read
    uint64_t fileBytes = 0;      ///< of that file
};

/// Error::Input for a file that can't be read or isn't a .glb.
Result<Glb> readGlb(const std::filesystem::path& path);
/// Writes the file, all or nothing; the length of buffer 0 becomes that of the bytes.
Status writeGlb(Glb glb, const std::filesystem::path& path);
/// Error::Input for a file of a bake that isn't as it was written: it says to remove it and bake anew.
Error damagedFile(const std::filesystem::path& path);
/// The three numbers under a key of a node, or `fallback` where it hasn't the key. Throws Json's exceptions.
Vec3d vectorOf(const nlohmann::ordered_json& node, const char* key, Vec3d fallback);
/// Writes JSON as text, all or nothing.
Status writeJson(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace sgm::tiles
