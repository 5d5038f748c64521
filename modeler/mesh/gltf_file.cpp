#include "modeler/mesh/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>

#include "modeler/mesh/byte_order.h"
#include "modeler/mesh/read_formats.h"

namespace sgm::mesh {
namespace {

using Json = nlohmann::json;

constexpr uint32_t glbMagic = 0x46546C67, jsonChunk = 0x4E4F534A, binaryChunk = 0x004E4942;
constexpr size_t header_bytes = 12, chunkHeader_bytes = 8;
/// A parsed JSON tree takes about thirty times the memory of its text.
constexpr size_t mostValues = 8'000'000;
constexpr int deepest = 64;
constexpr size_t mostBuffers = 1000;
constexpr uint64_t mostBeside_bytes = 1ull << 30;
constexpr int byteType = 5120, unsignedByteType = 5121, shortType = 5122, unsignedShortType = 5123,
              unsignedIntType = 5125, floatType = 5126;

/// Counts what a text of JSON holds without keeping any of it.
struct Counter final : nlohmann::json_sax<Json> {
    size_t values = 0;
    int depth = 0;
    bool take() { return ++values <= mostValues; }
    bool enter() { return take() && ++depth <= deepest; }
    bool leave() { return --depth, true; }
    bool null() override { return take(); }
    bool boolean(bool) override { return take(); }
    bool number_integer(number_integer_t) override { return take(); }
    bool number_unsigned(number_unsigned_t) override { return take(); }
    bool number_float(number_float_t, const string_t&) override { return take(); }
    bool string(string_t&) override { return take(); }
    bool binary(binary_t&) override { return take(); }
    bool start_object(size_t) override { return enter(); }
    bool key(string_t&) override { return true; }
    bool end_object() override { return leave(); }
    bool start_array(size_t) override { return enter(); }
    bool end_array() override { return leave(); }
    bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }
};

/// Extensions that change how a mesh looks but not where it is, or that this reader knows.
bool isHarmless(std::string_view extension) {
    for (const std::string_view prefix : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"})
        if (extension.starts_with(prefix)) return true;
    return extension == "KHR_mesh_quantization" || extension == "KHR_xmp_json_ld";
}

Status checkExtensions(const Json& json) {
    const auto required = json.find("extensionsRequired");
    if (required == json.end()) return Done{};
    if (!required->is_array()) return damaged(0, "its list of extensions is no list");
    for (const Json& name : *required) {
        const std::string text = name.is_string() ? name.get<std::string>() : "";
        if (isHarmless(text)) continue;
        const bool isPacked = text == "KHR_draco_mesh_compression" || text == "EXT_meshopt_compression";
        return Error{Error::Kind::Input, isPacked ? "is compressed: save it without compression"
                                                  : "needs an extension of glTF that isn't read: save it without"};
    }
    return Done{};
}

std::array<int8_t, 256> base64Digits() {
    std::array<int8_t, 256> digits;
    digits.fill(-1);
    const std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < alphabet.size(); ++i)
        digits[static_cast<unsigned char>(alphabet[i])] = static_cast<int8_t>(i);
    return digits;
}

/// RFC 4648, section 4; nothing where a character is none of base64.
std::optional<std::string> decodeBase64(std::string_view text) {
    static const std::array<int8_t, 256> digits = base64Digits();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int8_t digit = digits[static_cast<unsigned char>(c)];
        if (digit < 0) return {};
        bits = bits << 6 | static_cast<uint32_t>(digit);
        if ((held += 6) < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 0xff);
    }
    return bytes;
}

/// "%20" and the like, as URIs write what a name holds.
std::string decodePercent(std::string_view text) {
    std::string name;
    for (size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        const char* digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2)
            name += static_cast<char>(value), i += 2;
        else
            name += text[i];
    }
    return name;
}

/// What a buffer's name stands for: bytes in base64, or a file.
Result<std::string> bytesOfUri(std::string_view uri, const ReadBeside& beside) {
    if (uri.starts_with("data:")) {
        const size_t comma = uri.find(',');
        auto decoded = comma != uri.npos && uri.substr(0, comma).ends_with(";base64")
                           ? decodeBase64(uri.substr(comma + 1))
                           : std::nullopt;
        if (!decoded) return damaged(0, "a buffer within it is not written in base64");
        return std::move(*decoded);
    }
    auto read = beside(decodePercent(uri));
    if (read.ok() || read.error().kind == Error::Kind::Cancelled) return read;
    return Error{read.error().kind, "names a buffer that can't be read: " + read.error().message};
}

size_t sizeOf(int componentType) {
    switch (componentType) {
        case byteType:
        case unsignedByteType:
            return 1;
        case shortType:
        case unsignedShortType:
            return 2;
        case unsignedIntType:
        case floatType:
            return 4;
        default:
            return 0;
    }
}

