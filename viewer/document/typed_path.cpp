#include "viewer/document/typed_path.h"

#include <cstdlib>

namespace sgm::document {

std::filesystem::path typedPath(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    text = text.substr(first, text.find_last_not_of(blanks) - first + 1);
    const char* home = std::getenv("HOME");
    if (!home || !*home || text[0] != '~' || (text.size() > 1 && text[1] != '/')) return text;
    const std::string_view rest = text.substr(std::min<size_t>(2, text.size()));
    return rest.empty() ? std::filesystem::path(home) : std::filesystem::path(home) / rest;
}

}  // namespace sgm::document
