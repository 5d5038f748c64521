#include "modeler/town/raster.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "modeler/core/regular_file.h"
#include "modeler/town/raster_parts.h"

namespace sgm::town {
namespace {

/// Width and height as the header says them, the first chunk of every PNG.
struct Header {
    uint64_t width = 0, height = 0;
    int depth = 0, colorType = 0;
};

Result<Header> headerOf(const std::string& bytes) {
    constexpr size_t headerBytes = 33;
    const auto* b = reinterpret_cast<const unsigned char*>(bytes.data());
    if (bytes.size() < headerBytes || png_sig_cmp(b, 0, 8) != 0 || bytes.compare(12, 4, "IHDR") != 0)
        return Error{Error::Kind::Input, "it is no picture: PNG, TIFF and OpenEXR files are read"};
    const auto number = [&](size_t at) {
        return uint64_t{b[at]} << 24 | uint64_t{b[at + 1]} << 16 | uint64_t{b[at + 2]} << 8 | b[at + 3];
    };
    return Header{number(16), number(20), b[24], b[25]};
}

/// libpng's simplified API, closed at the end.
struct Reader {
    png_image png{};
    Reader() { png.version = PNG_IMAGE_VERSION; }
    ~Reader() { png_image_free(&png); }
    Reader(const Reader&) = delete;
};

Status readInto(const std::string& bytes, png_uint_32 format, void* pixels) {
    Reader reader;
    const auto fail = [&] { return Error{Error::Kind::Input, fmt::format("it is damaged: {}", reader.png.message)}; };
    if (!png_image_begin_read_from_memory(&reader.png, bytes.data(), bytes.size())) return fail();
    reader.png.format = format;
    const png_color white{255, 255, 255};
    if (!png_image_finish_read(&reader.png, &white, pixels, 0, nullptr)) return fail();
    return Done{};
}

/// 16-bit grey values are linear there; without a gAMA chunk libpng takes them as such and leaves them as they are.
Status readGrey(const std::string& bytes, const Header& header, Raster& out) {
    const size_t count = static_cast<size_t>(header.width * header.height);
    out.grey.resize(count);
    if (header.depth == 16 && (header.colorType & PNG_COLOR_MASK_COLOR) == 0)
        return readInto(bytes, PNG_FORMAT_LINEAR_Y, out.grey.data());
    for (size_t i = 0; i < count; ++i) {
        const auto& c = out.color[i];
        out.grey[i] = lumaOf(c);
    }
    return Done{};
}

}  // namespace

double Raster::greyAt(double u, double v) const {
    const double x = std::clamp(u * width - .5, 0.0, width - 1.0), y = std::clamp(v * height - .5, 0.0, height - 1.0);
    const auto x0 = static_cast<size_t>(x), y0 = static_cast<size_t>(y);
    const size_t x1 = std::min<size_t>(x0 + 1, width - 1), y1 = std::min<size_t>(y0 + 1, height - 1);
    const double s = x - static_cast<double>(x0), t = y - static_cast<double>(y0);
    const auto at = [&](size_t i, size_t k) {
        return numbers.empty() ? grey[k * width + i] / 65535.0 : double{numbers[k * width + i]};
    };
    return (at(x0, y0) * (1 - s) + at(x1, y0) * s) * (1 - t) + (at(x0, y1) * (1 - s) + at(x1, y1) * s) * t;
}

std::array<uint8_t, 3> Raster::colorAt(double u, double v) const {
    const double x = std::clamp(u * width, 0.0, width - 1.0), y = std::clamp(v * height, 0.0, height - 1.0);
    const size_t at = static_cast<size_t>(y) * width + static_cast<size_t>(x);  // rounded down
    if (!color.empty()) return color[at];
    const auto byte = static_cast<uint8_t>(std::clamp(numbers[at], 0.f, 1.f) * 255 + .5f);
    return {byte, byte, byte};
}

Status judgeSize(uint64_t width, uint64_t height, const RasterLimits& limits) {
    if (width == 0 || height == 0) return Error{Error::Kind::Input, "it has no pixels"};
    if (width > limits.mostSide || height > limits.mostSide || width * height > limits.mostPixels)
        return Error{Error::Kind::Budget,
                     fmt::format("its {} x {} pixels are more than {} a side or {} in all: make it smaller", width,
                                 height, limits.mostSide, limits.mostPixels)};
    return Done{};
}

/// In thousandths of the weights.
uint16_t lumaOf(const std::array<uint8_t, 3>& c) {
    return static_cast<uint16_t>((213 * c[0] + 715 * c[1] + 72 * c[2]) * 257 / 1000);
}

Result<RasterPtr> readRasterBytes(const std::string& bytes, const RasterLimits& limits) {
    return isExr(bytes) ? readExr(bytes, limits) : isTiff(bytes) ? readTiff(bytes, limits) : readPng(bytes, limits);
}

Result<RasterPtr> readPng(const std::string& bytes, const RasterLimits& limits) {
    const auto header = headerOf(bytes);
    if (!header.ok()) return header.error();
    if (const Status judged = judgeSize(header->width, header->height, limits); !judged.ok()) return judged.error();
    auto out = std::make_shared<Raster>();
    out->width = static_cast<uint32_t>(header->width), out->height = static_cast<uint32_t>(header->height);
    out->color.resize(static_cast<size_t>(header->width * header->height));
    if (const Status read = readInto(bytes, PNG_FORMAT_RGB, out->color.data()); !read.ok()) return read.error();
    if (const Status read = readGrey(bytes, *header, *out); !read.ok()) return read.error();
    return RasterPtr(std::move(out));
}

Result<RasterPtr> readRaster(const std::filesystem::path& path, const RasterLimits& limits, const Progress* progress) {
    const auto bytes = readRegularFile(path, limits.mostBytes, progress);
    if (!bytes.ok()) return bytes.error();
    return readRasterBytes(*bytes, limits);
}

}  // namespace sgm::town
