#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "modeler/core/conventions.h"
#include "modeler/town/raster_parts.h"

namespace sgm::town {
namespace {

constexpr tmsize_t mostChunk_bytes = tmsize_t{256} << 20;  // of one allocation of libtiff
constexpr uint32_t pixelScale = 33550, tiePoints = 33922, geoKeys = 34735, noData = 42113;

/// The file in memory as libtiff reads it.
struct Memory {
    const std::string& bytes;
    uint64_t at = 0;
    std::string trouble{};
};

tmsize_t readSome(thandle_t handle, void* to, tmsize_t count) {
    auto& memory = *static_cast<Memory*>(handle);
    const uint64_t left = memory.bytes.size() - std::min<uint64_t>(memory.at, memory.bytes.size());
    const auto taken = std::min<uint64_t>(left, static_cast<uint64_t>(std::max<tmsize_t>(count, 0)));
    std::memcpy(to, memory.bytes.data() + (memory.bytes.size() - left), taken);
    memory.at += taken;
    return static_cast<tmsize_t>(taken);
}
tmsize_t writeNothing(thandle_t, void*, tmsize_t) { return 0; }
toff_t seekTo(thandle_t handle, toff_t to, int from) {
    auto& memory = *static_cast<Memory*>(handle);
    memory.at = from == SEEK_SET ? to : from == SEEK_CUR ? memory.at + to : memory.bytes.size() + to;
    return memory.at;
}
int closeNothing(thandle_t) { return 0; }
toff_t sizeOf(thandle_t handle) { return static_cast<Memory*>(handle)->bytes.size(); }

/// Keeps the first error for the message; without it libtiff would print.
int noteError(TIFF*, void* data, const char*, const char* format, va_list arguments) {
    auto& memory = *static_cast<Memory*>(data);
    char text[256];
    if (memory.trouble.empty() && std::vsnprintf(text, sizeof text, format, arguments) > 0) memory.trouble = text;
    return 1;
}
int dropWarning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

/// A TIFF opened in memory, closed at the end.
class File {
public:
    explicit File(Memory& memory) {
        TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
        TIFFOpenOptionsSetMaxSingleMemAlloc(options, mostChunk_bytes);
        TIFFOpenOptionsSetErrorHandlerExtR(options, noteError, &memory);
        TIFFOpenOptionsSetWarningHandlerExtR(options, dropWarning, &memory);
        tiff_ = TIFFClientOpenExt("map", "rm", &memory, readSome, writeNothing, seekTo, closeNothing, sizeOf, nullptr,
                                  nullptr, options);
        TIFFOpenOptionsFree(options);
    }
    ~File() {
        if (tiff_) TIFFClose(tiff_);
    }
    File(const File&) = delete;
    TIFF* get() const { return tiff_; }

