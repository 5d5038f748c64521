#include "grammar/language/sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sgm::language {
namespace {

/// A length to the millimetre and to four digits.
std::string lengthText(double length_m) { return fmt::format("{:.4g}", std::round(length_m * 1000) / 1000); }

std::string rangeText(double least_m, double most_m) {
    const std::string least = lengthText(least_m), most = lengthText(most_m);
    return least == most ? least : least + "…" + most;
}

/// Whether an element's text has the size as it would be shown.
bool saysSize(std::string_view text, const Sizes& sizes) {
    if (sizes.least != sizes.most) return false;
    const std::string x = lengthText(sizes.most.x), y = lengthText(sizes.most.y), z = lengthText(sizes.most.z);
    std::string plain;
    for (const char c : text)
        if (c != ' ' && c != '\t') plain += c;
    const auto has = [&](const std::string& part) {
        const size_t at = plain.find(part);
        return at != std::string::npos &&
               (part.back() == ')' || at + part.size() == plain.size() ||
                std::string_view(".0123456789").find(plain[at + part.size()]) == std::string_view::npos);
    };
    return has(fmt::format("size({},{},{})", x, y, z)) || (x == y && y == z && has("size" + x));
}

}  // namespace

std::vector<SizeHint> sizeHints(const syntax::Source& source, const Figures& figures) {
    std::vector<SizeHint> hints;
    for (const auto& [begin, sizes] : figures.sizes) {
        const std::string_view text = source.text().substr(begin, sizes.end - begin);
        const std::string_view shown = text.substr(0, text.find('\n'));
        const size_t last = shown.find_last_not_of(" \t\r");
        if (last == std::string_view::npos || saysSize(shown, sizes)) continue;
        hints.push_back({begin + static_cast<uint32_t>(last) + 1,
                         fmt::format("{} × {} × {} m", rangeText(sizes.least.x, sizes.most.x),
                                     rangeText(sizes.least.y, sizes.most.y), rangeText(sizes.least.z, sizes.most.z)),
                         fmt::format("The size of {} at the defaults, in metres along its own x, y and z.",
                                     sizes.count == 1 ? "the one shape that this makes"
                                                      : fmt::format("the {} shapes that this makes", sizes.count))});
    }
    std::stable_sort(hints.begin(), hints.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; });
    return hints;
}

void shiftHints(std::vector<SizeHint>& hints, uint32_t begin, uint32_t end, uint32_t length) {
    std::erase_if(hints, [&](const SizeHint& hint) { return begin < hint.offset && hint.offset < end; });
    for (SizeHint& hint : hints)
        if (hint.offset >= end && hint.offset > begin) hint.offset = hint.offset - (end - begin) + length;
}

}  // namespace sgm::language
