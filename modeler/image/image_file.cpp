#include "modeler/image/image_file.h"

#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <jpeglib.h>
#include <png.h>

#include "modeler/core/regular_file.h"

namespace sgm::image {
namespace {

Error damaged() { return Error{Error::Kind::Input, "the picture is damaged"}; }

/// libpng's own reading of a whole picture, which frees what it holds.
class PngReader {
public:
    explicit PngReader(const std::string& bytes) {
        image_.version = PNG_IMAGE_VERSION;
        open_ = png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size()) != 0;
    }
    ~PngReader() { png_image_free(&image_); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    bool isOpen() const { return open_; }
    uint32_t width() const { return image_.width; }
    uint32_t height() const { return image_.height; }
    /// What is see-through shows white.
    bool read(std::vector<std::array<uint8_t, 4>>& rgba) {
        std::vector<uint8_t> rgb(3 * size_t{image_.width} * image_.height);
        image_.format = PNG_FORMAT_RGB;
        const png_color white{255, 255, 255};
        if (png_image_finish_read(&image_, &white, rgb.data(), 0, nullptr) == 0) return false;
        rgba.resize(rgb.size() / 3);
        for (size_t i = 0; i < rgba.size(); ++i) rgba[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 255};
        return true;
    }

private:
    png_image image_{};
    bool open_ = false;
};

/// libjpeg leaves by longjmp after an error, and would print its warnings.
struct JpegErrors {
    jpeg_error_mgr manager;
    std::jmp_buf leave;
};

void leave(j_common_ptr info) { std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->leave, 1); }
void sayNothing(j_common_ptr) {}

/// Fills width and height, and the pixels where they are wanted; no object with a destructor lives across a longjmp.
bool readJpeg(const std::string& bytes, uint32_t& width, uint32_t& height, std::vector<std::array<uint8_t, 4>>* rgba,
              std::vector<uint8_t>& row) {
    jpeg_decompress_struct info;
    JpegErrors errors;
    info.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = leave;
    errors.manager.output_message = sayNothing;
    if (setjmp(errors.leave) != 0) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&info, TRUE);
    width = info.image_width, height = info.image_height;
    if (rgba) {
        info.out_color_space = JCS_RGB;
        jpeg_start_decompress(&info);
        row.resize(3 * size_t{info.output_width});
        rgba->clear();
        while (info.output_scanline < info.output_height) {
            unsigned char* line = row.data();
            jpeg_read_scanlines(&info, &line, 1);
            for (size_t x = 0; x < info.output_width; ++x)
                rgba->push_back({row[3 * x], row[3 * x + 1], row[3 * x + 2], 255});
        }
        jpeg_finish_decompress(&info);
    }
    const bool whole = errors.manager.num_warnings == 0;
    jpeg_destroy_decompress(&info);
    return whole;
}

bool isPng(const std::string& bytes) {
    return bytes.size() > 8 && std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) == 0;
}
bool isJpeg(const std::string& bytes) { return bytes.size() > 3 && std::memcmp(bytes.data(), "\xff\xd8\xff", 3) == 0; }

}  // namespace

Result<ImageFilePtr> readImageBytes(std::string bytes, const ImageLimits& limits) {
    auto file = std::make_shared<ImageFile>();
    if (isPng(bytes)) {
        const PngReader reader(bytes);
        if (!reader.isOpen()) return damaged();
        file->width = reader.width(), file->height = reader.height();
    } else if (isJpeg(bytes)) {
        file->kind = ImageFile::Kind::Jpeg;
        std::vector<uint8_t> row;
        if (!readJpeg(bytes, file->width, file->height, nullptr, row)) return damaged();
    } else {
        return Error{Error::Kind::Input, "it is no picture: a texture is a .png or .jpg"};
    }
    if (file->width > limits.mostSide || file->height > limits.mostSide)
        return Error{Error::Kind::Budget, fmt::format("the picture has {} x {} pixels, and at most {} a side are read",
                                                      file->width, file->height, limits.mostSide)};
    file->bytes = std::move(bytes);
    return ImageFilePtr(std::move(file));
}

Result<ImageFilePtr> readImageFile(const std::filesystem::path& path, const ImageLimits& limits,
                                   const Progress* progress) {
    Result<std::string> bytes = readRegularFile(path, limits.mostBytes, progress);
    if (!bytes.ok()) return bytes.error();
    auto file = readImageBytes(std::move(*bytes), limits);
    if (!file.ok()) return file.error();
    auto named = std::make_shared<ImageFile>(**file);
    std::error_code failed;
    named->path = std::filesystem::weakly_canonical(path, failed);
    return ImageFilePtr(std::move(named));
}

Result<Pixels> decode(const ImageFile& file) {
    Pixels pixels;
    pixels.width = file.width, pixels.height = file.height;
    bool whole = false;
    if (file.kind == ImageFile::Kind::Png) {
        PngReader reader(file.bytes);
        whole = reader.isOpen() && reader.read(pixels.rgba);
    } else {
        std::vector<uint8_t> row;
        whole = readJpeg(file.bytes, pixels.width, pixels.height, &pixels.rgba, row);
    }
    if (!whole || pixels.rgba.size() != size_t{file.width} * file.height)
        return Error{Error::Kind::Input, fmt::format("'{}': the picture is damaged", file.path.filename().string())};
    return pixels;
}

}  // namespace sgm::image
