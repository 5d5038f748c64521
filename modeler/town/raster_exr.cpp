#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>

#include "modeler/town/raster_parts.h"

namespace sgm::town {
namespace {

constexpr int mostChannels = 16;
constexpr uint64_t mostTile = 4096;  // pixels along a side
constexpr unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};

/// Little-endian numbers from a text, with its end in view.
class Bytes {
public:
    explicit Bytes(const std::string& bytes, size_t at) : bytes_(bytes), at_(at) {}
    bool has(uint64_t count) const { return count <= bytes_.size() - at_; }
    uint32_t number() {
        uint32_t v = 0;
        for (int i = 0; i < 4 && has(1); ++i) v |= uint32_t{static_cast<unsigned char>(bytes_[at_++])} << (8 * i);
        return v;
    }
    /// Up to the next zero byte.
    std::string word() {
        const size_t end = std::min(bytes_.find('\0', at_), bytes_.size());
        std::string text = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        return text;
    }
    size_t at() const { return at_; }
    void skip(uint64_t count) { at_ += static_cast<size_t>(std::min<uint64_t>(count, bytes_.size() - at_)); }

private:
    const std::string& bytes_;
    size_t at_;
};

/// The header's attributes that decide how much is allocated; OpenEXR itself would allocate first.
Status judgeHeader(const std::string& bytes, const RasterLimits& limits) {
    const auto refused = [](const char* why) { return Error{Error::Kind::Input, why}; };
    Bytes in(bytes, 4);
    const uint32_t version = in.number();
    if (version & 0x1800) return refused("it is a deep or multi-part OpenEXR file: save one flat picture");
    bool sized = false;
    while (true) {
        const std::string name = in.word();
        if (name.empty()) break;
        const std::string type = in.word();
        const uint32_t size = in.number();
        if (!in.has(size)) return refused("it is damaged: its header ends early");
        Bytes value(bytes, in.at());
        if (type == "box2i" && name == "dataWindow" && size == 16) {
            const auto side = [&] { return int64_t{static_cast<int32_t>(value.number())}; };
            const int64_t x0 = side(), y0 = side(), x1 = side(), y1 = side();
            if (x1 < x0 || y1 < y0) return refused("it has no pixels");
            const Status judged =
                judgeSize(static_cast<uint64_t>(x1 - x0) + 1, static_cast<uint64_t>(y1 - y0) + 1, limits);
            if (!judged.ok()) return judged.error();
            sized = true;
        } else if (type == "chlist") {
            int count = 0;
            while (value.at() < in.at() + size && !value.word().empty()) value.skip(16), ++count;
            if (count > mostChannels) return refused("it has more than 16 channels: save the one that is the map");
        } else if (type == "tiledesc") {
            const uint64_t x = value.number(), y = value.number();
            if (x == 0 || y == 0 || x > mostTile || y > mostTile)
                return refused("it is damaged: its tiles are too large");
        }
        in.skip(size);
    }
    if (!sized) return refused("it is damaged: its header has no size");
    return Done{};
}

class MemoryStream : public Imf::IStream {
public:
    explicit MemoryStream(const std::string& bytes) : Imf::IStream("map"), bytes_(bytes) {}
    bool read(char* to, int count) override {
        if (count < 0 || static_cast<size_t>(count) > bytes_.size() - at_) throw std::runtime_error("it ends early");
        std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
        at_ += static_cast<size_t>(count);
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t at) override { at_ = static_cast<size_t>(std::min<uint64_t>(at, bytes_.size())); }

private:
    const std::string& bytes_;
    size_t at_ = 0;
};

/// Channels that make the map, and the weight of each.
std::vector<std::pair<std::string, float>> channelsOf(const Imf::ChannelList& list) {
    if (list.findChannel("Y")) return {{"Y", 1.f}};
    if (list.findChannel("R") && list.findChannel("G") && list.findChannel("B"))
        return {{"R", .2126f}, {"G", .7152f}, {"B", .0722f}};
    for (auto c = list.begin(); c != list.end(); ++c)
        if (std::string(c.name()) != "A") return {{c.name(), 1.f}};
    return {};
}

Result<RasterPtr> readPixels(const std::string& bytes) {
    MemoryStream stream(bytes);
    Imf::InputFile file(stream, 1);
    const Imath::Box2i window = file.header().dataWindow();
    auto out = std::make_shared<Raster>();
    out->width = static_cast<uint32_t>(window.max.x - window.min.x + 1);
    out->height = static_cast<uint32_t>(window.max.y - window.min.y + 1);
    const size_t count = size_t{out->width} * out->height;
    const auto channels = channelsOf(file.header().channels());
    if (channels.empty()) return Error{Error::Kind::Input, "it has no channel but alpha"};
    for (const auto& [name, weight] : channels) {
        const Imf::Channel* channel = file.header().channels().findChannel(name.c_str());
        if (channel->xSampling != 1 || channel->ySampling != 1)
            return Error{Error::Kind::Input, "its channels are subsampled: save it at full resolution"};
    }
    out->numbers.assign(count, 0);
    std::vector<std::vector<float>> planes(channels.size());
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < channels.size(); ++i) {
        planes[i].assign(count, 0);
        frame.insert(channels[i].first,
                     Imf::Slice::Make(Imf::FLOAT, planes[i].data(), window, sizeof(float), sizeof(float) * out->width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (size_t p = 0; p < count; ++p) {
        float sum = 0;
        for (size_t i = 0; i < channels.size(); ++i) sum += channels[i].second * planes[i][p];
        out->numbers[p] = std::isfinite(sum) ? sum : 0;
    }
    return RasterPtr(std::move(out));
}

}  // namespace

bool isExr(const std::string& bytes) { return bytes.size() > 8 && std::memcmp(bytes.data(), magic, 4) == 0; }

Result<RasterPtr> readExr(const std::string& bytes, const RasterLimits& limits) {
    if (const Status judged = judgeHeader(bytes, limits); !judged.ok()) return judged.error();
    try {
        return readPixels(bytes);
    } catch (const std::exception& e) {
        return Error{Error::Kind::Input, fmt::format("it is damaged: {}", e.what())};
    }
}

}  // namespace sgm::town
