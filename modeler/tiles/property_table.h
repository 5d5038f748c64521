// What is known of features by their number: EXT_structural_metadata (3D Tiles 1.1), a table a file.
// Enters: columns. Leaves: buffer views and the extension's JSON. Assumes one class and one table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modeler/tiles/surface_buffer.h"

namespace sgm::tiles {

/// A table with a row a feature, column by column; every column has as many rows as the first one.
class PropertyTable {
public:
    explicit PropertyTable(std::string className) : class_(std::move(className)) {}
    void addColumn(const std::string& name, std::vector<std::string> texts) {
        texts_.push_back({name, std::move(texts)});
    }
    void addColumn(const std::string& name, std::vector<uint32_t> numbers) {
        numbers_.push_back({name, std::move(numbers)});
    }
    /// Writes the table as property table 0 of the file.
    void writeTo(SurfaceBuffer& file) const;

private:
    std::string class_;
    std::vector<std::pair<std::string, std::vector<std::string>>> texts_;
    std::vector<std::pair<std::string, std::vector<uint32_t>>> numbers_;
};

}  // namespace sgm::tiles
