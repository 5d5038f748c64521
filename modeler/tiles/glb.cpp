#include "modeler/tiles/glb.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>

#include "modeler/core/atomic_file.h"

namespace sgm::tiles {
namespace {

constexpr uint32_t magic = 0x46546c67, version = 2, jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;

uint32_t wordAt(const std::string& bytes, size_t at) {
    uint32_t word = 0;
    if (at + sizeof word <= bytes.size()) std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

}  // namespace

Result<Glb> readGlb(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto refuse = [&](const char* why) {
        return Error{Error::Kind::Input, fmt::format("'{}' {}", path.string(), why)};
    };
    if (!in && bytes.empty()) return refuse("can't be read");
    const size_t json = wordAt(bytes, 12), binaryAt = 20 + json + 8;
    if (bytes.size() < 20 || wordAt(bytes, 0) != magic || wordAt(bytes, 4) != version ||
        wordAt(bytes, 16) != jsonChunk || json > bytes.size() - 20)
        return refuse("is no .glb file");
    Glb glb;
    glb.json = nlohmann::ordered_json::parse(bytes.substr(20, json), nullptr, false);
    if (glb.json.is_discarded()) return refuse("is no .glb file: its JSON can't be read");
    glb.fileBytes = bytes.size();
    glb.bytesAt = binaryAt;
    if (binaryAt > bytes.size()) return glb;
    const size_t length = wordAt(bytes, 20 + json);
    if (wordAt(bytes, 24 + json) != binaryChunk || length > bytes.size() - binaryAt)
        return refuse("is no .glb file: its binary chunk is cut off");
    glb.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(binaryAt),
                     bytes.begin() + static_cast<std::ptrdiff_t>(binaryAt + length));
    return glb;
}

Status writeGlb(Glb glb, const std::filesystem::path& path) {
    glb.bytes.resize((glb.bytes.size() + 3) / 4 * 4, 0);
    if (!glb.bytes.empty()) glb.json["buffers"][0]["byteLength"] = glb.bytes.size();
    std::string text = glb.json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const size_t binary = glb.bytes.empty() ? 0 : 8 + glb.bytes.size();
    std::string file;
    file.reserve(20 + text.size() + binary);
    const auto put = [&](size_t v) {
        const auto word = static_cast<uint32_t>(v);
        file.append(reinterpret_cast<const char*>(&word), sizeof word);
    };
    for (const size_t v : {size_t{magic}, size_t{version}, 20 + text.size() + binary, text.size(), size_t{jsonChunk}})
        put(v);
    file += text;
    if (binary > 0) {
        put(glb.bytes.size());
        put(binaryChunk);
        file.append(glb.bytes.begin(), glb.bytes.end());
    }
    return writeFile(path, file);
}

Error damagedFile(const std::filesystem::path& path) {
    return {Error::Kind::Input, fmt::format("'{}' isn't as it was baked: remove it and bake anew", path.string())};
}

Vec3d vectorOf(const nlohmann::ordered_json& node, const char* key, Vec3d fallback) {
    if (!node.contains(key)) return fallback;
    return {node[key].at(0).get<double>(), node[key].at(1).get<double>(), node[key].at(2).get<double>()};
}

Status writeJson(const std::filesystem::path& path, const nlohmann::ordered_json& json) {
    return writeFile(path, json.dump(1) + '\n');
}

}  // namespace sgm::tiles
