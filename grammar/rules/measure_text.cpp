#include "grammar/rules/measure_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "grammar/syntax/foreign_lengths.h"

namespace sgm::rules {
namespace {

struct Measure {
    Unit unit;
    std::string_view text;
    double factor;
};
using syntax::foot_m, syntax::inch_m;
constexpr Measure measures[] = {
    {Unit::Metre, "m", 1},        {Unit::Metre, "km", 1000},   {Unit::Metre, "cm", .01},
    {Unit::Metre, "mm", .001},    {Unit::Metre, "ft", foot_m}, {Unit::Metre, "'", foot_m},
    {Unit::Metre, "in", inch_m},  {Unit::Metre, "\"", inch_m}, {Unit::SquareMetre, "m2", 1},
    {Unit::SquareMetre, "m²", 1}, {Unit::CubicMetre, "m3", 1}, {Unit::CubicMetre, "m³", 1},
    {Unit::Angle, "deg", 1},      {Unit::Angle, "°", 1},       {Unit::Share, "%", .01},
};

void skipBlanks(std::string_view& text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
}

std::optional<double> takeNumber(std::string_view& text) {
    skipBlanks(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    if (read.ec != std::errc() || !std::isfinite(number)) return {};
    text.remove_prefix(static_cast<size_t>(read.ptr - text.data()));
    skipBlanks(text);
    return number;
}

/// The unit that all of `text` is; a bare number may be a length.
const Measure* findMeasure(std::string_view text, Unit unit) {
    const Unit wanted = unit == Unit::None ? Unit::Metre : unit;
    const auto row =
        std::ranges::find_if(measures, [&](const Measure& m) { return m.unit == wanted && m.text == text; });
    return row == std::end(measures) ? nullptr : row;
}

}  // namespace

std::optional<double> readMeasure(std::string_view text, Unit unit) {
    const auto number = takeNumber(text);
    if (!number || text.empty()) return number;
    const size_t feet = text.starts_with("ft") ? 2 : text.starts_with("'") ? 1 : 0;
    if (feet > 0 && feet < text.size() && findMeasure("ft", unit)) {  // 6'4", 6 ft 4 in
        text.remove_prefix(feet);
        const auto inches = takeNumber(text);
        return inches && *inches >= 0 && (text == "in" || text == "\"")
                   ? std::optional(*number * foot_m + *inches * inch_m)
                   : std::nullopt;
    }
    const Measure* measure = findMeasure(text, unit);
    return measure ? std::optional(*number * measure->factor) : std::nullopt;
}

}  // namespace sgm::rules
