#include "modeler/mesh/ply_header.h"

#include <algorithm>
#include <optional>

#include "modeler/mesh/read_formats.h"
#include "modeler/mesh/text_scanner.h"

namespace sgm::mesh {
namespace {

constexpr size_t mostHeader_bytes = 1 << 16, mostElements = 100, mostProperties = 1000;

std::optional<PlyType> typeOf(std::string_view name) {
    constexpr std::pair<std::string_view, PlyType> names[] = {
        {"char", PlyType::Int8},     {"int8", PlyType::Int8},     {"uchar", PlyType::Uint8},
        {"uint8", PlyType::Uint8},   {"short", PlyType::Int16},   {"int16", PlyType::Int16},
        {"ushort", PlyType::Uint16}, {"uint16", PlyType::Uint16}, {"int", PlyType::Int32},
        {"int32", PlyType::Int32},   {"uint", PlyType::Uint32},   {"uint32", PlyType::Uint32},
        {"float", PlyType::Float},   {"float32", PlyType::Float}, {"double", PlyType::Double},
        {"float64", PlyType::Double}};
    const auto* found =
        std::find_if(std::begin(names), std::end(names), [&](const auto& n) { return n.first == name; });
    return found == std::end(names) ? std::nullopt : std::optional(found->second);
}

bool isInteger(PlyType type) { return type != PlyType::Float && type != PlyType::Double; }

/// Reads the header line by line.
class HeaderReader {
public:
    explicit HeaderReader(std::string_view bytes) : text_(bytes.substr(0, mostHeader_bytes)) {}

    Result<PlyHeader> read() {
        if (text_.wordOfLine() != "ply") return damaged(1, "a PLY file begins with 'ply'");
        text_.nextLine();
        for (;; text_.nextLine()) {
            if (text_.atEnd()) return damaged(0, "its header has no end");
            const std::string_view key = text_.wordOfLine();
            if (key == "end_header") break;
            if (const Status line = readLine(key); !line.ok()) return line.error();
        }
        text_.nextLine();
        header_.end = text_.position();
        if (!hasFormat_) return damaged(0, "its header names no format");
        for (const PlyHeader::Element& e : header_.elements)
            if (e.isVertices && axesOf(e) != 7) return damaged(0, "its vertices have no x, y and z");
        return std::move(header_);
    }

private:
    Status readLine(std::string_view key) {
        if (key.empty() || key == "comment" || key == "obj_info") return Done{};
        if (key == "format") return readFormat();
        if (key == "element") return readElement();
        if (key == "property") return readProperty();
        return damaged(text_.line(), "a header has format, element, property, comment and end_header");
    }

    Status readFormat() {
        const std::string_view name = text_.wordOfLine();
        hasFormat_ = true;
        if (name == "ascii")
            header_.format = PlyHeader::Format::Text;
        else if (name == "binary_little_endian")
            header_.format = PlyHeader::Format::LittleEndian;
        else if (name == "binary_big_endian")
            header_.format = PlyHeader::Format::BigEndian;
        else
            return damaged(text_.line(), "the format is ascii, binary_little_endian or binary_big_endian");
        return Done{};
    }

    Status readElement() {
        const std::string_view name = text_.wordOfLine();
        const auto count = numberOf<uint64_t>(text_.wordOfLine());
        if (name.empty() || !count) return damaged(text_.line(), "an element has a name and a count");
        if (header_.elements.size() == mostElements) return damaged(text_.line(), "it has too many elements");
        isFace_ = name == "face";
        header_.elements.push_back({*count, name == "vertex", {}});
        return Done{};
    }

    Status readProperty() {
        if (header_.elements.empty()) return damaged(text_.line(), "a property stands before its element");
        PlyHeader::Element& element = header_.elements.back();
        if (++properties_ > mostProperties) return damaged(text_.line(), "it has too many properties");
        PlyHeader::Property property;
        std::string_view word = text_.wordOfLine();
        property.isList = word == "list";
        if (property.isList) {
            const auto count = typeOf(text_.wordOfLine());
            if (!count || !isInteger(*count)) return damaged(text_.line(), "a list's length is an integer");
            property.countType = *count;
            word = text_.wordOfLine();
        }
        const auto type = typeOf(word);
        const std::string_view name = text_.wordOfLine();
        if (!type || name.empty()) return damaged(text_.line(), "a property has a type and a name");
        property.type = *type;
        property.isCorners = isFace_ && property.isList && (name == "vertex_indices" || name == "vertex_index");
        if (element.isVertices && !property.isList && name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
            property.axis = name[0] - 'x';
        element.properties.push_back(property);
        return Done{};
    }

    static int axesOf(const PlyHeader::Element& element) {
        int axes = 0;
        for (const PlyHeader::Property& p : element.properties)
            if (p.axis >= 0) axes |= 1 << p.axis;
        return axes;
    }

    TextScanner text_;
    PlyHeader header_;
    size_t properties_ = 0;
    bool hasFormat_ = false, isFace_ = false;
};

}  // namespace

size_t sizeOf(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::Uint8:
            return 1;
        case PlyType::Int16:
        case PlyType::Uint16:
            return 2;
        case PlyType::Int32:
        case PlyType::Uint32:
        case PlyType::Float:
            return 4;
        case PlyType::Double:
            return 8;
    }
    return 8;
}

double PlyHeader::Element::leastRow_bytes(bool isText) const {
    double bytes = 0;
    for (const Property& p : properties)
        bytes += isText ? 2.0 : static_cast<double>(sizeOf(p.isList ? p.countType : p.type));  // "0 "
    return bytes;
}

Result<PlyHeader> readPlyHeader(std::string_view bytes) { return HeaderReader(bytes).read(); }

}  // namespace sgm::mesh