    template <class T>
    T value(uint32_t tag, T fallback) const {
        T found = fallback;
        return TIFFGetFieldDefaulted(tiff_, tag, &found) ? found : fallback;
    }
    /// The numbers of a tag that libtiff has no name for.
    template <class T>
    std::vector<T> list(uint32_t tag, TIFFDataType type) const {
        const TIFFField* field = TIFFFindField(tiff_, tag, type);
        if (!field || TIFFFieldDataType(field) != type || !TIFFFieldPassCount(field)) return {};
        void* data = nullptr;
        uint32_t count = 0;
        if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
            if (!TIFFGetField(tiff_, tag, &count, &data)) return {};
        } else {
            uint16_t few = 0;
            if (!TIFFGetField(tiff_, tag, &few, &data)) return {};
            count = few;
        }
        if (!data) return {};
        const T* begin = static_cast<const T*>(data);
        return {begin, begin + count};
    }

private:
    TIFF* tiff_ = nullptr;
};

struct Layout {
    uint32_t width = 0, height = 0;
    uint16_t bits = 0, samples = 0, format = 0, planar = 0, photometric = 0;
    bool isColour() const { return samples >= 3 && bits == 8 && format == SAMPLEFORMAT_UINT; }
    bool hasNumbers() const { return format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_IEEEFP || bits == 32; }
};

/// One sample as a number.
double sampleAt(const unsigned char* at, const Layout& layout) {
    const auto as = [&](auto like) {
        std::memcpy(&like, at, sizeof like);
        return static_cast<double>(like);
    };
    const bool isSigned = layout.format == SAMPLEFORMAT_INT;
    if (layout.format == SAMPLEFORMAT_IEEEFP) return layout.bits == 64 ? as(double{}) : as(float{});
    if (layout.bits == 8) return isSigned ? as(int8_t{}) : as(uint8_t{});
    if (layout.bits == 16) return isSigned ? as(int16_t{}) : as(uint16_t{});
    return isSigned ? as(int32_t{}) : as(uint32_t{});
}

/// Calls take(x, y, first byte) with the first sample of every pixel; false where the file is damaged.
template <class Take>
bool eachPixel(const File& file, const Layout& layout, Take&& take) {
    TIFF* tiff = file.get();
    const size_t stride = size_t{layout.bits} / 8 * (layout.planar == PLANARCONFIG_CONTIG ? layout.samples : 1u);
    const auto line = [&](const unsigned char* from, uint32_t x, uint32_t y, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) take(x + i, y, from + i * stride);
    };
    if (TIFFIsTiled(tiff)) {
        const auto w = file.value<uint32_t>(TIFFTAG_TILEWIDTH, 0), h = file.value<uint32_t>(TIFFTAG_TILELENGTH, 0);
        const uint64_t size = TIFFTileSize64(tiff);
        if (w == 0 || h == 0 || size < uint64_t{w} * h * stride || size > static_cast<uint64_t>(mostChunk_bytes))
            return false;
        std::vector<unsigned char> tile(size);
        for (uint32_t y = 0; y < layout.height; y += h)
            for (uint32_t x = 0; x < layout.width; x += w) {
                if (TIFFReadTile(tiff, tile.data(), x, y, 0, 0) < 0) return false;
                for (uint32_t k = 0; k < std::min(h, layout.height - y); ++k)
                    line(tile.data() + size_t{k} * w * stride, x, y + k, std::min(w, layout.width - x));
            }
        return true;
    }
    const uint64_t size = TIFFScanlineSize64(tiff);
    if (size < layout.width * stride || size > static_cast<uint64_t>(mostChunk_bytes)) return false;
    std::vector<unsigned char> row(size);
    for (uint32_t y = 0; y < layout.height; ++y) {
        if (TIFFReadScanline(tiff, row.data(), y, 0) < 0) return false;
        line(row.data(), 0, y, layout.width);
    }
    return true;
}

/// The ground that GeoTIFF's tags say: pixels of metres, feet or degrees.
std::optional<plan::Vec2> extentOf(const File& file, const Layout& layout) {
    constexpr uint16_t modelType = 1024, linearUnits = 3076, geographic = 2, foot = 9002, surveyFoot = 9003;
    const auto scale = file.list<double>(pixelScale, TIFF_DOUBLE), ties = file.list<double>(tiePoints, TIFF_DOUBLE);
    const auto keys = file.list<uint16_t>(geoKeys, TIFF_SHORT);
    if (scale.size() < 2 || !(scale[0] > 0) || !(scale[1] > 0)) return std::nullopt;
    uint16_t model = 0, unit = 0;
    for (size_t i = 4; i + 3 < keys.size(); i += 4) {
        if (keys[i] == modelType) model = keys[i + 3];
        if (keys[i] == linearUnits) unit = keys[i + 3];
    }
    plan::Vec2 metres{1, 1};
    if (model == geographic) {
        // The series of the WGS84 ellipsoid at the middle of the picture, as for outlines in degrees.
        const double top = ties.size() >= 6 ? ties[4] + ties[1] * scale[1] : 0;
        const double at = radians(top - scale[1] * layout.height / 2);
        metres = {111412.84 * std::cos(at) - 93.5 * std::cos(3 * at) + 0.118 * std::cos(5 * at),
                  111132.92 - 559.82 * std::cos(2 * at) + 1.175 * std::cos(4 * at)};
    } else if (unit == foot || unit == surveyFoot) {
        metres = unit == foot ? plan::Vec2{.3048, .3048} : plan::Vec2{1200. / 3937, 1200. / 3937};
    }
    const plan::Vec2 size{scale[0] * metres.x * layout.width, scale[1] * metres.z * layout.height};
    const bool isSound = size.x > 0 && size.z > 0 && size.x < 1e8 && size.z < 1e8;
    return isSound ? std::optional(size) : std::nullopt;
}

