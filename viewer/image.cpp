#include <png.h>

#include <cstdio>
#include <memory>
#include <system_error>

#include "viewer/offscreen.h"

namespace sgm::viewer {
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
    const auto fail = [&](const std::string& why) -> Status {
        return Error{Error::Kind::Input, "can't write " + path.string() + ": " + why};
    };
    if (image.width <= 0 || image.height <= 0 || image.rgb.size() != size_t(image.width) * size_t(image.height) * 3)
        return fail("the picture is empty");
    std::filesystem::path beside = path;
    beside += ".part";
    std::string why = "the disk is full or the folder can't be written";
    std::error_code error;
    std::unique_ptr<std::FILE, Close> file(std::fopen(beside.c_str(), "wb"));
    if (!file) return fail(why);
    const bool written = writeTo(file.get(), image, why);
    if (std::fclose(file.release()) != 0 || !written) {
        std::filesystem::remove(beside, error);
        return fail(why);
    }
    std::filesystem::rename(beside, path, error);
    if (error) return fail(error.message());
    return Done{};
}

}  // namespace sgm::viewer