const Json* memberOf(const Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
}

template <class T>
double fraction(const GltfElements& elements, const char* at) {
    const double value = numberAt<T>(at);
    return elements.normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

}  // namespace

GltfFile::GltfFile() = default;
GltfFile::GltfFile(GltfFile&&) noexcept = default;
GltfFile::~GltfFile() = default;

std::optional<uint64_t> wholeNumber(const Json& object, const char* name, uint64_t otherwise) {
    const Json* value = memberOf(object, name);
    if (!value) return otherwise;
    constexpr double exact = 9007199254740992.0;  // above that, doubles leave whole numbers out
    if (value->is_number_unsigned()) return value->get<uint64_t>();
    const double number = value->is_number_float() ? value->get<double>() : -1;
    if (!(number >= 0 && number < exact) || number != static_cast<double>(static_cast<uint64_t>(number))) return {};
    return static_cast<uint64_t>(number);
}

Result<GltfFile> GltfFile::open(std::string_view bytes, const ReadBeside& beside) {
    GltfFile file;
    const bool isBinary = bytes.size() >= header_bytes && numberAt<uint32_t>(bytes.data()) == glbMagic;
    if (const Status read = isBinary ? file.splitGlb(bytes) : file.parse(bytes); !read.ok()) return read.error();
    if (const Status known = checkExtensions(file.json()); !known.ok()) return known.error();
    if (const Status read = file.readBuffers(beside); !read.ok()) return read.error();
    return file;
}

Status GltfFile::splitGlb(std::string_view bytes) {
    const auto version = numberAt<uint32_t>(bytes.data() + 4), length = numberAt<uint32_t>(bytes.data() + 8);
    if (version != 2) return Error{Error::Kind::Input, "is a glTF of another version than 2: save it as glTF 2.0"};
    if (length > bytes.size()) return damaged(0, "it promises more than it holds, or is cut short");
    std::optional<std::string_view> text;
    for (size_t at = header_bytes; at + chunkHeader_bytes <= length;) {
        const auto size = numberAt<uint32_t>(bytes.data() + at), type = numberAt<uint32_t>(bytes.data() + at + 4);
        at += chunkHeader_bytes;
        if (size > length - at) return damaged(0, "a chunk promises more than the file holds");
        if (type == jsonChunk && !text) text = bytes.substr(at, size);
        if (type == binaryChunk && !binary_) binary_ = bytes.substr(at, size);
        at += size;
    }
    if (!text) return damaged(0, "it has no chunk of JSON");
    return parse(*text);
}

Status GltfFile::parse(std::string_view text) {
    Counter counter;
    if (!Json::sax_parse(text, &counter)) {
        if (counter.depth > deepest) return damaged(0, fmt::format("its JSON nests deeper than {}", deepest));
        if (counter.values > mostValues)
            return Error{Error::Kind::Budget, fmt::format("has more than {} values of JSON: simplify it", mostValues)};
        return damaged(0, "it is neither a .glb nor JSON");
    }
    json_ = std::make_unique<Json>(Json::parse(text, nullptr, false));
    const Json* asset = memberOf(*json_, "asset");
    const Json* version = asset ? memberOf(*asset, "version") : nullptr;
    if (!version || !version->is_string()) return damaged(0, "it doesn't say which version of glTF it is");
    if (!version->get_ref<const std::string&>().starts_with("2."))
        return Error{Error::Kind::Input, "is a glTF of another version than 2: save it as glTF 2.0"};
    return Done{};
}

Status GltfFile::readBuffers(const ReadBeside& beside) {
    const Json* buffers = memberOf(*json_, "buffers");
    if (!buffers) return Done{};
    if (!buffers->is_array() || buffers->size() > mostBuffers)
        return damaged(0, "its buffers are no list, or a huge one");
    owned_.reserve(buffers->size());  // views of these mustn't move
    for (const Json& buffer : *buffers) {
        const Json* uri = memberOf(buffer, "uri");
        const auto length = wholeNumber(buffer, "byteLength", 0);
        if (!length || (uri && !uri->is_string())) return damaged(0, "a buffer is no buffer");
        std::string_view bytes;
        if (uri) {
            auto read = bytesOfUri(uri->get_ref<const std::string&>(), beside);
            if (!read.ok()) return read.error();
            bytes = owned_.emplace_back(std::move(*read));
            if ((read_bytes_ += bytes.size()) > mostBeside_bytes)
                return Error{Error::Kind::Budget, "is larger than 1 GiB with its buffers"};
        } else if (binary_ && buffers_.empty()) {
            bytes = *binary_;
        }
        if (*length > bytes.size()) return damaged(0, "a buffer promises more than it holds");
        buffers_.push_back(bytes.substr(0, *length));
    }
    return Done{};
}

