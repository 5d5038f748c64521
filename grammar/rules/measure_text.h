// Numbers with units in the words of files that somebody else wrote.
// Enters: any text. Leaves: a number in metres, degrees or shares, or nothing. Assumes nothing.
#pragma once

#include <optional>
#include <string_view>

#include "grammar/rules/value.h"

namespace sgm::rules {

/// The number that a text stands for where `unit` is wanted: "12", "7.5 m", "500 cm", "20 ft", "6'4\"" in metres, "30
/// deg" in degrees, "40 %" as a share. Nothing for other words, also behind a number. A number without a unit is kept.
std::optional<double> readMeasure(std::string_view text, Unit unit);

}  // namespace sgm::rules
