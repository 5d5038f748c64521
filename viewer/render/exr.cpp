// OpenEXR files of a picture and its layers. The library's headers stay here.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <exception>

#include "modeler/core/atomic_file.h"
#include "viewer/render/picture.h"

namespace sgm::render {
namespace {

/// One channel: where its values start and how many floats lie between them.
struct Channel {
    std::string name;
    const float* first;
    size_t stride;
};

void addVector(std::vector<Channel>& channels, const std::vector<std::string>& names,
               const std::vector<Vec3f>& values) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    for (size_t c = 0; c < 3; ++c) channels.push_back({names[c], &values.front().x + c, 3});
}

bool addLayer(std::vector<Channel>& channels, const std::string& name, const Layers& layers) {
    if (name == "depth")
        channels.push_back({"depth.Z", layers.depth.data(), 1});
    else if (name == "normal")
        addVector(channels, {"normal.X", "normal.Y", "normal.Z"}, layers.normal);
    else if (name == "position")
        addVector(channels, {"position.X", "position.Y", "position.Z"}, layers.position);
    else if (name == "origin")
        channels.push_back({"origin.V", layers.origin.data(), 1});
    else if (name == "ao")
        channels.push_back({"ao.V", layers.ao.data(), 1});
    else
        return false;
    return true;
}

void writeChannels(const std::vector<Channel>& channels, int width, int height,
                   const std::map<std::string, std::string>& metadata, const std::filesystem::path& file) {
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : metadata) header.insert(name, Imf::StringAttribute(text));
    Imf::FrameBuffer pixels;
    for (const Channel& channel : channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        // The library takes pointers to what may also be read into.
        auto* first = reinterpret_cast<char*>(const_cast<float*>(channel.first));
        const size_t step = channel.stride * sizeof(float);
        pixels.insert(channel.name, Imf::Slice(Imf::FLOAT, first, step, step * size_t(width)));
    }
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(pixels);
    out.writePixels(height);
}

}  // namespace

const std::vector<std::string>& layerNames() {
    static const std::vector<std::string> names{"depth", "normal", "position", "origin", "ao"};
    return names;
}

Status writeExr(const Layers& layers, const std::vector<std::string>& names,
                const std::map<std::string, std::string>& metadata, const std::filesystem::path& path) {
    if (layers.color.empty()) return writeError(path, "the picture is empty");
    std::vector<Channel> channels;
    addVector(channels, {"R", "G", "B"}, layers.color);
    for (const std::string& name : names)
        if (!addLayer(channels, name, layers)) return Error{Error::Kind::Usage, "no layer is called '" + name + "'"};
    return replaceFile(path, [&](const std::filesystem::path& temporary) -> Status {
        try {
            writeChannels(channels, layers.width, layers.height, metadata, temporary);
        } catch (const std::exception& e) {
            return writeError(path, e.what());
        }
        return Done{};
    });
}

}  // namespace sgm::render
