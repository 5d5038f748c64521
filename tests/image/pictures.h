// Small pictures in memory, as files hold them.
// Enters: pixels. Leaves: the bytes of a PNG or JPEG. Assumes they fit each other.
#pragma once

#include <png.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <jpeglib.h>

namespace sgm::image {

/// A PNG of red, green and blue bytes, row by row.
inline std::string pngOf(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgb) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = width, png.height = height, png.format = PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = bytes.size();
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0) return {};
    bytes.resize(size);
    return bytes;
}

/// A JPEG of the best quality.
inline std::string jpegOf(uint32_t width, uint32_t height, std::vector<uint8_t> rgb) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &data, &size);
    info.image_width = width, info.image_height = height, info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    jpeg_start_compress(&info, TRUE);
    for (uint32_t y = 0; y < height; ++y) {
        unsigned char* row = rgb.data() + 3 * size_t{y} * width;
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    std::string bytes(reinterpret_cast<char*>(data), size);
    std::free(data);
    return bytes;
}

}  // namespace sgm::image
