#include "modeler/tiles/property_table.h"

namespace sgm::tiles {

using Json = nlohmann::ordered_json;

void PropertyTable::writeTo(SurfaceBuffer& file) const {
    constexpr size_t alignment = 8;  // the extension's own
    Json schema = Json::object(), table = Json::object();
    size_t rows = 0;
    for (const auto& [name, texts] : texts_) {
        std::string bytes;
        std::vector<uint32_t> offsets{0};
        for (const std::string& text : texts) {
            bytes += text;
            offsets.push_back(static_cast<uint32_t>(bytes.size()));
        }
        if (bytes.empty()) bytes.push_back('\0');  // a view holds at least a byte
        rows = texts.size();
        schema[name] = {{"type", "STRING"}};
        const size_t values = file.addView(bytes.data(), bytes.size(), 0, alignment);
        table[name] = {{"values", values},
                       {"stringOffsets", file.addView(offsets.data(), 4 * offsets.size(), 0, alignment)},
                       {"stringOffsetType", "UINT32"}};
    }
    for (const auto& [name, numbers] : numbers_) {
        rows = numbers.size();
        schema[name] = {{"type", "SCALAR"}, {"componentType", "UINT32"}};
        table[name] = {{"values", file.addView(numbers.data(), 4 * numbers.size(), 0, alignment)}};
    }
    file.use("EXT_structural_metadata", false);
    file.json()["extensions"]["EXT_structural_metadata"] = {
        {"schema", {{"id", "sgm"}, {"classes", {{class_, {{"properties", schema}}}}}}},
        {"propertyTables", Json::array({{{"class", class_}, {"count", rows}, {"properties", table}}})}};
}

}  // namespace sgm::tiles
