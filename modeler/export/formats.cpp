#include "modeler/export/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace sgm::exporter {
namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

}  // namespace

std::string_view option(const ExportInput& input, std::string_view name, std::string_view fallback) {
    const auto found = input.options.find(name);
    return found == input.options.end() ? fallback : std::string_view(found->second);
}

std::optional<double> numberOf(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

Placement placementOf(const ExportInput& input) {
    const std::string_view unit = option(input, "unit", "m");
    return {option(input, "up", "y") == "z", unit == "mm" ? 1000.0f : unit == "cm" ? 100.0f : 1.0f};
}

std::string pathFrom(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code failed;
    const std::filesystem::path from = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failed);
    const std::filesystem::path way = failed ? std::filesystem::path() : file.lexically_relative(from);
    return validUtf8((way.empty() ? file : way).generic_string());
}

std::string validUtf8(const std::string& text) {
    using Json = nlohmann::json;
    if (std::none_of(text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; })) return text;
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::string oneLine(std::string text) {
    std::replace_if(text.begin(), text.end(), isControl, ' ');
    return text;
}

std::string wordOf(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return isControl(c) || c == ' ' || c == '"' || c == '#'; }, '_');
    return name.empty() ? "_" : name;
}

std::string identifierOf(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !isLetter(c) && !isDigit(c); }, '_');
    if (name.empty() || isDigit(name[0])) name.insert(0, 1, '_');
    return name;
}

std::vector<std::string> distinctNames(const std::vector<Material>& materials, std::string (*turn)(std::string)) {
    std::vector<std::string> names;
    const auto taken = [&](const std::string& n) { return std::find(names.begin(), names.end(), n) != names.end(); };
    for (const Material& material : materials) {
        const std::string base = turn(material.name);
        std::string name = base;
        for (int i = 2; taken(name); ++i) name = fmt::format("{}_{}", base, i);
        names.push_back(name);
    }
    return names;
}

}  // namespace sgm::exporter
