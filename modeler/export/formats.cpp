#include "modeler/export/formats.h"

#include <nlohmann/json.hpp>

namespace sgm::exporter {

std::string_view option(const ExportInput& input, std::string_view name, std::string_view fallback) {
    const auto found = input.options.find(name);
    return found == input.options.end() ? fallback : std::string_view(found->second);
}

std::string validUtf8(const std::string& text) {
    using Json = nlohmann::json;
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Error cancelledError() { return {Error::Kind::Cancelled, "writing was cancelled"}; }

}  // namespace sgm::exporter
