#include <algorithm>
#include <cmath>

#include "modeler/mesh/byte_order.h"
#include "modeler/mesh/ply_header.h"
#include "modeler/mesh/read_formats.h"
#include "modeler/mesh/text_scanner.h"

namespace sgm::mesh {
namespace {

using Element = PlyHeader::Element;
using Property = PlyHeader::Property;

/// Numbers of the body, one after the other; good() tells whether all so far were there.
class TextBody {
public:
    TextBody(std::string_view bytes, size_t begin) : text_(bytes.substr(begin)) {}
    double next(PlyType) {
        const auto number = numberOf<double>(text_.word());
        good_ = good_ && number;
        return number.value_or(0);
    }
    bool good() const { return good_; }
    /// Whether this many more numbers of the type may follow.
    bool holds(double, PlyType) const { return true; }

private:
    TextScanner text_;
    bool good_ = true;
};

class BinaryBody {
public:
    BinaryBody(std::string_view bytes, size_t begin, bool bigEndian)
        : bytes_(bytes), at_(begin), bigEndian_(bigEndian) {}
    double next(PlyType type) {
        const size_t size = sizeOf(type);
        good_ = good_ && bytes_.size() - at_ >= size;
        if (!good_) return 0;
        const char* const number = bytes_.data() + at_;
        at_ += size;
        switch (type) {
            case PlyType::Int8:
                return numberAt<int8_t>(number);
            case PlyType::Uint8:
                return numberAt<uint8_t>(number);
            case PlyType::Int16:
                return numberAt<int16_t>(number, bigEndian_);
            case PlyType::Uint16:
                return numberAt<uint16_t>(number, bigEndian_);
            case PlyType::Int32:
                return numberAt<int32_t>(number, bigEndian_);
            case PlyType::Uint32:
                return numberAt<uint32_t>(number, bigEndian_);
            case PlyType::Float:
                return numberAt<float>(number, bigEndian_);
            case PlyType::Double:
                return numberAt<double>(number, bigEndian_);
        }
        return 0;
    }
    bool good() const { return good_; }
    bool holds(double count, PlyType type) const {
        return count * static_cast<double>(sizeOf(type)) <= static_cast<double>(bytes_.size() - at_);
    }

private:
    std::string_view bytes_;
    size_t at_;
    bool bigEndian_, good_ = true;
};

Error cutShort() { return damaged(0, "it promises more than it holds, or is cut short"); }
Error badList() { return damaged(0, "a list has a length that is no number, or more than the file holds"); }

/// Reads one list; calls `use` with each of its numbers.
template <class Body, class Use>
Status readList(Body& body, const Property& property, Use use) {
    const double length = body.next(property.countType);
    if (!body.good()) return cutShort();
    if (!(length >= 0) || length != std::floor(length) || !body.holds(length, property.type)) return badList();
    for (double i = 0; i < length; ++i) {
        const double number = body.next(property.type);
        if (!body.good()) return cutShort();
        use(number);
    }
    return Done{};
}

/// A face's corner; one that no file can hold where the number is no index.
uint32_t cornerOf(double number) {
    constexpr uint32_t never = std::numeric_limits<uint32_t>::max();
    return number >= 0 && number < never && number == std::floor(number) ? static_cast<uint32_t>(number) : never;
}

template <class Body>
Status readRow(Body& body, const Element& element, TriangleSoup& soup) {
    Vec3d position;
    for (const Property& property : element.properties) {
        if (!property.isList) {
            const double number = body.next(property.type);
            if (property.axis >= 0) position[property.axis] = number;
            continue;
        }
        PolygonFan fan(soup);
        const Status read = readList(body, property, [&](double number) {
            if (property.isCorners) fan.add(cornerOf(number));
        });
        if (!read.ok()) return read;
    }
    if (!body.good()) return cutShort();
    if (element.isVertices) soup.positions.push_back(position);
    return Done{};
}

template <class Body>
Status readBody(Body body, const PlyHeader& header, TriangleSoup& soup, const Progress* progress) {
    for (const Element& element : header.elements) {
        if (element.properties.empty()) continue;  // rows of nothing, however many
        for (uint64_t i = 0; i < element.count; ++i) {
            if (i % 4096 == 0 && cancelled(progress)) return cancelledError();
            if (const Status row = readRow(body, element, soup); !row.ok()) return row;
        }
    }
    return Done{};
}

}  // namespace

Status readPly(std::string_view bytes, TriangleSoup& soup, const Progress* progress) {
    const Result<PlyHeader> header = readPlyHeader(bytes);
    if (!header.ok()) return header.error();
    const bool isText = header->format == PlyHeader::Format::Text;
    for (const Element& element : header->elements) {
        const double row_bytes = element.leastRow_bytes(isText);
        if (row_bytes * static_cast<double>(element.count) > static_cast<double>(bytes.size() - header->end + 1))
            return cutShort();
        if (element.isVertices) soup.positions.reserve(element.count);
    }
    if (isText) return readBody(TextBody(bytes, header->end), *header, soup, progress);
    return readBody(BinaryBody(bytes, header->end, header->format == PlyHeader::Format::BigEndian), *header, soup,
                    progress);
}

}  // namespace sgm::mesh