/// The number that stands for no data, GDAL's tag.
std::optional<double> noDataOf(const File& file) {
    const auto text = file.list<char>(noData, TIFF_ASCII);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} ? std::optional(value) : std::nullopt;
}

Result<Layout> layoutOf(const File& file, const RasterLimits& limits) {
    Layout out;
    out.width = file.value<uint32_t>(TIFFTAG_IMAGEWIDTH, 0), out.height = file.value<uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    if (const Status judged = judgeSize(out.width, out.height, limits); !judged.ok()) return judged.error();
    out.bits = file.value<uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    out.samples = file.value<uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    out.format = file.value<uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    out.planar = file.value<uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    out.photometric = file.value<uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    const bool isNumber = out.format == SAMPLEFORMAT_IEEEFP
                              ? out.bits == 32 || out.bits == 64
                              : (out.format == SAMPLEFORMAT_UINT || out.format == SAMPLEFORMAT_INT) &&
                                    (out.bits == 8 || out.bits == 16 || out.bits == 32);
    const bool isPlain = out.photometric == PHOTOMETRIC_MINISBLACK || out.photometric == PHOTOMETRIC_MINISWHITE ||
                         out.photometric == PHOTOMETRIC_RGB;
    if (!isNumber || !isPlain || out.samples == 0 || out.samples > 16 ||
        (out.isColour() && out.planar != PLANARCONFIG_CONTIG))
        return Error{
            Error::Kind::Input,
            fmt::format("its pixels of {} samples of {} bits can't be read: save it as grey of 8 or 16 bits, as "
                        "RGB of 8, or as floats",
                        out.samples, out.bits)};
    return out;
}

}  // namespace

bool isTiff(const std::string& bytes) {
    return bytes.size() > 8 &&
           (bytes.starts_with(std::string("II*\0", 4)) || bytes.starts_with(std::string("MM\0*", 4)) ||
            bytes.starts_with(std::string("II+\0", 4)) || bytes.starts_with(std::string("MM\0+", 4)));
}

Result<RasterPtr> readTiff(const std::string& bytes, const RasterLimits& limits) {
    Memory memory{bytes};
    const auto damaged = [&] {
        return Error{
            Error::Kind::Input,
            fmt::format("it is damaged: {}", memory.trouble.empty() ? "its pixels can't be read" : memory.trouble)};
    };
    const File file(memory);
    if (!file.get()) return damaged();
    const auto layout = layoutOf(file, limits);
    if (!layout.ok()) return layout.error();
    auto out = std::make_shared<Raster>();
    out->width = layout->width, out->height = layout->height;
    const size_t count = size_t{out->width} * out->height;
    const auto none = noDataOf(file);
    (layout->hasNumbers() ? out->numbers.resize(count) : out->grey.resize(count));
    if (!layout->hasNumbers()) out->color.resize(count);
    const bool inverted = layout->photometric == PHOTOMETRIC_MINISWHITE;
    const bool read = eachPixel(file, *layout, [&](uint32_t x, uint32_t y, const unsigned char* at) {
        const size_t p = size_t{y} * out->width + x;
        if (layout->isColour()) {
            out->color[p] = {at[0], at[1], at[2]};
            out->grey[p] = lumaOf(out->color[p]);
            return;
        }
        const double v = sampleAt(at, *layout);
        if (layout->hasNumbers()) {
            const auto number = static_cast<float>(v);
            out->numbers[p] = std::isfinite(number) && v != none ? number : 0;
            return;
        }
        const auto grey = static_cast<uint16_t>(layout->bits == 8 ? v * 257 : v);
        out->grey[p] = inverted ? static_cast<uint16_t>(65535 - grey) : grey;
        const auto byte = static_cast<uint8_t>(out->grey[p] >> 8);
        out->color[p] = {byte, byte, byte};
    });
    if (!read) return damaged();
    out->extent_m = extentOf(file, *layout);
    return RasterPtr(std::move(out));
}

}  // namespace sgm::town