Result<const Json*> GltfFile::at(const char* list, const Json& index) const {
    const Json* all = memberOf(*json_, list);
    if (!all || !all->is_array() || !index.is_number_unsigned() || index.get<uint64_t>() >= all->size())
        return damaged(0, fmt::format("it names one of its {} that isn't there", list));
    return &(*all)[index.get<size_t>()];
}

Result<std::string_view> GltfFile::bytesOfView(const Json& index, size_t& stride_bytes) const {
    const auto view = at("bufferViews", index);
    if (!view.ok()) return view.error();
    const Json* extensions = memberOf(**view, "extensions");
    if (extensions && memberOf(*extensions, "EXT_meshopt_compression"))
        return Error{Error::Kind::Input, "is compressed: save it without compression"};
    const auto buffer = wholeNumber(**view, "buffer", buffers_.size()), from = wholeNumber(**view, "byteOffset", 0),
               length = wholeNumber(**view, "byteLength", 0), stride = wholeNumber(**view, "byteStride", 0);
    if (!buffer || !from || !length || !stride || *buffer >= buffers_.size() || *stride > 252)
        return damaged(0, "a view of a buffer is none");
    const std::string_view all = buffers_[*buffer];
    if (*from > all.size() || *length > all.size() - *from)
        return damaged(0, "a view reaches beyond the end of its buffer");
    stride_bytes = *stride;
    return all.substr(*from, *length);
}

Result<GltfElements> GltfFile::elements(const Json& index, int components) const {
    const auto accessor = at("accessors", index);
    if (!accessor.ok()) return accessor.error();
    const Json* view = memberOf(**accessor, "bufferView");
    if (memberOf(**accessor, "sparse") || !view)
        return Error{Error::Kind::Input, "has sparse data or none: save it with all of its data"};
    const Json* type = memberOf(**accessor, "type");
    if (!type || !type->is_string() || *type != (components == 3 ? "VEC3" : "SCALAR"))
        return damaged(0, "positions are no vectors of three numbers, or corners no numbers");
    const auto count = wholeNumber(**accessor, "count", 0), from = wholeNumber(**accessor, "byteOffset", 0),
               componentType = wholeNumber(**accessor, "componentType", 0);
    const Json* normalized = memberOf(**accessor, "normalized");
    GltfElements found;
    const auto bytes = bytesOfView(*view, found.stride_bytes);
    if (!bytes.ok()) return bytes.error();
    found.componentType = componentType && *componentType <= floatType ? static_cast<int>(*componentType) : 0;
    const size_t size = static_cast<size_t>(components) * sizeOf(found.componentType);
    const bool isIndex = found.componentType == unsignedByteType || found.componentType == unsignedShortType ||
                         found.componentType == unsignedIntType;
    if (!count || !from || size == 0 || (components == 1 && !isIndex)) return damaged(0, "an accessor is none");
    if (found.stride_bytes == 0) found.stride_bytes = size;
    if (found.stride_bytes < size) return damaged(0, "elements lie over each other");
    // The last element need not fill its stride.
    if (*from > bytes->size() || (*count > 0 && (bytes->size() - *from < size ||
                                                 *count - 1 > (bytes->size() - *from - size) / found.stride_bytes)))
        return damaged(0, "an accessor reaches beyond the end of its data");
    found.bytes = bytes->substr(*from);
    found.count = *count;
    found.components = components;
    found.normalized = normalized && normalized->is_boolean() && normalized->get<bool>();
    return found;
}

double positionAt(const GltfElements& elements, size_t index, int component) {
    const char* at = elements.bytes.data() + index * elements.stride_bytes +
                     static_cast<size_t>(component) * sizeOf(elements.componentType);
    switch (elements.componentType) {
        case byteType:
            return fraction<int8_t>(elements, at);
        case unsignedByteType:
            return fraction<uint8_t>(elements, at);
        case shortType:
            return fraction<int16_t>(elements, at);
        case unsignedShortType:
            return fraction<uint16_t>(elements, at);
        case unsignedIntType:
            return numberAt<uint32_t>(at);
        default:
            return numberAt<float>(at);
    }
}

uint32_t vertexAt(const GltfElements& elements, size_t index) {
    const char* at = elements.bytes.data() + index * elements.stride_bytes;
    switch (elements.componentType) {
        case unsignedByteType:
            return numberAt<uint8_t>(at);
        case unsignedShortType:
            return numberAt<uint16_t>(at);
        default:
            return numberAt<uint32_t>(at);
    }
}

}  // namespace sgm::mesh
