// The header of a PLY file.
// Enters: a file's bytes. Leaves: what its body holds. Assumes nothing: a header has at most 64 KiB, 100 elements and
// 1000 properties.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "modeler/core/result.h"

namespace sgm::mesh {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };
size_t sizeOf(PlyType type);

struct PlyHeader {
    enum class Format { Text, LittleEndian, BigEndian };

    /// A number in each row of its element, or a list of them.
    struct Property {
        PlyType type = PlyType::Float, countType = PlyType::Uint8;  ///< of the numbers, and of a list's length
        bool isList = false;
        bool isCorners = false;  ///< the list of a face's vertices
        int axis = -1;           ///< of a vertex's position, or none
    };
    struct Element {
        uint64_t count = 0;
        bool isVertices = false;
        std::vector<Property> properties;
        /// What a row takes in the file at least.
        double leastRow_bytes(bool isText) const;
    };

    Format format = Format::Text;
    std::vector<Element> elements;
    size_t end = 0;  ///< where the body begins
};

/// Error::Input in words when the header has no end, names what PLY doesn't have, or vertices without x, y and z.
Result<PlyHeader> readPlyHeader(std::string_view bytes);

}  // namespace sgm::mesh
