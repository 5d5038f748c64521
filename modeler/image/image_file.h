// Pictures that cover surfaces: PNG and JPEG files as they are, and their pixels.
// Enters: files that somebody else made. Leaves: their bytes, for files that hold them, and pixels for drawing. Assumes
// nothing: sizes are judged by the header before anything is allocated.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/core/result.h"

namespace sgm::image {

/// A picture as its file holds it.
struct ImageFile {
    enum class Kind : uint8_t { Png, Jpeg };
    std::filesystem::path path;  ///< absolute
    Kind kind = Kind::Png;
    uint32_t width = 0, height = 0;  ///< pixels
    std::string bytes;               ///< of the whole file

    /// "image/png" or "image/jpeg".
    const char* mimeType() const { return kind == Kind::Png ? "image/png" : "image/jpeg"; }
};
using ImageFilePtr = std::shared_ptr<const ImageFile>;

/// What is read at most.
struct ImageLimits {
    uint32_t mostSide = 16384;
    uint64_t mostBytes = 64ull << 20;  ///< of the file
};

/// Reads a PNG or JPEG whole and looks at its header. The error is the cause alone, for the caller to name the file.
Result<ImageFilePtr> readImageFile(const std::filesystem::path& path, const ImageLimits& limits = {},
                                   const Progress* progress = nullptr);
/// The same from bytes.
Result<ImageFilePtr> readImageBytes(std::string bytes, const ImageLimits& limits = {});

/// Row by row from the upper left corner: red, green, blue and 255, as the file's own values (sRGB where it is a
/// colour).
struct Pixels {
    uint32_t width = 0, height = 0;
    std::vector<std::array<uint8_t, 4>> rgba;
};

/// The pixels of a picture. Error::Input for a file that is damaged behind its header.
Result<Pixels> decode(const ImageFile& file);

}  // namespace sgm::image
