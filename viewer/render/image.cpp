#include <png.h>

#include <cerrno>
#include <cstdio>
#include <memory>

#include "modeler/core/atomic_file.h"
#include "viewer/render/picture.h"

namespace sgm::render {
namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// libpng's simplified API: no jumps, one error text.
bool writeTo(std::FILE* file, const Image& image, std::string& why) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_stdio(&png, file, 0, image.rgb.data(), 0, nullptr)) {
        why = png.message;
        return false;
    }
    return std::fflush(file) == 0;
}

}  // namespace

Status writePng(const Image& image, const std::filesystem::path& path) {
    if (image.width <= 0 || image.height <= 0 || image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
        return writeError(path, "the picture is empty");
    return replaceFile(path, [&](const std::filesystem::path& temporary) -> Status {
        std::string why = "the disk is full or the folder can't be written";
        std::unique_ptr<std::FILE, Close> file(std::fopen(temporary.c_str(), "wb"));
        if (!file) return writeError(path, errno);
        const bool written = writeTo(file.get(), image, why);
        return std::fclose(file.release()) == 0 && written ? Status(Done{}) : Status(writeError(path, why));
    });
}

}  // namespace sgm::render
