// The settings of `roads`: what is asked at every place, the words, and the numbers (modeler/town/road_parameters.h has
// those). Enters: nothing. Leaves: rows. Assumes that `network` gives each its meaning.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

enum class Want : uint8_t;

/// A setting whose expression is asked anywhere, or once for the whole (`once`).
struct RoadField {
    std::string_view name;
    std::optional<Expr> Roads::*field;
    Want want;
    std::string_view doc;
};
/// A setting that is one of some words; the first one counts where it isn't said.
struct RoadWord {
    std::string_view name;
    std::optional<Expr> Roads::*field;
    std::span<const std::string_view> words;
    std::string_view doc;
};
std::span<const RoadField> roadFields();
std::span<const RoadField> roadPoints();  ///< (x, z) in metres
std::span<const RoadWord> roadWords();

}  // namespace sgm::rules
